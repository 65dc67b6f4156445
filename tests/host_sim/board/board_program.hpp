// board_program.hpp - a board with an assembled program in its EEPROM, for the board's tests.
// Depends on   host_sim/board, tests/support/assemble.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "host_sim/board/board.hpp"
#include "tests/support/assemble.hpp"

namespace board_test {

/// Names of the ports and bits, as the programs use them; numbers of docs/spec/board.md.
inline constexpr std::string_view kEquates = R"(
UDATA   EQU 08H
UCTL    EQU 09H
TIMER0  EQU 10H
TIMER1  EQU 11H
TIMERC  EQU 13H
PPIA    EQU 20H
PPIB    EQU 24H
ADC     EQU 28H
MOTOR   EQU 30H
TOP     EQU 0FF00H
)";

/// The program's bytes and symbols.
inline test_support::Assembled assemble_program(std::string_view source) {
    return test_support::assemble(std::string(kEquates) + std::string(source));
}

/// Puts the program where its origin says.
inline void program(host_sim::Board& board, const test_support::Assembled& code) {
    board.program(code.bytes, code.origin);
}

}  // namespace board_test
