// Frames made by hand, as in docs/spec/link.md and telemetry.md, and what is lost between them.
#include "tools/monitor/receiver.hpp"

#include <gtest/gtest.h>

#include "tests/tools/monitor/frames.hpp"

namespace {

using host_sim::Restart;
using monitor::Elapsed;
using monitor::Message;
using monitor::OtherFrame;
using monitor::Receiver;
using monitor::Telemetry;
using monitor_test::Bytes;

/// The last message in these bytes.
std::optional<Message> feed(Receiver& receiver, const Bytes& bytes, Elapsed now = Elapsed(0)) {
    std::optional<Message> last;
    for (const uint8_t byte : bytes) {
        if (auto message = receiver.take(byte, now)) last = std::move(message);
    }
    return last;
}

Telemetry telemetry_of(Receiver& receiver, const Bytes& bytes, Elapsed now) {
    const auto message = feed(receiver, bytes, now);
    EXPECT_TRUE(message && std::holds_alternative<Telemetry>(*message));
    return std::get<Telemetry>(*message);
}

TEST(Receiver, ReadsEveryKindOfFrame) {
    Receiver receiver;
    const auto identity = feed(receiver, monitor_test::identity());
    ASSERT_TRUE(identity && std::holds_alternative<host_sim::ImageIdentity>(*identity));
    EXPECT_EQ(host_sim::describe(std::get<host_sim::ImageIdentity>(*identity)),
              "rover85 1.2.3 sources 89abcdef vehicle Rocky3.2, 1588 bytes, CRC-16 BEEFH");
    const auto answer = feed(receiver, monitor_test::status());
    ASSERT_TRUE(answer && std::holds_alternative<rover::BoardStatus>(*answer));
    const auto& status = std::get<rover::BoardStatus>(*answer);
    EXPECT_EQ(status.faults, 0x0240);
    EXPECT_EQ(status.last_faults, 4);
    EXPECT_EQ(status.reset_count, 7);
    EXPECT_EQ(status.late_steps, 1);
    EXPECT_EQ(status.missed_steps, 2);
    EXPECT_EQ(status.received, 300);
    EXPECT_EQ(status.receive_dropped, 3);
    EXPECT_EQ(status.receive_errors, 4);
    EXPECT_EQ(status.frames_dropped, 5);
    EXPECT_EQ(status.frames_refused, 6);
    EXPECT_EQ(status.trap_count, 8);
    EXPECT_EQ(status.reset_cause, rover::ResetCause::watchdog);
    EXPECT_EQ(status.warm, 1);
    const auto other = feed(receiver, monitor_test::frame(0x82, {1, 0}));
    ASSERT_TRUE(other && std::holds_alternative<OtherFrame>(*other));
    EXPECT_EQ(std::get<OtherFrame>(*other).kind, 0x82);
    EXPECT_EQ(
        telemetry_of(receiver, monitor_test::telemetry(5, 77), Elapsed(0)).estimates.odometer_q4_mm,
        77);
    EXPECT_EQ(receiver.counts().telemetry, 1u);
    EXPECT_EQ(receiver.counts().refused, 0u);
    EXPECT_EQ(receiver.counts().stray_bytes, 0u);
}

TEST(Receiver, CountsWhatItRefuses) {
    Receiver receiver;
    EXPECT_TRUE(feed(receiver, monitor_test::telemetry(0)));
    Bytes damaged = monitor_test::telemetry(1);
    damaged[20] ^= 0x04;
    EXPECT_FALSE(feed(receiver, damaged));
    EXPECT_EQ(receiver.counts().refused, 1u);
    EXPECT_EQ(receiver.counts().stray_bytes, damaged.size());
    rover::Estimates strange;
    strange.mode = static_cast<rover::SlipMode>(6);
    EXPECT_FALSE(feed(receiver, monitor_test::telemetry(strange)));
    EXPECT_FALSE(feed(receiver, monitor_test::frame(0x80, Bytes(19))));
    EXPECT_FALSE(feed(receiver, monitor_test::frame(0x81, Bytes(22, 0xFF))));
    EXPECT_EQ(receiver.counts().refused, 4u);
    feed(receiver, {1, 2, 3});
    EXPECT_EQ(receiver.counts().stray_bytes, damaged.size() + 3);
}

// Who begins to listen begins in the middle of a frame.
TEST(Receiver, BytesBeforeTheFirstFrameAreNoLoss) {
    Receiver receiver;
    feed(receiver, Bytes(11, 0x33));
    EXPECT_EQ(receiver.counts().stray_bytes, 11u);
    feed(receiver, monitor_test::telemetry(9));
    EXPECT_EQ(receiver.counts().stray_bytes, 0u);
}

TEST(Receiver, CountsMissingStepsAndGoesOnBehindTheWrap) {
    Receiver receiver;
    EXPECT_EQ(telemetry_of(receiver, monitor_test::telemetry(65533), Elapsed(0)).missing, 0u);
    EXPECT_EQ(telemetry_of(receiver, monitor_test::telemetry(65534), Elapsed(100)).missing, 0u);
    const Telemetry behind = telemetry_of(receiver, monitor_test::telemetry(2), Elapsed(500));
    EXPECT_EQ(behind.missing, 3u);
    EXPECT_EQ(behind.step, 65538u);
    EXPECT_EQ(behind.restart, Restart::none);
    const Telemetry later = telemetry_of(receiver, monitor_test::telemetry(602), Elapsed(60'500));
    EXPECT_EQ(later.missing, 599u);
    EXPECT_EQ(receiver.counts().steps_missing, 602u);
    EXPECT_EQ(receiver.counts().restarts, 0u);
}

TEST(Receiver, ACounterThatBeginsAnewIsARestart) {
    Receiver receiver;
    telemetry_of(receiver, monitor_test::telemetry(40'000, 16'000), Elapsed(0));
    // 25,536 steps ahead modulo 2^16, but only two seconds later.
    const Telemetry warm =
        telemetry_of(receiver, monitor_test::telemetry(0, 15'990), Elapsed(2000));
    EXPECT_EQ(warm.restart, Restart::warm);
    EXPECT_EQ(warm.missing, 0u);
    EXPECT_EQ(warm.step, 0u);
    const Telemetry next =
        telemetry_of(receiver, monitor_test::telemetry(1, 15'990), Elapsed(2100));
    EXPECT_EQ(next.restart, Restart::none);
    const Telemetry again = telemetry_of(receiver, monitor_test::telemetry(1, 20), Elapsed(6000));
    EXPECT_EQ(again.restart, Restart::cold);
    EXPECT_EQ(again.missing, 1u) << "its step 0";
    EXPECT_EQ(receiver.counts().restarts, 2u);
}

}  // namespace
