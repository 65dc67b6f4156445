// process.hpp - running other programs, several at a time, and keeping what they say.
// Depends on   POSIX (posix_spawn).
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace toolchain::driver {

struct Command {
    std::vector<std::string> arguments{};  ///< the first is the program, looked up on PATH
    std::filesystem::path log{};           ///< file for standard output and standard error
};

struct Outcome {
    int start_error = 0;  ///< an errno: the program did not even start
    int exit_code = 0;    ///< if it ended by itself
    int signal = 0;       ///< if a signal ended it
    std::string messages{};

    [[nodiscard]] bool ok() const { return start_error == 0 && exit_code == 0 && signal == 0; }
};

/// Runs all commands, at most `jobs` at a time, with an empty standard input.
/// @return  what became of each, in the order of the commands
[[nodiscard]] std::vector<Outcome> run_all(std::span<const Command> commands, unsigned jobs);

}  // namespace toolchain::driver
