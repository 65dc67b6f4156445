// options.hpp - the command line of i85cc.
// Depends on   toolchain/driver/driver.hpp.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "toolchain/driver/driver.hpp"

namespace i85cc {

/// A command line that says nothing sensible: one line, what and what to do.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct Options {
    toolchain::driver::Request request{};
    std::string output{};  ///< OUT.hex, or the file for --emit; empty with --emit: standard output
    std::optional<toolchain::driver::Text> emit{};
    bool report = false;
    bool times = false;
    bool help = false;
    bool version = false;
};

/// Reads the arguments behind the program's name, in the manner of C compilers.
/// @errors  UsageError
[[nodiscard]] Options parse_options(const std::vector<std::string>& arguments);

[[nodiscard]] std::string help_text();

}  // namespace i85cc
