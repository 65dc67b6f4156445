// front_end.cpp - see front_end.hpp.
#include "toolchain/driver/front_end.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "toolchain/driver/process.hpp"
#include "toolchain/driver/resources.hpp"

namespace toolchain::driver {
namespace fs = std::filesystem;
namespace {

enum class Language : uint8_t { c, cpp, llvm };

Language language_of(const fs::path& path) {
    const std::string extension = path.extension().string();
    if (extension == ".c") return Language::c;
    if (extension == ".ll" || extension == ".bc") return Language::llvm;
    return Language::cpp;
}

std::string clang_program() {
    const char* chosen = std::getenv("I85CC_CLANG");
    return chosen != nullptr && *chosen != 0 ? chosen : "clang-19";
}

void write_file(const fs::path& path, std::string_view text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) throw Failed(fmt::format("{}: cannot be written: free some space", path.string()));
}

void check_readable(const std::string& path) {
    std::error_code problem;
    const bool folder = fs::is_directory(path, problem);
    if (!folder && access(path.c_str(), R_OK) == 0) return;
    throw Failed(fmt::format("{}: cannot be read: {}: check the path", path,
                             folder ? "it is a folder" : std::strerror(errno)));
}

/// Whether an -std= is meant for the language: a program may mix C and C++.
bool suits(const std::string& argument, Language language) {
    if (!argument.starts_with("-std=")) return true;
    return (argument.find("++") != std::string::npos) == (language == Language::cpp);
}

const char* level_option(ir::Optimisation level) {
    switch (level) {
        case ir::Optimisation::none:
            return "-O0";
        case ir::Optimisation::less:
            return "-O1";
        case ir::Optimisation::more:
            return "-O2";
        case ir::Optimisation::size:
            break;
    }
    return "-Os";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size())) {
        text.replace(at, from.size(), to);
    }
    return text;
}

void tell(const Request& request, const std::string& text) {
    if (text.empty()) return;
    if (request.messages) {
        request.messages(text);
    } else {
        fmt::print(stderr, "{}", text);
    }
}

[[noreturn]] void fail_to_start(const std::string& program, int error) {
    throw Failed(
        fmt::format("{}: cannot be started: {}: install clang-19 (tools/setup run), or "
                    "set I85CC_CLANG to its path",
                    program, std::strerror(error)));
}

void check(const Outcome& outcome, const std::string& program, const std::string& path) {
    if (outcome.start_error != 0) fail_to_start(program, outcome.start_error);
    if (outcome.ok()) return;
    if (outcome.signal != 0 || outcome.exit_code > 1) {
        throw Failed(fmt::format("{}: {} crashed; its message is above", path, program));
    }
    throw Failed(fmt::format("{}: not compiled: see the messages above", path));
}

}  // namespace

std::vector<std::string> clang_arguments(const Request& request, const std::string& path,
                                         const fs::path& input, const fs::path& output,
                                         const fs::path& include) {
    const Language language = language_of(path);
    std::vector<std::string> arguments = {
        clang_program(),
        "-x",
        language == Language::c ? "c" : "c++",
        language == Language::c ? "-std=gnu17" : "-std=gnu++20",
        "--target=msp430-none-elf",
        // The 8085 needs no alignment.
        "-fpack-struct=1",
        // -ffreestanding without its effect on main, which would get a mangled name and no
        // implicit return.
        "-fno-builtin",
        "-Wno-builtin-macro-redefined",
        "-U__STDC_HOSTED__",
        "-D__STDC_HOSTED__=0",
        "-U__MSP430__",
        "-UMSP430",
        "-D__I8085__=1",
        "-fno-exceptions",
        "-fno-rtti",
        "-fno-threadsafe-statics",
        // A program ends by HLT; nobody would call destructors of static objects.
        "-fno-c++-static-destructors",
        // An interrupt attribute that has no effect would be a wrong program.
        "-Werror=ignored-attributes",
        "-nostdlibinc",
        "-isystem",
        include.string(),
        "-gline-tables-only",
        // Messages and line tables speak of names that mean something to people.
        fmt::format("-ffile-prefix-map={}={}", input.string(), path),
        fmt::format("-ffile-prefix-map={}/=", include.string()),
        level_option(request.level),
        "-Xclang",
        "-disable-llvm-passes",
        "-Xclang",
        "-disable-O0-optnone",
        "-emit-llvm",
        "-c",
        "-o",
        output.string(),
    };
    if (language == Language::c) std::erase(arguments, "-fno-rtti");
    if (isatty(STDERR_FILENO) == 1 && !request.messages)
        arguments.emplace_back("-fcolor-diagnostics");
    for (const std::string& argument : request.front_end) {
        if (suits(argument, language)) arguments.push_back(argument);
    }
    arguments.push_back(input.string());
    return arguments;
}

std::vector<fs::path> run_front_end(const Request& request, const fs::path& work) {
    const fs::path include = work / "include";
    fs::create_directories(include);
    for (const Resource& file : include_files()) {
        write_file(include / file.name, file.text);
    }
    std::vector<fs::path> results;
    std::vector<Command> commands;
    std::vector<std::string> paths;   // as people know them
    std::vector<std::string> inputs;  // as clang does
    for (std::size_t i = 0; i < request.sources.size(); ++i) {
        const Source& source = request.sources[i];
        const Language language = language_of(source.path);
        fs::path input = source.path;
        if (source.text) {
            input = work / fmt::format("{}{}", i, fs::path(source.path).extension().string());
            write_file(input, *source.text);
        } else {
            check_readable(source.path);
        }
        if (language == Language::llvm) {
            results.push_back(input);
            continue;
        }
        results.push_back(work / fmt::format("{}.bc", i));
        commands.push_back({clang_arguments(request, source.path, input, results.back(), include),
                            work / fmt::format("{}.log", i)});
        paths.push_back(source.path);
        inputs.push_back(input.string());
    }
    if (request.verbose) {
        for (const Command& command : commands) {
            tell(request, fmt::format("{}\n", fmt::join(command.arguments, " ")));
        }
    }
    const std::vector<Outcome> outcomes = run_all(commands, request.jobs);
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
        const std::string said = replaced(outcomes[i].messages, inputs[i], paths[i]);
        tell(request, replaced(said, include.string() + "/", ""));
    }
    for (std::size_t i = 0; i < outcomes.size(); ++i) check(outcomes[i], clang_program(), paths[i]);
    return results;
}

}  // namespace toolchain::driver
