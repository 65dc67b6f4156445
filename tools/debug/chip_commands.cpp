// chip_commands.cpp - commands that show the chips of the board. See commands.hpp.
#include "tools/debug/chip_parts.hpp"
#include "tools/debug/console.hpp"

namespace debug_console {

using host_sim::BoardState;

namespace {

void show(Console& console, const ChipPart& part) {
    console.print("{}: {}\n", part.name, part.description);
    for (const auto& [name, value] : part.properties(console.session.board.state)) {
        console.print("  {}: {}\n", name, value);
    }
}

void chips(Console& console, Arguments& arguments) {
    const std::string wanted = arguments.empty() ? std::string() : arguments.word("NAME");
    arguments.expect_end();
    const bool all = same_word(wanted, "all");
    bool known = all || wanted.empty();
    for (const ChipPart& part : chip_parts()) {
        if (wanted.empty()) {
            console.print("{:<9} {}\n", part.name, part.description);
        } else if (all || same_word(wanted, part.name)) {
            show(console, part);
            known = true;
        }
    }
    if (!known) throw DebugError(fmt::format("{}: no such chip; `chips` lists them", wanted));
}

void violations(Console& console, Arguments& arguments) {
    arguments.expect_end();
    const BoardState& state = console.session.board.state;
    console.print("{} violation(s)\n", state.violation_count);
    if (state.violation_count == 0) return;
    console.print("first: {}\n", violation_text(state.first_violation, console.session.names));
    if (state.violation_count == 1) return;
    console.print("last:  {}\n", violation_text(state.last_violation, console.session.names));
}

}  // namespace

std::vector<Command> chip_commands() {
    return {
        {"chips", "", "chips [NAME|all]", "list the chips, or show the state of one",
         "Registers, pins, and counts of what careful software does not do.\n"
         "  chips\n  chips usart\n",
         chips},
        {"violations", "", "violations", "what working software does not do: count, first, last",
         "Writes where no memory is, writes that the EEPROM ignored, ports that no chip answers.\n"
         "--stop-at-violation stops a run there.\n"
         "  violations\n",
         violations},
    };
}

}  // namespace debug_console
