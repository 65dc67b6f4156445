// options.hpp - the command line of i85run.
// Depends on   CLI11 (source only), run.hpp, number.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "host_sim/cpu/cpu_state.hpp"
#include "tools/i85run/machine.hpp"

namespace i85run {

/// Exit codes of i85run.
enum ExitCode : int { kExitPass = 0, kExitUnfinished = 1, kExitUsage = 2, kExitBadInput = 3 };

/// What the user asked for. Empty text: not asked.
struct Options {
    std::string image;
    bool cpm = false;
    std::optional<uint16_t> load_address{};  ///< given: the image is BIN
    std::string symbols{};
    std::string entry{};           ///< symbol or address
    std::string count_function{};  ///< symbol or address
    std::optional<uint16_t> sp{};
    uint64_t max_t = std::numeric_limits<uint64_t>::max();
    host_sim::InstructionSet instruction_set = host_sim::InstructionSet::all;
    std::optional<host_sim::AddressRange> rom{};
    bool strict = false;
    std::vector<std::string> dumps{};  ///< SYM, SYM:LEN or ADDR:LEN
    std::string json{};
    std::string trace{};
    uint64_t trace_from_t = 0;
    uint64_t trace_to_t = std::numeric_limits<uint64_t>::max();
    bool profile = false;
    std::string profile_json{};
    std::string coverage{};
};

/// Reads the command line. Prints help, or what is wrong with one line on standard error.
/// @return  the options, or the exit code with which the program is over
[[nodiscard]] std::variant<Options, int> parse_options(int argc, const char* const* argv);

}  // namespace i85run
