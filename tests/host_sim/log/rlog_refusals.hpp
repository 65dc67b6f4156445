// rlog_refusals.hpp - what reading a wrong .rlog says, for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "host_sim/log/log_io.hpp"

namespace log_test {

/// The error that reading `bytes` gives; fails the test if they are accepted.
inline host_sim::LogError error_of(const std::string& bytes) {
    try {
        host_sim::read_rlog(bytes, "x.rlog");
    } catch (const host_sim::LogError& error) {
        return error;
    }
    ADD_FAILURE() << "accepted";
    return {"", {}, "", ""};
}

/// Is it refused at this byte of the file, with an error that contains `what`?
inline testing::AssertionResult refused_at(const std::string& bytes, std::size_t offset,
                                           const std::string& what) {
    const host_sim::LogError error = error_of(bytes);
    if (error.byte_offset() == static_cast<std::int64_t>(offset) &&
        std::string(error.what()).find(what) != std::string::npos) {
        return testing::AssertionSuccess();
    }
    return testing::AssertionFailure()
           << error.what() << " (expected byte " << offset << ": " << what << ")";
}

/// File offset of byte `at` of the payload of the record that starts at `record`.
constexpr std::size_t payload_at(std::size_t record, std::size_t at) {
    return record + 9 + at;
}

}  // namespace log_test
