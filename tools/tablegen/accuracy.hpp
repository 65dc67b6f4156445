// accuracy.hpp - measured errors of the firmware's core functions against double precision.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tablegen {

/// Errors of one function, in units of its last place.
struct Accuracy {
    std::string function;
    std::string result;  ///< format of the result
    std::string inputs;  ///< which arguments were tried
    uint64_t count = 0;  ///< how many
    double max_error = 0.0;
    double mean_error = 0.0;
    double bound = 0.0;  ///< what the documentation promises
};

/// Measures every function; about a second.
std::vector<Accuracy> measure_accuracy();

/// A Markdown table.
std::string accuracy_table(const std::vector<Accuracy>& rows);

}  // namespace tablegen
