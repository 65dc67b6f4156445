// range_module_test.cpp - the driver of the range module: docs/chips/range-module.md, whose example
// frame is the data here; faults on the chip's model.
#include "hal/chips/range_module.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "tests/hal/chips/parts.hpp"

namespace {

using hal::RangeFrame;
using hal::RangeStatus;
using hal_test::Recorded;
using hal_test::Script;
using hal_test::SimBoard;
using hal_test::Simulated;

constexpr std::array<int16_t, 8> kHeights = {100, -100, 0x1234, -32768, 32767, 0, -1, 1};

void expect_example(const RangeFrame& frame) {
    EXPECT_EQ(frame.scan_count, 1);
    EXPECT_EQ(frame.present, 0xFF);
    for (unsigned i = 0; i < 8; ++i) EXPECT_EQ(frame.heights[i], kHeights[i]) << i;
}

void script_example(Script& bus, uint8_t checksum = 0x63) {
    bus.in(0x24, {0x01, 0xFF, 0x64, 0x00, 0x9C, 0xFF, 0x34, 0x12, 0x00, 0x80, 0xFF, 0x7F, 0x00,
                  0x00, 0xFF, 0xFF, 0x01, 0x00, checksum});
    // ACKNOWLEDGE follows STROBE, which is low for the first byte; the upper lines read back, the
    // unused ones are 1.
    bus.in(0x26, {0x2E, 0x3F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E,
                  0x3F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E});
}

// STROBE is bit 4 of port C: 09 sets it, 08 clears it.
TEST(RangeModuleAccesses, AFrameIsNineteenHandshakes) {
    Script bus;
    script_example(bus);
    RangeFrame frame;
    EXPECT_EQ(Recorded::Range::read(frame), RangeStatus::ok);
    std::string expected = "26=60 <26 <24";
    for (unsigned i = 1; i < 19; ++i) expected += i % 2 == 1 ? " 27=09 <26 <24" : " 27=08 <26 <24";
    EXPECT_EQ(bus.accesses(), expected + " 26=40");
    expect_example(frame);
}

TEST(RangeModuleAccesses, WaitsForEachAcknowledgeWithinItsBound) {
    Script bus;
    script_example(bus);
    // The first byte is ready at the last poll of its bound.
    bus.in(0x26, {0x2F, 0x2F, 0x2F, 0x2F, 0x2F, 0x2F, 0x2F, 0x2F, 0x2F, 0x2F,
                  0x2F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E,
                  0x3F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E, 0x3F, 0x2E});
    RangeFrame frame;
    EXPECT_EQ(Recorded::Range::read(frame), RangeStatus::ok);
    expect_example(frame);
}

TEST(RangeModuleAccesses, SilenceIsAbsent) {
    Script bus;
    bus.in(0x26, {0x2F});
    RangeFrame frame;
    EXPECT_EQ(Recorded::Range::read(frame), RangeStatus::absent);
    std::string expected = "26=60";
    for (unsigned i = 0; i < Recorded::Range::kPollsMax; ++i) expected += " <26";
    EXPECT_EQ(bus.accesses(), expected + " 26=40");
}

TEST(RangeModuleAccesses, EveryDamageOfOneByteIsRefused) {
    for (unsigned wrong = 0; wrong < 256; ++wrong) {
        Script bus;
        script_example(bus, static_cast<uint8_t>(wrong));
        RangeFrame frame;
        EXPECT_EQ(Recorded::Range::read(frame),
                  wrong == 0x63 ? RangeStatus::ok : RangeStatus::checksum);
        EXPECT_TRUE(bus.accesses().ends_with(" 26=40"));
    }
}

class RangeModuleOnTheModel : public testing::Test {
protected:
    void SetUp() override {
        Simulated::PpiB::set_mode<hal::rb85::kPpiBMode>();
        board.state.range.set_scan(0xFF, kHeights);
    }
    void expect_deselected() const {
        EXPECT_FALSE(board.state.range.select_line);
        EXPECT_FALSE(board.state.range.strobe_line);
        EXPECT_EQ(board.state.range.early_strobe_count, 0U);
        EXPECT_EQ(board.state.range.overread_count, 0U);
        EXPECT_EQ(board.state.ppis[1].input_write_count, 0U);
        EXPECT_EQ(board.state.violation_count, 0U);
    }

    SimBoard board;
    RangeFrame frame;
};

TEST_F(RangeModuleOnTheModel, FramesComeOneBehindTheOther) {
    EXPECT_EQ(Simulated::Range::read(frame), RangeStatus::ok);
    expect_example(frame);
    expect_deselected();
    EXPECT_EQ(Simulated::Range::read(frame), RangeStatus::ok);
    expect_example(frame);  // stale: the same scan count
    board.state.range.set_scan(0x05, {-7, 1, 2, 3, 4, 5, 6, 7});
    EXPECT_EQ(Simulated::Range::read(frame), RangeStatus::ok);
    EXPECT_EQ(frame.scan_count, 2);
    EXPECT_EQ(frame.present, 0x05);
    EXPECT_EQ(frame.heights[0], -7);
    EXPECT_EQ(frame.heights[1], 0);
    EXPECT_EQ(frame.heights[2], 2);
    expect_deselected();
}

TEST_F(RangeModuleOnTheModel, AbsentModuleIsFoundWithinItsBoundAndComesBack) {
    board.state.range.set_connected(false, board.state.cpu.t);
    const uint64_t before_t = board.state.cpu.t;
    EXPECT_EQ(Simulated::Range::read(frame), RangeStatus::absent);
    EXPECT_EQ(board.state.cpu.t - before_t,
              (Simulated::Range::kPollsMax + 2U) * (10 + SimBoard::kWorkT));
    expect_deselected();
    board.state.range.set_connected(true, board.state.cpu.t);
    EXPECT_EQ(Simulated::Range::read(frame), RangeStatus::ok);
    expect_example(frame);
}

TEST_F(RangeModuleOnTheModel, UnpluggedAtAnyTimeIsAbsentOrChecksum) {
    SimBoard plain;
    Simulated::PpiB::set_mode<hal::rb85::kPpiBMode>();
    plain.state.range.set_scan(0xFF, kHeights);
    const uint64_t start_t = plain.state.cpu.t;
    ASSERT_EQ(Simulated::Range::read(frame), RangeStatus::ok);
    const uint64_t whole_t = plain.state.cpu.t - start_t;
    unsigned absent = 0;
    unsigned checksum = 0;
    for (uint64_t at = 0; at < whole_t; at += 7) {
        // The tick, from timer A, pulls the plug: the handler runs in mid-frame.
        SimBoard board_at;
        Simulated::PpiB::set_mode<hal::rb85::kPpiBMode>();
        board_at.state.range.set_scan(0xFF, kHeights);
        bool served = false;
        board_at.handler = [&](host_sim::Interrupt) {
            const auto& module = board_at.state.range;
            served = served || (module.served_count == 19 && !module.serving);
            board_at.state.range.set_connected(false, board_at.state.cpu.t);
        };
        using Timer = Simulated::TimerA;
        Timer::start<0, Timer::Mode::rate_generator>(static_cast<uint16_t>(30 + at));
        host_sim::SimBus::sim(0x1B);
        host_sim::SimBus::enable_interrupts();
        const RangeStatus status = Simulated::Range::read(frame);
        EXPECT_FALSE(board_at.state.range.select_line);
        EXPECT_FALSE(board_at.state.range.strobe_line);
        absent += status == RangeStatus::absent ? 1U : 0U;
        checksum += status == RangeStatus::checksum ? 1U : 0U;
        if (status == RangeStatus::ok && !board_at.state.range.connected) {
            EXPECT_TRUE(served) << "unplugged before the last byte, yet ok, at " << at;
        }
    }
    EXPECT_GT(absent, 100U);
    EXPECT_GT(checksum, 0U);  // in the last byte
}

}  // namespace
