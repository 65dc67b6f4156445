// sample_map.hpp - a small map file, made by hand.
#pragma once

namespace budget_test {

// Two functions, a constant, a variable with and one without an initial value, a frame.
inline constexpr const char* kMap =
    "# rover85 map 1\n"
    "# a comment\n"
    "something new 1 2\n"
    "range ROM 0000 7FFF used 45 free 32723\n"
    "range RAM 8000 FEFF used 20 free 32492\n"
    "region frames 8000 0004\n"
    "region stack FEF8 0008\n"
    "section 0000 0020 code 0000 _Zmain\n"
    "section 0020 0008 code 0020 runtime.mul\n"
    "section 0028 0003 constant 0028 _Ztable\n"
    "section 8000 0004 frame 8000 main@frame\n"
    "section 8004 0002 initialised 002B _Zvalue\n"
    "section 8006 0006 zero 8006 _Zcount\n"
    "function 0000 rom 35 ram 4 t - - stack 6 main()\n"
    "function 0020 rom 8 ram 0 t 10 20 stack - runtime.mul\n"
    "note 0000 loop 3\n";

}  // namespace budget_test
