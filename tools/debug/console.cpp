// console.cpp - see console.hpp.
#include "tools/debug/console.hpp"

#include <algorithm>
#include <fstream>
#include <istream>
#include <ostream>

#include "toolchain/isa/disassemble.hpp"
#include "tools/debug/registers.hpp"

namespace debug_console {

using toolchain::isa::intel_hex;

namespace {

constexpr unsigned kScriptDepthMax = 16;
constexpr std::string_view kPrompt = "rb85> ";

std::string t_states_text(uint8_t opcode) {
    const toolchain::isa::Instruction& entry = toolchain::isa::instruction(opcode);
    return entry.conditional() ? fmt::format("{}/{}", entry.t_not_taken, entry.t_taken)
                               : fmt::format("{}", entry.t_taken);
}

}  // namespace

Console::Console(Session& controlled, std::ostream& stream)
    : session(controlled),
      serial([this](std::string_view text) { write(text); }),
      observers(controlled),
      out_(stream),
      commands_(all_commands()) {
    session.between_slices = [this] { serial.add(session.board.take_transmitted()); };
}

Console::~Console() {
    session.between_slices = nullptr;
}

void Console::write(std::string_view text) {
    out_ << text << std::flush;
}

// -- Lines and scripts
// ------------------------------------------------------------------------------------------------

const Command& Console::find_command(std::string_view word) const {
    std::vector<const Command*> matches;
    for (const Command& command : commands_) {
        if (same_word(command.name, word) || same_word(command.alias, word)) return command;
        if (same_word(command.name.substr(0, word.size()), word)) matches.push_back(&command);
    }
    if (matches.size() == 1) return *matches.front();
    if (matches.empty()) {
        throw DebugError(fmt::format("{}: no such command; `help` lists them", word));
    }
    std::string names;
    for (const Command* match : matches) names += fmt::format(" {}", match->name);
    throw DebugError(fmt::format("{}: could be{}; write more of it", word, names));
}

void Console::dispatch(const Command& command, Arguments& arguments) {
    interrupted_ = false;
    if (session.interrupted) session.interrupted();  // a Ctrl-C before this command is not for it
    try {
        command.run(*this, arguments);
    } catch (const std::runtime_error& error) {  // a file that cannot be written, for example
        serial.flush();
        throw DebugError(error.what());
    }
}

void Console::execute(std::string_view line) {
    Arguments arguments(without_comment(line));
    if (arguments.empty()) return;
    const Command& command = find_command(arguments.word("COMMAND"));
    dispatch(command, arguments);
}

void Console::run_script(std::istream& script, const std::string& name) {
    if (depth_ >= kScriptDepthMax) {
        throw DebugError(
            fmt::format("{}: scripts are nested more than {} deep; does one source "
                        "itself?",
                        name, kScriptDepthMax));
    }
    ++depth_;
    unsigned number = 0;
    try {
        for (std::string line; !finished_ && std::getline(script, line);) {
            ++number;
            execute(line);
            if (interrupted_) throw DebugError("interrupted; the rest was not run");
        }
    } catch (const DebugError& error) {
        --depth_;
        throw DebugError(fmt::format("{}:{}: {}", name, number, error.what()));
    }
    --depth_;
}

void Console::source(const std::string& file) {
    std::ifstream script(file);
    if (!script) throw DebugError(fmt::format("{}: cannot be read; check the path", file));
    run_script(script, file);
}

void Console::interact(std::istream& input) {
    std::string before;
    for (std::string line; !finished_; before = line) {
        write(kPrompt);
        if (!std::getline(input, line)) {
            write("\n");
            return;
        }
        if (line.empty()) line = before;
        try {
            execute(line);
        } catch (const DebugError& error) {
            print("{}\n", error.what());
        }
    }
}

// -- Arguments
// ------------------------------------------------------------------------------------------------

int64_t Console::take_value(Arguments& arguments, std::string_view meaning, int64_t min,
                            int64_t max) const {
    const std::string word = arguments.word(meaning);
    const int64_t value = Expression::parse(word, session.names).value(session.board.state);
    if (value < min || value > max) {
        throw DebugError(
            fmt::format("{} is {}; {} is from {} to {}", word, value, meaning, min, max));
    }
    return value;
}

uint16_t Console::take_address(Arguments& arguments, std::string_view meaning) const {
    return static_cast<uint16_t>(take_value(arguments, meaning, 0, 0xFFFF));
}

Console::Range Console::take_range(Arguments& arguments) const {
    const std::string word = arguments.word("ADDRESS");
    const std::size_t dots = word.find("..");
    Arguments first(std::string_view(word).substr(0, dots));
    Range range;
    range.first = range.last = take_address(first);
    if (dots == std::string::npos) return range;
    Arguments last(std::string_view(word).substr(dots + 2));
    range.last = take_address(last);
    if (range.last < range.first) {
        throw DebugError(fmt::format("{}: the range ends before it begins", word));
    }
    return range;
}

// -- Output
// ------------------------------------------------------------------------------------------------

std::string Console::listing_line(uint16_t address, uint8_t& bytes) const {
    const host_sim::BoardState& state = session.board.state;
    std::array<uint8_t, 3> code{};
    for (unsigned i = 0; i < code.size(); ++i) {
        code[i] = state.memory.bytes[static_cast<uint16_t>(address + i)];
    }
    toolchain::isa::DisassembleOptions options;
    options.address_text = [this](uint16_t target) { return session.names.near(target); };
    const toolchain::isa::Disassembly instruction = disassemble(code, options);
    bytes = instruction.bytes;
    std::string dump;
    for (unsigned i = 0; i < bytes; ++i) dump += fmt::format("{:02X} ", code[i]);
    return fmt::format("{}{} {:04X}  {:<9} {:<24} {:>5} T", state.cpu.pc == address ? '>' : ' ',
                       session.breakpoints.waits_at(address) ? '*' : ' ', address, dump,
                       instruction.text, t_states_text(code[0]));
}

void Console::report(const Stop& stop, uint64_t from_t, uint64_t resets_before) {
    serial.add(session.board.take_transmitted());
    serial.flush();
    interrupted_ = stop.kind == Stop::Kind::interrupted;
    if (!stop.text.empty()) print("{}\n", stop.text);
    const host_sim::BoardState& state = session.board.state;
    if (state.reset_count > resets_before) {
        print("the board was reset {} time(s) on the way; the watchdog has fired {} time(s)\n",
              state.reset_count - resets_before, state.watchdog.fired_count);
    }
    print("{}, +{}{}\n", time_text(state.cpu.t), state.cpu.t - from_t,
          state.cpu.halted ? ", in HALT" : "");
    uint8_t bytes = 0;
    std::string place = listing_line(state.cpu.pc, bytes);
    for (const std::string& known :
         {session.names.near(state.cpu.pc), session.names.source_text(state.cpu.pc)}) {
        if (!known.empty()) place += "  " + known;
    }
    print("{}\n", place);
    next_listing.reset();
}

}  // namespace debug_console
