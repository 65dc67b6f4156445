// arith.hpp - named arithmetic on fixed-width integers: the same bits with a 16 or a 32 bit `int`.
// Depends on   sums.hpp, multiply.hpp, <stdint.h>.      Design note  docs/design/fixed-point.md
// Naming       the name says what happens at the edge: _wrap modulo 2^width, _sat clamps, _floor
//              rounds down, _round_half_up to nearest with ties up. Every result is defined for
//              every argument; there is no undefined shift, overflow or division.
// Types        operands of one operation have the same type exactly. Nothing converts silently:
//              add_wrap(x, 1) does not compile; add_wrap(x, uint16_t{1}) does.
// Bounds       no loop, no state.
// Tests        tests/firmware/core/sums_test.cpp, multiply_test.cpp, must_not_compile.cpp
#pragma once

#include "firmware/core/multiply.hpp"
#include "firmware/core/sums.hpp"
