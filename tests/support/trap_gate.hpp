// trap_gate.hpp - lets TRAP through, as software does by port 26H bit 6 of a board.
#pragma once

#include "host_sim/board/board.hpp"

namespace test_support {

/// As MVI A,93H / OUT 27H / MVI A,0DH / OUT 27H: mode of the second 82C55A, then set bit 6 of port
/// C.
inline void open_trap_gate(host_sim::BoardState& state) {
    state.ppis[1].write(3, 0x93, state.cpu.t);
    state.ppis[1].write(3, 0x0D, state.cpu.t);
}

}  // namespace test_support
