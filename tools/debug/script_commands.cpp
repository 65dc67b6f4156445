// script_commands.cpp - scripts, help and the end; and the list of all commands. See commands.hpp.
#include "tools/debug/console.hpp"

namespace debug_console {
namespace {

void source(Console& console, Arguments& arguments) {
    const auto quoted = arguments.take_quoted();
    const std::string file = quoted ? *quoted : arguments.word("FILE");
    arguments.expect_end();
    console.source(file);
}

void echo(Console& console, Arguments& arguments) {
    const auto quoted = arguments.take_quoted();
    console.print("{}\n", quoted ? *quoted : arguments.take_rest());
    arguments.expect_end();
}

void help(Console& console, Arguments& arguments) {
    if (arguments.empty()) {
        for (const Command& command : console.commands()) {
            const std::string name = command.alias.empty()
                                         ? std::string(command.name)
                                         : fmt::format("{} ({})", command.name, command.alias);
            console.print("{:<16} {}\n", name, command.summary);
        }
        console.write("`help COMMAND` shows syntax and examples; a command may be shortened.\n");
        return;
    }
    const Command& command = console.find_command(arguments.word("COMMAND"));
    arguments.expect_end();
    console.print("{}\n{}\n{}", command.syntax, command.summary, command.help);
}

void quit(Console& console, Arguments& arguments) {
    arguments.expect_end();
    console.quit();
}

}  // namespace

std::vector<Command> script_commands() {
    return {
        {"source", "", "source FILE", "run the commands in a file, up to the first error",
         "One command a line; # begins a comment.\n  source boot.rb85\n", source},
        {"echo", "", "echo TEXT", "print a line", "  echo after the boot\n", echo},
        {"help", "h", "help [COMMAND]", "this list, or syntax and examples of a command",
         "  help break\n", help},
        {"quit", "q", "quit", "leave; the end of the input does the same", "  quit\n", quit},
    };
}

std::vector<Command> all_commands() {
    std::vector<Command> all;
    for (const auto group :
         {run_commands, break_commands, show_commands, chip_commands, stimulus_commands,
          snapshot_commands, observe_commands, script_commands}) {
        for (const Command& command : group()) all.push_back(command);
    }
    return all;
}

}  // namespace debug_console
