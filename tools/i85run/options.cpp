#include "tools/i85run/options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/i85run/number.hpp"

namespace i85run {
namespace {

constexpr const char* kFooter = R"(Examples
  i85run sieve.hex                          run to HLT; print instructions, T-states, time
  i85run sieve.hex --dump primes            and the bytes of the variable `primes`
  i85run sieve.hex --dump 0x8000:16         and 16 bytes from 8000h
  i85run kernel.hex --entry fir --json r.json
                                            run the function `fir` alone, to its return
  i85run firmware.hex --count-function step --max-t 30720000
                                            ten seconds at 3.072 MHz; T-states of each `step`
  i85run firmware.hex --rom 0:0x7FFF --strict
                                            stop at the first write to ROM, with PC and T
  i85run loader.bin --load 0x9000           a plain binary, started at 9000h
  i85run --cpm 8080EX1.COM                  a CP/M program: console on the terminal
  i85run sieve.hex --profile --trace t.txt --trace-from 1000 --trace-to 2000

Numbers      0x8000 and 8000h are hexadecimal, 32768 is decimal
Symbols      from IMAGE with the extension .sym, or --symbols FILE
Exit codes   0 ran to HLT or return, 1 did not finish, 2 usage, 3 bad input

docs/guides/running-programs.md explains every line of the output.)";

/// The texts of the options that are numbers, until they are checked.
struct NumberTexts {
    std::string load, sp, rom, cpu = "8085u", max_t, trace_from_t, trace_to_t;
};

void add_run_options(CLI::App& app, Options& options, NumberTexts& texts) {
    app.add_option("IMAGE", options.image, "Intel HEX; BIN with --load; .COM with --cpm")
        ->required();
    app.add_flag("--cpm", options.cpm, "IMAGE is a CP/M program: load at 0100h, serve the BDOS");
    app.add_option("--load", texts.load, "IMAGE is BIN: load at ADDR and start there")
        ->type_name("ADDR");
    app.add_option("--entry", options.entry, "start here instead of where the image says")
        ->type_name("SYM|ADDR");
    app.add_option("--sp", texts.sp, "stack pointer (default 0: the stack is below 10000h)")
        ->type_name("ADDR");
    app.add_option("--max-t", texts.max_t, "give up after N T-states (default: never)")
        ->type_name("N");
    app.add_option("--cpu", texts.cpu, "8085: stop at undocumented instructions; 8085u: run them")
        ->check(CLI::IsMember({"8085", "8085u"}))
        ->capture_default_str();
    app.add_option("--rom", texts.rom, "protect these addresses, report writes to them")
        ->type_name("LO:HI");
    app.add_flag("--strict", options.strict, "stop at the first write to --rom");
    app.add_option("--symbols", options.symbols, "symbol file")->type_name("FILE");
}

void add_output_options(CLI::App& app, Options& options, NumberTexts& texts) {
    app.add_option("--dump", options.dumps, "print memory after the run; may be repeated")
        ->type_name("SYM|SYM:LEN|ADDR:LEN")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    app.add_option("--count-function", options.count_function, "calls and T-states of a function")
        ->type_name("SYM|ADDR");
    app.add_option("--json", options.json, "write the results for programs")->type_name("FILE");
    auto* const trace =
        app.add_option("--trace", options.trace, "write every instruction")->type_name("FILE");
    app.add_option("--trace-from", texts.trace_from_t, "first T-state of the trace")
        ->type_name("T")
        ->needs(trace);
    app.add_option("--trace-to", texts.trace_to_t, "last T-state of the trace")
        ->type_name("T")
        ->needs(trace);
    app.add_flag("--profile", options.profile, "print T-states by function");
    app.add_option("--profile-json", options.profile_json, "write the profile for programs")
        ->type_name("FILE");
    app.add_option("--coverage", options.coverage, "write executed instructions, for lcov")
        ->type_name("FILE.info");
}

std::optional<uint16_t> parse_address(const char* option, const std::string& text) {
    if (text.empty()) return std::nullopt;
    const auto value = parse_number(text, 0xFFFF);
    if (!value) {
        throw CLI::ValidationError(
            option, text + " is not an address; write 0x8000, 8000h or 32768, up to 0xFFFF");
    }
    return static_cast<uint16_t>(*value);
}

/// Leaves `t_states` alone when there is no text.
void parse_t(const char* option, const std::string& text, uint64_t& t_states) {
    if (text.empty()) return;
    const auto value = parse_t_states(text);
    if (!value) {
        throw CLI::ValidationError(option, text + " is not a number of T-states; write 3072000");
    }
    t_states = *value;
}

void check(Options& options, const NumberTexts& texts) {
    options.load_address = parse_address("--load", texts.load);
    options.sp = parse_address("--sp", texts.sp);
    parse_t("--max-t", texts.max_t, options.max_t);
    parse_t("--trace-from", texts.trace_from_t, options.trace_from_t);
    parse_t("--trace-to", texts.trace_to_t, options.trace_to_t);
    if (!texts.rom.empty()) {
        options.rom = parse_range(texts.rom);
        if (!options.rom) {
            throw CLI::ValidationError(
                "--rom", texts.rom + " is not a range LO:HI; for example --rom 0:0x7FFF");
        }
    }
    if (texts.cpu == "8085") options.instruction_set = host_sim::InstructionSet::documented;
    if (options.strict && !options.rom) {
        throw CLI::ValidationError("--strict", "needs --rom LO:HI, the range to watch");
    }
    if (options.cpm && (options.load_address || !options.entry.empty() || options.sp)) {
        throw CLI::ValidationError(
            "--cpm",
            "a CP/M program starts at 0100h with the system's stack; leave out --load, "
            "--entry and --sp");
    }
    for (const std::string& dump : options.dumps) {
        const auto place = parse_place(dump);
        const bool scoped_symbol = dump.find("::") != std::string::npos;
        if (!scoped_symbol && (!place || (!place->length && parse_number(dump, 0xFFFF)))) {
            throw CLI::ValidationError(
                "--dump", dump +
                              " has no length from 1 to 65536; write ADDR:LEN, for example "
                              "0x8000:16");
        }
    }
}

}  // namespace

std::variant<Options, int> parse_options(int argc, const char* const* argv) {
    Options options;
    NumberTexts texts;
    CLI::App app("i85run: runs an 8085 program to its end and counts its T-states.");
    app.name("i85run");
    app.footer(kFooter);
    app.get_formatter()->column_width(34);
    add_run_options(app, options, texts);
    add_output_options(app, options, texts);
    try {
        app.parse(argc, argv);
        check(options, texts);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        fmt::print(stderr, "i85run: {}; `i85run --help` shows examples\n", error.what());
        return kExitUsage;
    }
    return options;
}

}  // namespace i85run
