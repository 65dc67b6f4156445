// observe_commands.cpp - commands for trace, profile, coverage and signals. See commands.hpp.
#include "tools/debug/console.hpp"

namespace debug_console {
namespace {

constexpr unsigned kVariableBytesMax = 4;

std::string take_file(Arguments& arguments) {
    const auto quoted = arguments.take_quoted();
    return quoted ? *quoted : arguments.word("FILE");
}

void trace(Console& console, Arguments& arguments) {
    if (arguments.take("off")) {
        arguments.expect_end();
        return console.observers.stop_trace();
    }
    if (!arguments.take("on")) throw DebugError("on FILE or off is missing");
    const std::string file = take_file(arguments);
    arguments.expect_end();
    console.observers.start_trace(file);
}

void profile(Console& console, Arguments& arguments) {
    const bool on = arguments.take("on"), off = !on && arguments.take("off");
    const bool json = !on && !off && arguments.take("json");
    if (!on && !off && !json && !arguments.take("show")) {
        throw DebugError("on, show, json or off is missing");
    }
    arguments.expect_end();
    if (on) return console.observers.start_profile();
    if (off) return console.observers.stop_profile();
    const host_sim::ProfileReport report = console.observers.profile();
    console.write(json ? profile_json(report) + "\n" : profile_text(report));
}

void coverage(Console& console, Arguments& arguments) {
    const bool on = arguments.take("on"), off = !on && arguments.take("off");
    const bool show = !on && !off && arguments.take("show");
    const std::string file = on || off || show ? std::string() : take_file(arguments);
    arguments.expect_end();
    if (on) return console.observers.start_coverage();
    if (off) return console.observers.stop_coverage();
    if (show) return console.write(console.observers.coverage_text());
    for (const std::string& written : console.observers.write_coverage(file)) {
        console.print("wrote {}\n", written);
    }
}

/// "NAME" is a byte at a symbol or address, "NAME:2" two bytes.
host_sim::VcdVariable take_variable(Console& console, Arguments& arguments) {
    std::string word = arguments.word("VARIABLE");
    host_sim::VcdVariable variable;
    const std::size_t colon = word.rfind(':');
    if (colon != std::string::npos && colon > 0 && word[colon - 1] != ':') {
        const auto size = parse_number(std::string_view(word).substr(colon + 1));
        if (!size || *size < 1 || *size > kVariableBytesMax) {
            throw DebugError(fmt::format("{}: a variable has 1 to {} bytes, as in name:2", word,
                                         kVariableBytesMax));
        }
        variable.size = static_cast<uint8_t>(*size);
        word.resize(colon);
    }
    Arguments place(word);
    variable.address = console.take_address(place);
    variable.name = word;
    return variable;
}

void vcd(Console& console, Arguments& arguments) {
    if (arguments.take("off")) {
        arguments.expect_end();
        return console.observers.stop_vcd();
    }
    if (!arguments.take("on")) throw DebugError("on FILE or off is missing");
    const std::string file = take_file(arguments);
    std::vector<host_sim::VcdVariable> variables;
    while (!arguments.empty()) variables.push_back(take_variable(console, arguments));
    console.observers.start_vcd(file, variables);
}

}  // namespace

std::vector<Command> observe_commands() {
    return {
        {"trace", "", "trace on FILE | trace off", "every step as a line of a file",
         "Runs are slower while something observes.\n  trace on boot.txt\n  trace off\n", trace},
        {"profile", "", "profile on|show|json|off", "T-states of functions and interrupts",
         "Adds up what runs from `profile on` on.\n"
         "  profile on\n  profile show\n  profile json\n  profile off\n",
         profile},
        {"coverage", "", "coverage on|show|off | coverage FILE", "which instructions have run",
         "`coverage FILE` writes an lcov .info of the sources, or of a listing beside it.\n"
         "  coverage on\n  coverage show\n  coverage boot.info\n  coverage off\n",
         coverage},
        {"vcd", "", "vcd on FILE [VARIABLE[:BYTES]...] | vcd off",
         "pins, ports and registers over time, for GTKWave",
         "  vcd on boot.vcd\n  vcd on boot.vcd mode buffer:2\n  vcd off\n", vcd},
    };
}

}  // namespace debug_console
