// snapshot_commands.cpp - commands that keep, bring back and compare states of the board. See
// commands.hpp.
#include <algorithm>

#include "toolchain/isa/disassemble.hpp"
#include "tools/debug/chip_parts.hpp"
#include "tools/debug/console.hpp"
#include "tools/debug/registers.hpp"

namespace debug_console {

using host_sim::BoardState;
using toolchain::isa::intel_hex;

namespace {

constexpr unsigned kMemoryRangesShown = 8;

void snapshot(Console& console, Arguments& arguments) {
    std::string name = arguments.empty() ? std::string() : arguments.word("NAME");
    arguments.expect_end();
    for (unsigned number = 1; name.empty(); ++number) {
        const std::string free = std::to_string(number);
        if (!console.snapshots.contains(free)) name = free;
    }
    const Session& session = console.session;
    console.snapshots.insert_or_assign(name, Snapshot{session.board.state, session.calls});
    console.newest_snapshot = name;
    console.print("snapshot {} at {}\n", name, time_text(session.board.state.cpu.t));
}

const Snapshot& take_snapshot(Console& console, Arguments& arguments) {
    const std::string name = arguments.empty() ? console.newest_snapshot : arguments.word("NAME");
    arguments.expect_end();
    const auto found = console.snapshots.find(name);
    if (found == console.snapshots.end()) {
        throw DebugError(name.empty()
                             ? std::string("no snapshot yet; `snapshot` takes one")
                             : fmt::format("{}: no such snapshot; `snapshots` lists them", name));
    }
    return found->second;
}

void restore(Console& console, Arguments& arguments) {
    const Snapshot& wanted = take_snapshot(console, arguments);
    if (console.observers.vcd_on() && wanted.state.cpu.t < console.session.board.state.cpu.t) {
        throw DebugError("a VCD file cannot go back in time; `vcd off` ends it first");
    }
    console.serial.add(console.session.board.take_transmitted());
    console.serial.flush();
    console.session.board.state = wanted.state;
    console.session.state_changed();
    console.session.calls = wanted.calls;
    console.run_and_report([] { return Stop{}; });
}

void list(Console& console, Arguments& arguments) {
    arguments.expect_end();
    if (console.snapshots.empty()) console.write("no snapshots\n");
    for (const auto& [name, kept] : console.snapshots) {
        console.print("{}: {}, PC {}\n", name, time_text(kept.state.cpu.t),
                      console.session.names.address_text(kept.state.cpu.pc));
    }
}

// -- Differences
// ------------------------------------------------------------------------------------------------

void compare_registers(Console& console, const BoardState& then, const BoardState& now) {
    for (const char* name : {"A", "F", "BC", "DE", "HL", "SP", "PC", "IE", "MASKS", "T", "N"}) {
        const Register which = *find_register(name);
        const int64_t before = register_value(then.cpu, which);
        const int64_t after = register_value(now.cpu, which);
        if (before == after) continue;
        if (which == Register::t || which == Register::instructions) {
            console.print("{}: {} -> {}, +{}\n", name, before, after, after - before);
        } else {
            const int digits = before > 0xFF || after > 0xFF ? 4 : 2;
            console.print("{}: {} -> {}\n", name, intel_hex(static_cast<unsigned>(before), digits),
                          intel_hex(static_cast<unsigned>(after), digits));
        }
    }
}

void compare_memory(Console& console, const BoardState& then, const BoardState& now) {
    const auto differs = [&](unsigned address) {
        return address <= 0xFFFF && then.memory.bytes[address] != now.memory.bytes[address];
    };
    unsigned ranges = 0;
    for (unsigned first = 0; first <= 0xFFFF; ++first) {
        if (!differs(first)) continue;
        unsigned last = first;
        while (differs(last + 1)) ++last;
        if (++ranges <= kMemoryRangesShown) {
            const std::string name =
                console.session.names.address_text(static_cast<uint16_t>(first));
            if (first == last) {
                console.print("memory {}: {} -> {}\n", name, intel_hex(then.memory.bytes[first], 2),
                              intel_hex(now.memory.bytes[first], 2));
            } else {
                console.print("memory {}: {} bytes\n", name, last - first + 1);
            }
        }
        first = last;
    }
    if (ranges > kMemoryRangesShown) {
        console.print("memory: {} more places\n", ranges - kMemoryRangesShown);
    }
}

void compare_chip(Console& console, const ChipPart& part, const BoardState& then,
                  const BoardState& now) {
    if (part.equal(then, now)) return;
    const auto before = part.properties(then), after = part.properties(now);
    bool shown = false;
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
        if (before[i].value == after[i].value) continue;
        console.print("{} {}: {} -> {}\n", part.name, after[i].name, before[i].value,
                      after[i].value);
        shown = true;
    }
    if (!shown) console.print("{}: only times and buffers inside\n", part.name);
}

void difference(Console& console, Arguments& arguments) {
    const BoardState& then = take_snapshot(console, arguments).state;
    const BoardState& now = console.session.board.state;
    if (then == now) return console.write("no difference\n");
    compare_registers(console, then, now);
    compare_memory(console, then, now);
    for (const ChipPart& part : chip_parts()) compare_chip(console, part, then, now);
    const auto count = [&](const char* name, uint64_t before, uint64_t after) {
        if (before != after) console.print("{}: {} -> {}\n", name, before, after);
    };
    count("stimuli waiting", then.stimuli.size(), now.stimuli.size());
    count("undervoltage", then.undervoltage ? 1 : 0, now.undervoltage ? 1 : 0);
    count("bumper", then.bumper ? 1 : 0, now.bumper ? 1 : 0);
    count("violations", then.violation_count, now.violation_count);
    count("resets", then.reset_count, now.reset_count);
}

}  // namespace

std::vector<Command> snapshot_commands() {
    return {
        {"snapshot", "", "snapshot [NAME]", "keep the state of the whole board",
         "Processor, memory, every chip in the middle of what it does, and waiting stimuli.\n"
         "Without NAME it gets a number.\n"
         "  snapshot\n  snapshot before\n",
         snapshot},
        {"restore", "", "restore [NAME]", "bring a state back; without NAME the newest",
         "Time goes back with it; runs from there repeat themselves exactly.\n"
         "  restore before\n",
         restore},
        {"snapshots", "", "snapshots", "list what was kept", "  snapshots\n", list},
        {"diff", "", "diff [NAME]", "what has changed since a snapshot", "  diff before\n",
         difference},
    };
}

}  // namespace debug_console
