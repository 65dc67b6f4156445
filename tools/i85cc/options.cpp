// options.cpp - see options.hpp.
#include "tools/i85cc/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <charconv>
#include <string_view>

namespace i85cc {
namespace {

using toolchain::assembly::AddressRange;
using toolchain::driver::Text;
using toolchain::ir::Optimisation;

constexpr const char* kHelp = R"(i85cc [OPTIONS] -o OUT.hex SOURCES...

Compiles C and C++20 to a program for the Intel 8085: start-up, main, HLT. Writes OUT.hex and
beside it OUT.bin, .map, .lst, .sym. Needs clang-19 (on PATH, or I85CC_CLANG).

  -O0 -O1 -O2 -Os      how to optimise (default -Os: small, and hardly slower than -O2)
  --cpu=8085           documented instructions only (default)
  --cpu=8085u          the ten undocumented ones too: 5 % faster, for parts that have them
  --allow-recursion    functions may call themselves; slower, and the stack has no known bound
  --no-constructors    refuse static objects that are constructed at run time
  --small-runtime      smaller, slower routines for products and quotients of words
  --table-multiply     products of bytes by a table: 512 bytes where one is used, and faster
  --without STEP       leave a step of optimisation out, to find out whether a fault is its own;
                       may be repeated; a name that does not exist lists them
  --separate           each source behind it is optimised as a module of its own
  --keep NAME          keep a function or variable that main does not reach; may be repeated
  --rom FIRST-LAST     addresses of ROM (default 0-7FFFH)
  --ram FIRST-LAST     addresses of RAM (default 8000H-FEFFH)
  --stack BYTES        kept for the stack (default: the worst depth, exactly)
  --vectors ADDRESS    vectors stand there instead of at 0, for a program behind a loader
  --forward ADDRESS    a loader: TRAP and RST 5.5 to 7.5 go to the vectors of a program there
  -I -D -U -include -std= -W... -f...   as usual, passed on to clang

  --emit=llvm|mir|asm  print an inner stage instead; -o FILE: into FILE
  --report             print functions with their ROM, RAM, frame, stack and T-states
  --time, -v           print how long each phase takes; -v also the commands
  --help, --version

Examples
  i85cc -o hello.hex hello.c && i85run hello.hex
  i85cc -O2 --report -o firmware.hex -I. app/main.cpp
  i85cc --emit=asm sieve.c
  i85cc -o bench.hex --separate kernel.c tables.c

Numbers      0x8000 and 8000H are hexadecimal, 32768 is decimal
Exit codes   0 all is written; 1 not: messages on standard error, no file is touched
docs/guides/compiling.md explains the language's limits and i85.h.
)";

std::optional<uint32_t> parse_number(std::string_view text) {
    int base = 10;
    if (text.starts_with("0x") || text.starts_with("0X")) {
        text.remove_prefix(2);
        base = 16;
    } else if (text.ends_with('h') || text.ends_with('H')) {
        text.remove_suffix(1);
        base = 16;
    }
    uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (error != std::errc() || end != text.data() + text.size() || value > 0xFFFF) {
        return std::nullopt;
    }
    return value;
}

AddressRange parse_range(const std::string& option, const std::string& text) {
    const std::size_t dash = text.find('-');
    if (dash != std::string::npos) {
        const auto first = parse_number(std::string_view(text).substr(0, dash));
        const auto last = parse_number(std::string_view(text).substr(dash + 1));
        if (first && last && *first <= *last) {
            return {static_cast<uint16_t>(*first), static_cast<uint16_t>(*last)};
        }
    }
    throw UsageError(
        fmt::format("{}: '{}' is not a range of addresses: write FIRST-LAST, such as "
                    "8000H-0FEFFH",
                    option, text));
}

uint16_t parse_address(const std::string& option, const std::string& text) {
    if (const auto address = parse_number(text)) return static_cast<uint16_t>(*address);
    throw UsageError(
        fmt::format("{}: '{}' is not an address: write it such as 0800H", option, text));
}

toolchain::Step parse_step(const std::string& name) {
    if (const auto step = toolchain::step_named(name)) return *step;
    std::vector<std::string_view> names;
    for (const toolchain::StepName& known : toolchain::step_names()) names.push_back(known.name);
    throw UsageError(
        fmt::format("--without: no such step '{}'; there are {}", name, fmt::join(names, ", ")));
}

class Parser {
public:
    explicit Parser(const std::vector<std::string>& arguments) : arguments_(arguments) {}

    Options run() {
        while (next_ < arguments_.size()) take(arguments_[next_++]);
        if (!options_.help && !options_.version) check();
        return std::move(options_);
    }

private:
    void take(const std::string& argument) {
        if (argument.empty() || argument == "-") {
            throw UsageError("a source has an empty name: name a .c or .cpp file");
        }
        if (argument[0] != '-') {
            options_.request.sources.push_back({argument, std::nullopt, separate_});
        } else if (!take_flag(argument) && !take_valued(argument) && !take_for_clang(argument)) {
            throw UsageError(fmt::format("{}: unknown option: see i85cc --help", argument));
        }
    }

    bool take_flag(const std::string& argument) {
        struct Flag {
            const char* name;
            bool* target;
            bool value = true;
        };
        auto& request = options_.request;
        const std::array flags = {
            Flag{"--cpu=8085", &request.undocumented, false},
            Flag{"--cpu=8085u", &request.undocumented},
            Flag{"--allow-recursion", &request.allow_recursion},
            Flag{"--no-constructors", &request.allow_constructors, false},
            Flag{"--small-runtime", &request.small_runtime, true},
            Flag{"--table-multiply", &request.table_multiply},
            Flag{"--separate", &separate_},
            Flag{"--report", &options_.report},
            Flag{"--time", &options_.times},
            Flag{"-v", &request.verbose},
            Flag{"--help", &options_.help},
            Flag{"-h", &options_.help},
            Flag{"--version", &options_.version},
        };
        for (const Flag& flag : flags) {
            if (argument != flag.name) continue;
            *flag.target = flag.value;
            return true;
        }
        if (argument.starts_with("--cpu=")) {
            throw UsageError(fmt::format("{}: no such processor: 8085 or 8085u", argument));
        }
        return take_level(argument);
    }

    bool take_level(const std::string& argument) {
        if (!argument.starts_with("-O")) return false;
        const std::string_view level = std::string_view(argument).substr(2);
        Optimisation& wanted = options_.request.level;
        if (level == "0") {
            wanted = Optimisation::none;
        } else if (level == "1" || level.empty()) {
            wanted = Optimisation::less;
        } else if (level == "2") {
            wanted = Optimisation::more;
        } else if (level == "s") {
            wanted = Optimisation::size;
        } else {
            throw UsageError(fmt::format("{}: no such level: -O0, -O1, -O2 or -Os", argument));
        }
        return true;
    }

    /// The value of `name VALUE` or `name=VALUE`; nothing if the argument is another option.
    std::optional<std::string> value_of(const std::string& argument, const std::string& name) {
        if (argument.starts_with(name + "=")) return argument.substr(name.size() + 1);
        if (argument != name) return std::nullopt;
        if (next_ == arguments_.size()) {
            throw UsageError(fmt::format("{}: its value is missing: see i85cc --help", name));
        }
        return arguments_[next_++];
    }

    bool take_valued(const std::string& argument) {
        auto& request = options_.request;
        if (const auto output = value_of(argument, "-o")) {
            options_.output = *output;
        } else if (const auto kept = value_of(argument, "--keep")) {
            request.keep.push_back(*kept);
        } else if (const auto step = value_of(argument, "--without")) {
            request.steps.leave_out(parse_step(*step));
        } else if (const auto rom = value_of(argument, "--rom")) {
            request.rom = parse_range("--rom", *rom);
        } else if (const auto ram = value_of(argument, "--ram")) {
            request.ram = parse_range("--ram", *ram);
        } else if (const auto stack = value_of(argument, "--stack")) {
            request.stack_bytes = parse_number(*stack);
            if (!request.stack_bytes) {
                throw UsageError(fmt::format("--stack: '{}' is not a number of bytes", *stack));
            }
        } else if (const auto base = value_of(argument, "--vectors")) {
            request.vector_base = parse_address("--vectors", *base);
        } else if (const auto behind = value_of(argument, "--forward")) {
            request.forward_to = parse_address("--forward", *behind);
        } else if (const auto stage = value_of(argument, "--emit")) {
            options_.emit = parse_stage(*stage);
        } else {
            return false;
        }
        return true;
    }

    static Text parse_stage(const std::string& name) {
        if (name == "llvm") return Text::llvm;
        if (name == "mir") return Text::mir;
        if (name == "asm") return Text::assembly;
        throw UsageError(fmt::format("--emit: '{}' is no stage: llvm, mir or asm", name));
    }

    bool take_for_clang(const std::string& argument) {
        for (const char* name : {"-I", "-D", "-U", "-include", "-isystem", "-iquote"}) {
            if (argument != name) continue;
            if (next_ == arguments_.size()) {
                throw UsageError(fmt::format("{}: its value is missing: see i85cc --help", name));
            }
            options_.request.front_end.push_back(argument);
            options_.request.front_end.push_back(arguments_[next_++]);
            return true;
        }
        for (const char* start : {"-I", "-D", "-U", "-std=", "-W", "-f", "-pedantic", "-isystem"}) {
            if (!argument.starts_with(start)) continue;
            options_.request.front_end.push_back(argument);
            return true;
        }
        if (argument == "-g") return true;  // line tables are always there
        if (argument != "-w") return false;
        options_.request.front_end.push_back(argument);
        return true;
    }

    void check() const {
        if (options_.request.sources.empty()) {
            throw UsageError("no source is given: name a .c or .cpp file, or see i85cc --help");
        }
        if (options_.emit) return;
        if (options_.output.empty()) {
            throw UsageError("no output is given: add -o OUT.hex");
        }
        if (!options_.output.ends_with(".hex") || options_.output == ".hex" ||
            options_.output.ends_with("/.hex")) {
            throw UsageError(
                fmt::format("-o {}: the image's name has to end in .hex", options_.output));
        }
    }

    const std::vector<std::string>& arguments_;
    std::size_t next_ = 0;
    bool separate_ = false;
    Options options_;
};

}  // namespace

Options parse_options(const std::vector<std::string>& arguments) {
    return Parser(arguments).run();
}

std::string help_text() {
    return kHelp;
}

}  // namespace i85cc
