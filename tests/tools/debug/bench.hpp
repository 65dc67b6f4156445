// bench.hpp - a console around a small program: 100 Hz tick, a subroutine, serial output.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <sstream>
#include <string>
#include <string_view>

#include "tests/support/assemble.hpp"
#include "tools/debug/console.hpp"

namespace debug_test {

// T-states behind each instruction up to the call: data sheet, see CALL print at 164 to 182.
inline constexpr std::string_view kProgram = R"(
count   EQU 8000H
        JMP main            ; 10
        ORG 24H
        JMP bump
        ORG 3CH
        JMP tick
        ORG 100H
main:   LXI SP,0            ; 20
        MVI A,34H           ; timer A, counter 0: mode 2, 30720 clocks
        OUT 13H             ; 37
        MVI A,0
        OUT 10H             ; 54
        MVI A,78H
        OUT 10H             ; 71
        MVI A,56H           ; counter 1: mode 3, 10 clocks: 19,200 baud
        OUT 13H             ; 88
        MVI A,10
        OUT 11H             ; 105
        MVI A,4EH           ; 8251A: 16 clocks a bit, 8 data bits, 1 stop bit
        OUT 09H             ; 122
        MVI A,05H           ; transmitter and receiver on
        OUT 09H             ; 139
        MVI A,1BH           ; RST 7.5 unmasked, its latch cleared: OUT 0 rose above
        SIM                 ; 150
        EI                  ; 154
        LXI H,text          ; 164
call:   CALL print          ; 182 at print
loop:   HLT
        JMP loop
print:  MOV A,M
        ORA A
        RZ
wait:   IN 09H
        ANI 01H
        JZ wait
        MOV A,M
        OUT 08H
        INX H
        JMP print
tick:   PUSH PSW
        LDA count
        INR A
        STA count
        RRC                 ; its lowest bit to SOD: keeps the watchdog quiet
        ANI 80H
        ORI 40H
        SIM
        POP PSW
        EI
        RET
bump:   RET
text:   DB 'OK',10,0
)";

inline host_sim::Symbols symbols_of(const test_support::Assembled& program) {
    std::vector<host_sim::Symbol> list;
    for (const auto& [name, address] : program.symbols) {
        host_sim::Symbol symbol;
        symbol.address = address;
        symbol.kind = host_sim::SymbolKind::function;
        symbol.name = name;
        if (name == "wait" || name == "call" || name == "loop") {
            symbol.kind = host_sim::SymbolKind::label;
        }
        list.push_back(symbol);
    }
    return {list, "test.sym"};
}

/// A session with the program, and a console on a string stream.
class Bench {
public:
    explicit Bench(std::string_view source = kProgram, const host_sim::BoardOptions& options = {})
        : program_(test_support::assemble(source)),
          session(options, debug_console::Names(symbols_of(program_))),
          console(session, out_) {
        session.board.program(program_.bytes, program_.origin);
    }

    /// What a line prints; the message when it is refused.
    std::string operator()(std::string_view line) {
        out_.str("");
        try {
            console.execute(line);
        } catch (const debug_console::DebugError& error) {
            return "refused: " + std::string(error.what());
        }
        return out_.str();
    }
    uint64_t t() const { return session.board.state.cpu.t; }
    uint16_t pc() const { return session.board.state.cpu.pc; }
    uint16_t symbol(const std::string& name) const { return program_.symbols.at(name); }

private:
    test_support::Assembled program_;
    std::ostringstream out_;

public:
    debug_console::Session session;
    debug_console::Console console;
};

}  // namespace debug_test
