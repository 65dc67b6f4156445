#include "tools/rover85/debug_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tools/debug/console.hpp"
#include "tools/debug/load.hpp"
#include "tools/rover85/command_errors.hpp"

namespace {

constexpr unsigned kRamKbMax = 32;
constexpr unsigned kBytesPerKb = 1024;

struct DebugOptions {
    std::string image, symbols, load, cpu = "8085u";
    std::vector<std::string> scripts, commands;
    unsigned ram_kb = kRamKbMax;
    bool interactive = false, stop_at_violation = false, stop_at_halt = false;
};

volatile std::sig_atomic_t interrupt_asked = 0;

void ask_interrupt(int) {
    interrupt_asked = 1;
}

/// From now on Ctrl-C ends a run instead of the program.
void watch_interrupt_key() {
    struct sigaction action{};
    action.sa_handler = ask_interrupt;
    action.sa_flags = SA_RESTART;
    sigaction(SIGINT, &action, nullptr);
}

/// Whether it was pressed since the last call.
bool take_interrupt() {
    const bool asked = interrupt_asked != 0;
    interrupt_asked = 0;
    return asked;
}

host_sim::BoardOptions board_options(const DebugOptions& options) {
    host_sim::BoardOptions board;
    board.instruction_set = options.cpu == "8085" ? host_sim::InstructionSet::documented
                                                  : host_sim::InstructionSet::all;
    board.memory_map.ram_last =
        static_cast<uint16_t>(board.memory_map.ram_first + options.ram_kb * kBytesPerKb - 1);
    board.stop_at_violation = options.stop_at_violation;
    board.stop_at_halt = options.stop_at_halt;
    return board;
}

void greet(const DebugOptions& options, const host_sim::Image& image,
           const host_sim::Symbols& symbols) {
    fmt::print("RB-85 with {}: {} bytes, {} symbols. `help` lists the commands.\n", options.image,
               image.byte_count(), symbols.all().size());
    if (image.start.value_or(0) != 0) {
        fmt::print("The image wants to start at {:04X}H, the processor starts at 0: `goto`.\n",
                   *image.start);
    }
    std::fflush(stdout);
}

int debug(const DebugOptions& options) {
    std::optional<uint16_t> load_address;
    if (!options.load.empty()) {
        const auto number = debug_console::parse_number(options.load);
        if (!number || *number > 0xFFFF) {
            throw debug_console::DebugError(
                fmt::format("--load {}: is not an address; write 8000H or 0x8000", options.load));
        }
        load_address = static_cast<uint16_t>(*number);
    }
    const host_sim::Image image = debug_console::read_image(options.image, load_address);
    const host_sim::Symbols symbols = debug_console::find_symbols(options.symbols, options.image);
    debug_console::Session session(board_options(options), debug_console::Names(symbols));
    debug_console::load_image(image, session.board);
    watch_interrupt_key();
    session.interrupted = take_interrupt;
    debug_console::Console console(session, std::cout);
    console.observers.image = image;

    for (const std::string& script : options.scripts) {
        if (!console.finished()) console.source(script);
    }
    std::string lines;
    for (const std::string& command : options.commands) lines += command + "\n";
    std::istringstream commands(lines);
    if (!console.finished()) console.run_script(commands, "--command");
    const bool more = options.interactive || (options.scripts.empty() && options.commands.empty());
    if (more && !console.finished()) {
        if (isatty(STDIN_FILENO) != 0) {
            greet(options, image, symbols);
            console.interact(std::cin);
        } else {
            console.run_script(std::cin, "standard input");
        }
    }
    console.observers.close();
    return kExitPass;
}

void add_options(CLI::App& command, DebugOptions& options) {
    command.add_option("IMAGE", options.image, "Program: Intel HEX or BIN")
        ->required()
        ->type_name("IMAGE");
    command
        .add_option("--symbols", options.symbols,
                    "Symbol file [default: IMAGE with the ending .sym, if it exists]")
        ->type_name("FILE");
    command.add_option("--load", options.load, "Address of a BIN [default: 0]")
        ->type_name("ADDRESS");
    command.add_option("--cpu", options.cpu, "8085: documented instructions only")
        ->check(CLI::IsMember({"8085", "8085u"}))
        ->capture_default_str();
    command.add_option("--ram", options.ram_kb, "Size of the RAM from 8000H on, in KB")
        ->check(CLI::Range(1U, kRamKbMax))
        ->capture_default_str();
    command.add_flag("--stop-at-violation", options.stop_at_violation,
                     "Stop at accesses that working software does not make");
    command.add_flag("--stop-at-halt", options.stop_at_halt,
                     "Stop at HLT with interrupts disabled");
    command.add_option("-x,--script", options.scripts, "Run the commands in a file; repeatable")
        ->type_name("FILE")
        ->allow_extra_args(false);
    command.add_option("--command", options.commands, "Run a command, after the files; repeatable")
        ->type_name("COMMAND")
        ->allow_extra_args(false);
    command.add_flag("-i,--interactive", options.interactive,
                     "Read commands from standard input when those of -x and --command are done");
}

}  // namespace

void add_debug_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<DebugOptions>();
    CLI::App& command = *app.add_subcommand(
        "debug", "Run an image on the simulated board: breakpoints, steps, chips, stimuli");
    add_options(command, *options);
    command.footer(
        "Without -x and --command, commands come from standard input; `help` there lists them.\n"
        "Ctrl-C stops a running program. In a script the first error ends it with exit code 3.\n"
        "Examples:\n"
        "  rover85 debug rover85.hex\n"
        "  rover85 debug rover85.hex --command \"break main\" --command continue -i\n"
        "  rover85 debug rover85.hex -x boot.rb85\n"
        "  rover85 debug test.bin --load 8000H --command \"goto 8000H\" --command \"step 20\"\n"
        "  echo \"until 1s\" | rover85 debug rover85.hex --stop-at-violation");
    command.callback(
        [options, &exit_code] { exit_code = guarded([&] { return debug(*options); }); });
}
