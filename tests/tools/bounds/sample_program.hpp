// sample_program.hpp - programs in Intel syntax with the symbols and notes that a compiler would
// give them. Depends on   tests/support/assemble.hpp, tools/bounds.
#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <vector>

#include "tests/support/assemble.hpp"
#include "tools/bounds/flow_program.hpp"

namespace bounds_test {

/// An image of assembled source. Labels of `functions` are functions with that name; all code
/// stands in lines of "a.cpp", the line being the address.
class Sample {
public:
    Sample(const std::string& source, const std::map<std::string, std::string>& functions)
        : program_(test_support::assemble(source)) {
        for (std::size_t i = 0; i < program_.bytes.size(); ++i) {
            image.put(static_cast<uint16_t>(program_.origin + i), program_.bytes[i]);
        }
        std::map<uint16_t, std::string> by_address;
        for (const auto& [label, name] : functions) by_address[at(label)] = name;
        std::string text;
        for (auto one = by_address.begin(); one != by_address.end(); ++one) {
            const auto next = std::next(one);
            const auto end = next == by_address.end()
                                 ? static_cast<unsigned>(program_.origin + program_.bytes.size())
                                 : next->first;
            text += fmt::format("{:04X} {:04X} F {} @ a.cpp:{}\n", one->first, end - one->first,
                                one->second, one->first + 1);
        }
        symbols = host_sim::read_symbols(text, "a.sym");
    }

    [[nodiscard]] uint16_t at(const std::string& label) const { return program_.symbols.at(label); }
    Sample& note(const std::string& label, const std::string& text) {
        map.notes.push_back({at(label), text});
        return *this;
    }
    [[nodiscard]] rover_bounds::CodeSource source() const { return {&image, &symbols, {}}; }
    [[nodiscard]] rover_bounds::FlowProgram flow(const std::string& table = "") const {
        return {image, symbols, map, rover_bounds::parse_flow(table, "flow.csv")};
    }

    host_sim::Image image;
    host_sim::Symbols symbols;
    rover_budget::ImageMap map;

private:
    test_support::Assembled program_;
};

/// What every sample below ends its table with.
inline const std::string kMainIsEndless = "endless,main#1,the step\n";

/// A rover in small: vectors, a step that waits and works, four handlers.
/// @param work  body of the function `work`
inline Sample small_rover(const std::string& work) {
    return {R"(
reset:  JMP  main
        DS   21H
v24:    JMP  on_trap        ; 0024H
        DS   5
v2c:    JMP  on_send        ; 002CH
        DS   5
v34:    JMP  on_get         ; 0034H
        DS   5
v3c:    JMP  on_tick        ; 003CH
main:   LXI  H,8000H
turn:   CALL wait           ; 18
        CALL work           ; 18
        JMP  turn           ; 10
wait:   DI
        EI
        HLT
        RET
on_trap: RET                ; 10
on_send: EI                 ; 4
        RET                 ; 10
on_get: PUSH PSW            ; 12
        POP  PSW            ; 10
        EI                  ; 4
        RET                 ; 10
on_tick: PUSH PSW           ; 12
        EI                  ; 4
        NOP                 ; 4
        POP  PSW            ; 10
        RET                 ; 10
work:
)" + work,
            {{"reset", "__reset"},
             {"v24", "__vector_0024"},
             {"v2c", "__vector_002C"},
             {"v34", "__vector_0034"},
             {"v3c", "__vector_003C"},
             {"main", "main"},
             {"wait", "x::rover_wait()"},
             {"on_trap", "x::on_trap()"},
             {"on_send", "x::on_send()"},
             {"on_get", "x::on_get()"},
             {"on_tick", "x::on_tick()"},
             {"work", "x::work()"}}};
}

/// Three turns of a loop: 7 + 3 * 4 + 2 * 10 + 7 + 10.
inline const std::string kLoopWork = R"(
        MVI  B,3            ; 7
loop:   DCR  B              ; 4
        JNZ  loop           ; 10, 7 at the end
        RET                 ; 10
)";
inline constexpr uint64_t kLoopWorkT = 7 + 3 * 4 + 2 * 10 + 7 + 10;

}  // namespace bounds_test
