// report.hpp - a program's functions and memory as tables for people.
// Depends on   driver.hpp.
#pragma once

#include <string>

#include "toolchain/driver/driver.hpp"

namespace toolchain::driver {

/// Each function with its ROM, RAM, frame, stack and, where they are known, T-states; then totals.
[[nodiscard]] std::string report_text(const Result& result);

/// Seconds of every phase, and their sum.
[[nodiscard]] std::string times_text(const Result& result);

}  // namespace toolchain::driver
