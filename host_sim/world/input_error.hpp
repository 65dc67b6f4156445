// input_error.hpp - what the world throws on bad input files and options.
// The text is complete: where (file and line), what is wrong, what to do. Programs print it on one
// line and exit with 3.
#pragma once

#include <stdexcept>
#include <string>

namespace host_sim {

class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// "file:line: what".
inline InputError input_error(const std::string& file, std::size_t line, const std::string& what) {
    return InputError(file + ":" + std::to_string(line) + ": " + what);
}

}  // namespace host_sim
