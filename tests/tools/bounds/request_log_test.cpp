// request_log_test.cpp - the stream of requests.
#include "tools/bounds/request_log.hpp"

#include <gtest/gtest.h>

#include "host_sim/bind/link_frames.hpp"

namespace {

TEST(WithRequests, EveryStepHasSixteenBytesOfWholeFramesInARow) {
    host_sim::Log log;
    log.steps.resize(20);
    log = rover_bounds::with_requests(log);
    std::vector<uint8_t> bytes;
    for (const auto& step : log.steps) {
        ASSERT_EQ(step.inputs.command_size, 16);
        bytes.insert(bytes.end(), std::begin(step.inputs.command), std::end(step.inputs.command));
    }
    const auto expect = [&bytes](std::size_t at, const std::vector<uint8_t>& frame) {
        const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(at);
        EXPECT_TRUE(std::equal(frame.begin(), frame.end(), begin)) << at;
    };
    using host_sim::UplinkType;
    const auto payload = host_sim::calibration_payload(log.head.calibration);
    const auto calibration = uplink_frame(UplinkType::calibration, payload);
    const auto wrong_size = uplink_frame(UplinkType::calibration);
    ASSERT_EQ(calibration.size(), 41U);
    for (const std::size_t at : {0U, 127U}) {
        expect(at, calibration);
        expect(at + 56, uplink_frame(UplinkType::status));
        expect(at + 62, calibration);
        expect(at + 103, uplink_frame(UplinkType::status));
        expect(at + 109, uplink_frame(UplinkType::identity));
        expect(at + 115, wrong_size);
        expect(at + 121, wrong_size);
    }
    EXPECT_EQ(bytes[41 + 3], 9) << "the size of the frame of an unknown type";
}

}  // namespace
