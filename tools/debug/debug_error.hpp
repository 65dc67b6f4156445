// debug_error.hpp - a command of the console that cannot be done as asked.
// Depends on   the standard library.
#pragma once

#include <stdexcept>

namespace debug_console {

/// What is wrong and what to do, for the person at the console. The board is as it was.
struct DebugError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

}  // namespace debug_console
