// oracle.cpp - see oracle.hpp.
#include "tests/toolchain/csmith/oracle.hpp"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>

#include "tests/toolchain/csmith/process.hpp"

namespace csmith_test {

namespace {

constexpr unsigned kCompileSeconds = 60;
constexpr unsigned kRunSeconds = 60;
constexpr const char* kCycles = "20000000";  // 1.25 s of that processor
constexpr int kNotDone = 3;                  // exit status of avr_run

}  // namespace

std::string to_text(const Observation& observation) {
    switch (observation.kind) {
        case Observation::Kind::checksum:
            return fmt::format("{:08X}", observation.checksum);
        case Observation::Kind::no_end:
            return "does not end: " + observation.text;
        case Observation::Kind::refused:
            return "refused: " + observation.text;
        case Observation::Kind::too_large:
            return "too large: " + observation.text;
        default:
            return "failed: " + observation.text;
    }
}

std::vector<std::string> include_options() {
    return {fmt::format("-I{}/tests/toolchain/csmith/runtime", ROVER_SOURCE_DIR), "-w"};
}

Observation observe_avr(const Program& program, const std::string& level) {
    const WorkFolder folder;
    const std::string image = (folder.path() / "image.elf").string();
    // simavr gets more RAM than the part has; see avr_run.cpp.
    std::vector<std::string> command = {"avr-gcc",
                                        "-mmcu=atmega2560",
                                        "-std=gnu99",
                                        "-O" + level,
                                        "-fpack-struct=1",
                                        "-Wl,--defsym=__stack=0xFFF0",
                                        "-Wl,--defsym=__DATA_REGION_LENGTH__=0xE000"};
    for (const std::string& option : include_options()) command.push_back(option);
    for (const std::string& option : program.options) command.push_back(option);
    command.insert(command.end(), {program.source.string(), "-o", image});
    const Ran compiled = run_program(command, kCompileSeconds);
    if (compiled.end != Ran::End::finished) {
        if (compiled.status == 127) {
            throw std::runtime_error("avr-gcc is not installed: tools/setup test");
        }
        return {Observation::Kind::refused, 0, compiled.text};
    }
    const Ran ran = run_program({AVR_RUN_PROGRAM, image, kCycles}, kRunSeconds);
    Observation result{Observation::Kind::failed, 0, ran.text};
    if (ran.status == kNotDone && ran.end == Ran::End::failed) {
        return {Observation::Kind::no_end, 0, fmt::format("{} cycles of the AVR", kCycles)};
    }
    constexpr std::string_view kMark = "checksum ";
    if (ran.end != Ran::End::finished || !ran.text.starts_with(kMark)) return result;
    const char* first = ran.text.data() + kMark.size();
    const auto read = std::from_chars(first, first + 8, result.checksum, 16);
    if (read.ec == std::errc{}) result = {Observation::Kind::checksum, result.checksum, {}};
    return result;
}

}  // namespace csmith_test
