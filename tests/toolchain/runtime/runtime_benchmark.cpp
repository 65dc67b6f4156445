// runtime_benchmark.cpp - T-states of the runtime routines, as the table of docs/design/runtime.md.
// Usage        runtime_benchmark                     the table, in Markdown
//              runtime_benchmark --search ROUTINE    climbs to the slowest operands it can find
// Means        over operands with all values equally likely; shift counts below the width; blocks
//              of 0 to 64 bytes; divisors other than 0.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <string>

#include "tests/toolchain/runtime/runtime_machine.hpp"

namespace runtime_test {
namespace {

constexpr unsigned kCalls = 20'000;

/// Registers, and what goes into the cells that the routine names.
struct Operands {
    Registers registers;
    std::array<uint64_t, 2> cells{};
};

unsigned cell_size(const std::string& name) {
    return name.starts_with("__wide") ? 8 : 4;
}

Operands random_operands() {
    auto& source = random_source();
    return {.registers = {.a = static_cast<uint8_t>(source()),
                          .bc = static_cast<uint16_t>(source()),
                          .de = static_cast<uint16_t>(source()),
                          .hl = static_cast<uint16_t>(source())},
            .cells = {source(), source()}};
}

/// Brings operands into what a routine allows, and what the table is about.
void restrict(const std::string& name, Operands& operands) {
    Registers& in = operands.registers;
    if (name.starts_with("__mem")) {
        in.bc %= 65;
        in.de = 0x4000;
        in.hl = 0x6000;
        if (name == "__memmove" && (operands.cells[0] & 1) != 0) std::swap(in.de, in.hl);
    }
    for (const unsigned bits : {8U, 16U, 32U, 64U}) {
        if (name.find("sh") == name.npos || (!name.ends_with(fmt::format("r{}", bits)) &&
                                             !name.ends_with(fmt::format("l{}", bits)))) {
            continue;
        }
        in.a %= static_cast<uint8_t>(bits);
        if (bits == 8) in.de &= 7;
    }
    if (name.find("div") != name.npos) {
        if (in.e() == 0) ++in.de;
        if (in.bc == 0) ++in.bc;
        for (uint64_t& cell : operands.cells) cell |= cell == 0 ? 1 : 0;
    }
    if (name == "__udiv24_8") in.a %= in.e();
}

unsigned measure(const Routine& routine, const Operands& operands) {
    std::size_t next = 0;
    for (const std::string& name : routine.in) {
        if (!name.starts_with("__")) continue;
        runtime().write(runtime().address(name), cell_size(name), operands.cells.at(next++));
    }
    (void)runtime().call(runtime().address(routine.name), operands.registers);
    return runtime().last_t();
}

void print_table() {
    fmt::print("| routine | bytes | best | mean | worst |\n|---|--:|--:|--:|--:|\n");
    std::string section;
    for (const Routine& routine : runtime().routines()) {
        double sum = 0;
        const bool returns = routine.name != "__jumpindex";
        for (unsigned i = 0; i < kCalls && returns; ++i) {
            Operands operands = random_operands();
            restrict(routine.name, operands);
            sum += measure(routine, operands);
        }
        const std::string mean = returns ? fmt::format("{:.0f}", sum / kCalls) : "";
        const std::string bytes =
            routine.section == section ? "" : fmt::format("{}", routine.stated_bytes);
        section = routine.section;
        fmt::print("| `{}` | {} | {} | {} | {} |\n", routine.name, bytes, routine.best_t, mean,
                   routine.worst_t);
    }
}

/// One random change.
void mutate(Operands& operands) {
    auto& source = random_source();
    Registers& in = operands.registers;
    for (uint64_t changes = 1 + source() % 3; changes > 0; --changes) {
        const uint64_t bit = uint64_t{1} << source() % 64;
        const auto word = static_cast<uint16_t>(uint64_t{1} << source() % 16);
        const uint64_t kind = source() % 12;
        if (kind == 0) in.a ^= static_cast<uint8_t>(1U << source() % 8);
        if (kind == 1) in.bc ^= word;
        if (kind == 2) in.de ^= word;
        if (kind == 3) in.hl ^= word;
        if (kind == 4) in.hl = static_cast<uint16_t>(in.hl + source() % 3 - 1);
        if (kind == 5) in.de = static_cast<uint16_t>(in.de + source() % 3 - 1);
        if (kind == 6 || kind == 7) operands.cells[kind - 6] ^= bit;
        if (kind == 8 || kind == 9) operands.cells[kind - 8] += source() % 3 - 1;
        if (kind == 10) operands.cells[source() % 2] >>= 8 * (source() % 5);
        if (kind == 11) in.bc = static_cast<uint16_t>(in.bc + source() % 3 - 1);
    }
}

void search(const std::string& name) {
    constexpr unsigned kClimbs = 300;
    constexpr unsigned kSteps = 6'000;
    const Routine& routine = runtime().routine(name);
    unsigned worst = 0;
    for (unsigned climb = 0; climb < kClimbs; ++climb) {
        Operands best = random_operands();
        const auto shape = random_source()();
        best.cells[0] >>= shape % 60;
        best.cells[1] >>= shape / 64 % 60;
        restrict(name, best);
        unsigned best_t = measure(routine, best);
        for (unsigned i = 0; i < kSteps; ++i) {
            Operands next = best;
            mutate(next);
            restrict(name, next);
            const unsigned t = measure(routine, next);
            if (t >= best_t) {
                best = next;
                best_t = t;
            }
        }
        if (best_t <= worst) continue;
        worst = best_t;
        fmt::print("{} T: A {:02X} BC {:04X} DE {:04X} HL {:04X} cells {:X} {:X}\n", worst,
                   best.registers.a, best.registers.bc, best.registers.de, best.registers.hl,
                   best.cells[0], best.cells[1]);
    }
}

}  // namespace
}  // namespace runtime_test

int main(int count, char** arguments) {
    try {
        if (count == 1) {
            runtime_test::print_table();
        } else if (count == 3 && std::string(arguments[1]) == "--search") {
            runtime_test::search(arguments[2]);
        } else {
            fmt::print(stderr, "usage: {} [--search ROUTINE]\n", arguments[0]);
            return 2;
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "runtime_benchmark: {}\n", error.what());
        return 1;
    }
    return 0;
}
