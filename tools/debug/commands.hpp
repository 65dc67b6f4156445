// commands.hpp - the console's commands, in groups of one source file each.
// Depends on   arguments.hpp.
#pragma once

#include <string_view>
#include <vector>

#include "tools/debug/arguments.hpp"

namespace debug_console {

class Console;

/// One command and its help.
struct Command {
    std::string_view name;
    std::string_view alias;  ///< a second name, short; may be empty
    std::string_view syntax;
    std::string_view summary;  ///< one line
    std::string_view help;     ///< further lines with examples, each ending in a line feed
    void (*run)(Console& console, Arguments& arguments);
    bool stimulus = false;  ///< can be scheduled with `at`
};

/// step, over, finish, until, continue, goto.
[[nodiscard]] std::vector<Command> run_commands();
/// break, tbreak, delete, enable, disable, ignore.
[[nodiscard]] std::vector<Command> break_commands();
/// registers, set, print, disassemble, memory, poke, stack, where, symbols.
[[nodiscard]] std::vector<Command> show_commands();
/// chips, violations.
[[nodiscard]] std::vector<Command> chip_commands();
/// send, sensor, tach, trap, service, detectors, scan, reset, power, at, serial.
[[nodiscard]] std::vector<Command> stimulus_commands();
/// snapshot, restore, snapshots, diff.
[[nodiscard]] std::vector<Command> snapshot_commands();
/// trace, profile, coverage, vcd.
[[nodiscard]] std::vector<Command> observe_commands();
/// source, echo, help, quit.
[[nodiscard]] std::vector<Command> script_commands();

/// All of them, in this order.
[[nodiscard]] std::vector<Command> all_commands();

}  // namespace debug_console
