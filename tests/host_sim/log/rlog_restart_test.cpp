// rlog_restart_test.cpp - restart records (type 03h) against docs/spec/log-format.md.
#include <gtest/gtest.h>

#include <string>

#include "host_sim/log/log_io.hpp"
#include "log_samples.hpp"
#include "rlog_builder.hpp"
#include "rlog_refusals.hpp"

namespace {

using host_sim::encode_rlog;
using host_sim::Log;
using host_sim::LogError;
using host_sim::read_rlog;
using log_test::payload_at;
using log_test::plain_head;
using log_test::plain_step;
using log_test::refused_at;
using log_test::RlogBuilder;
using log_test::small_log;

TEST(Rlog, ARestartRecordMarksTheStepBehindIt) {
    RlogBuilder builder;
    builder.record(1, plain_head()).record(2, plain_step(1)).record(3, "\x01").record(0x80, "");
    builder.record(2, plain_step(2)).record(3, "\x02").record(2, plain_step(3));
    const Log log = read_rlog(builder.bytes, "x");
    ASSERT_EQ(log.steps.size(), 3u);
    EXPECT_EQ(log.steps[0].restart, host_sim::Restart::none);
    EXPECT_EQ(log.steps[1].restart, host_sim::Restart::warm);
    EXPECT_EQ(log.steps[2].restart, host_sim::Restart::cold);
    RlogBuilder plain;  // the same without the record of type 80h
    plain.record(1, plain_head()).record(2, plain_step(1)).record(3, "\x01");
    plain.record(2, plain_step(2)).record(3, "\x02").record(2, plain_step(3));
    EXPECT_EQ(encode_rlog(log), plain.bytes);
}

TEST(Rlog, WrongRestartRecordsAreRefused) {
    for (const std::string& payload : {std::string(1, '\0'), std::string("\x03")}) {
        RlogBuilder builder;
        builder.record(1, plain_head()).record(3, payload).record(2, plain_step(1));
        EXPECT_TRUE(refused_at(builder.bytes, payload_at(builder.offsets[1], 0), "out of range"));
    }
    for (const std::string& payload : {std::string(), std::string("\x01\x01")}) {
        RlogBuilder builder;
        builder.record(1, plain_head()).record(3, payload).record(2, plain_step(1));
        EXPECT_TRUE(refused_at(builder.bytes,
                               payload_at(builder.offsets[1], payload.empty() ? 0 : 1),
                               payload.empty() ? "too short" : "longer"));
    }
    RlogBuilder twice;
    twice.record(1, plain_head()).record(3, "\x01").record(3, "\x01").record(2, plain_step(1));
    EXPECT_TRUE(refused_at(twice.bytes, payload_at(twice.offsets[2], 0), "two restarts"));
    Log log = small_log(1);
    log.steps[0].restart = static_cast<host_sim::Restart>(3);
    EXPECT_THROW(encode_rlog(log), LogError);
}

TEST(Rlog, ARestartWithoutItsStepIsRefusedAndSalvagedAway) {
    RlogBuilder builder;
    builder.record(1, plain_head()).record(2, plain_step(1)).record(3, "\x01");
    EXPECT_TRUE(refused_at(builder.bytes, builder.offsets[2], "its step is missing"));
    const std::size_t step_at = builder.bytes.size();
    builder.record(2, plain_step(2));
    for (std::size_t size = builder.offsets[2]; size < builder.bytes.size(); ++size) {
        host_sim::Recovery recovery;
        const std::string torn = builder.bytes.substr(0, size);
        EXPECT_EQ(host_sim::salvage_rlog(torn, "x", recovery),
                  builder.bytes.substr(0, builder.offsets[2]))
            << size << " of " << step_at;
        EXPECT_EQ(recovery.steps, 1u);
    }
}

}  // namespace
