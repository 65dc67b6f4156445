// range_module_test.cpp - the range module against docs/chips/range-module.md.
// A byte takes 20 us * 3.072 MHz = 61.44 -> 62 T from SELECT or STROBE to ACKNOWLEDGE.
#include "host_sim/chips/range_module.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace {

using host_sim::chips::kNever;
using host_sim::chips::RangeModule;
using Heights = RangeModule::Heights;

constexpr uint64_t kClockHz = 3'072'000;
constexpr uint64_t kServiceT = 62;

const Heights kHeights = {100, -100, 0x1234, -32768, 32767, 0, -1, 1};

/// The driver of the specification: select, then wait, read and strobe for every byte.
struct Driver {
    RangeModule& module;
    uint64_t t = 1000;
    bool strobe = false;

    bool wait() {
        for (int poll = 0; poll < 20; ++poll) {
            module.advance(t += 10);
            if (module.acknowledge() == strobe) return true;
        }
        return false;
    }
    void select() {
        strobe = false;
        module.set_lines(true, false, ++t);
    }
    void deselect() { module.set_lines(false, false, ++t); }
    void next() { module.set_lines(true, strobe = !strobe, ++t); }
    /// A whole frame, or nothing after a time-out.
    std::optional<std::vector<uint8_t>> frame() {
        std::vector<uint8_t> bytes;
        select();
        for (int i = 0; i < 19; ++i) {
            if (i > 0) next();
            if (!wait()) {
                deselect();
                return std::nullopt;
            }
            bytes.push_back(module.data());
        }
        deselect();
        return bytes;
    }
};

uint8_t sum(const std::vector<uint8_t>& bytes) {
    unsigned total = 0;
    for (const uint8_t byte : bytes) total += byte;
    return static_cast<uint8_t>(total);
}

TEST(RangeModule, FrameOfTheSpecification) {
    RangeModule module(kClockHz);
    module.set_scan(0xFF, kHeights);
    const auto bytes = Driver{module}.frame();
    ASSERT_TRUE(bytes.has_value());
    const std::vector<uint8_t> expected = {
        0x01, 0xFF,                                      // counter, presence
        0x64, 0x00, 0x9C, 0xFF, 0x34, 0x12, 0x00, 0x80,  // 100, -100, 1234h, -32768
        0xFF, 0x7F, 0x00, 0x00, 0xFF, 0xFF, 0x01, 0x00,  // 32767, 0, -1, 1
        // 01+FF = 100; +64 = 164; +9C+FF = 2FF; +34+12 = 345; +80 = 3C5; +FF+7F = 543;
        // +FF+FF = 741; +01 = 742. A5h - 42h = 63h.
        0x63};
    EXPECT_EQ(*bytes, expected);
    EXPECT_EQ(sum(*bytes), 0xA5);
}

TEST(RangeModule, AbsentSamplesAreSentAsZero) {
    RangeModule module(kClockHz);
    module.set_scan(0x02, kHeights);
    const auto bytes = Driver{module}.frame();
    ASSERT_TRUE(bytes.has_value());
    EXPECT_EQ((*bytes)[1], 0x02);
    EXPECT_EQ((*bytes)[2], 0x00);
    EXPECT_EQ((*bytes)[4], 0x9C);
    EXPECT_EQ((*bytes)[6], 0x00);
}

TEST(RangeModule, ModuleWithoutAScanHasCounterZeroAndNoSamples) {
    RangeModule module(kClockHz);
    const auto bytes = Driver{module}.frame();
    ASSERT_TRUE(bytes.has_value());
    std::vector<uint8_t> expected(19, 0);
    expected.back() = 0xA5;
    EXPECT_EQ(*bytes, expected);
}

TEST(RangeModule, ByteIsThereAfter62TStates) {
    RangeModule module(kClockHz);
    module.set_scan(0x01, kHeights);
    module.set_lines(true, false, 1000);
    EXPECT_EQ(module.next_event_t(), 1062u);
    module.advance(1061);
    EXPECT_TRUE(module.acknowledge()) << "not yet the level of STROBE";
    EXPECT_EQ(module.data(), 0xFF);
    module.advance(1062);
    EXPECT_FALSE(module.acknowledge());
    EXPECT_EQ(module.data(), 0x01);
    EXPECT_EQ(module.next_event_t(), kNever);
    module.set_lines(true, true, 1100);
    EXPECT_EQ(module.next_event_t(), 1162u);
    module.advance(1161);
    EXPECT_EQ(module.data(), 0x01) << "who does not wait reads the byte before";
    module.advance(1162);
    EXPECT_TRUE(module.acknowledge());
}

TEST(RangeModule, AbsentModuleReadsFfAndNeverAcknowledges) {
    RangeModule module(kClockHz);
    module.set_connected(false, 0);
    module.set_scan(0xFF, kHeights);
    EXPECT_EQ(Driver{module}.frame(), std::nullopt);
    EXPECT_EQ(module.data(), 0xFF);
    EXPECT_TRUE(module.acknowledge());
    EXPECT_EQ(module.next_event_t(), kNever);
    // A driver that ignores ACKNOWLEDGE gets 19 * FFh = EDh: the checksum refuses it, too.
    EXPECT_NE(sum(std::vector<uint8_t>(19, 0xFF)), 0xA5);
}

TEST(RangeModule, UnselectedModuleDrivesNothing) {
    RangeModule module(kClockHz);
    module.set_scan(0xFF, kHeights);
    module.set_lines(false, true, 1000);
    module.set_lines(false, false, 1100);
    module.advance(2000);
    EXPECT_EQ(module.data(), 0xFF);
    EXPECT_TRUE(module.acknowledge());
}

TEST(RangeModule, StaleScanKeepsItsCounter) {
    RangeModule module(kClockHz);
    module.set_scan(0xFF, kHeights);
    Driver driver{module};
    const auto first = driver.frame();
    EXPECT_EQ(driver.frame(), first);
    module.set_scan(0xFF, kHeights);
    const auto fresh = driver.frame();
    ASSERT_TRUE(fresh.has_value());
    EXPECT_EQ((*fresh)[0], 0x02);
}

TEST(RangeModule, ScanCounterWraps) {
    RangeModule module(kClockHz);
    for (int i = 0; i < 256; ++i) module.set_scan(0xFF, kHeights);
    EXPECT_EQ((*Driver{module}.frame())[0], 0x00);
}

TEST(RangeModule, NewScanDoesNotTearAFrameThatIsBeingRead) {
    for (int torn_at = 0; torn_at < 19; ++torn_at) {
        RangeModule module(kClockHz);
        module.set_scan(0xFF, kHeights);
        Driver driver{module};
        const auto whole = driver.frame();
        driver.select();
        std::vector<uint8_t> bytes;
        for (int i = 0; i < 19; ++i) {
            if (i > 0) driver.next();
            if (i == torn_at) module.set_scan(0x0F, Heights{});
            ASSERT_TRUE(driver.wait());
            bytes.push_back(module.data());
        }
        EXPECT_EQ(bytes, whole) << torn_at;
        driver.deselect();
        EXPECT_EQ((*driver.frame())[0], 0x02);
    }
}

TEST(RangeModule, SelectAlwaysBeginsAtTheFirstByte) {
    RangeModule module(kClockHz);
    module.set_scan(0xFF, kHeights);
    Driver driver{module};
    driver.select();
    for (int i = 0; i < 7; ++i) {
        ASSERT_TRUE(driver.wait());
        driver.next();
    }
    driver.deselect();
    const auto bytes = driver.frame();
    ASSERT_TRUE(bytes.has_value());
    EXPECT_EQ((*bytes)[0], 0x01);
    EXPECT_EQ(sum(*bytes), 0xA5);
}

TEST(RangeModule, EarlyStrobeIsSeenWhenTheByteIsOut) {
    RangeModule module(kClockHz);
    module.set_scan(0xFF, kHeights);
    module.set_lines(true, false, 1000);
    module.set_lines(true, true, 1030);
    EXPECT_EQ(module.early_strobe_count, 1u);
    module.advance(1062);
    EXPECT_EQ(module.data(), 0x01);
    EXPECT_EQ(module.next_event_t(), 1062 + kServiceT) << "the next byte follows at once";
    module.advance(1124);
    EXPECT_EQ(module.data(), 0xFF) << "presence";
    EXPECT_TRUE(module.acknowledge());
}

TEST(RangeModule, TwoEarlyStrobesAreLost) {
    RangeModule module(kClockHz);
    module.set_scan(0x55, kHeights);
    module.set_lines(true, false, 1000);
    module.set_lines(true, true, 1020);
    module.set_lines(true, false, 1040);
    EXPECT_EQ(module.early_strobe_count, 2u);
    module.advance(5000);
    EXPECT_EQ(module.data(), 0x01) << "still the first byte";
    EXPECT_EQ(module.served_count, 1);
}

TEST(RangeModule, BytesBehindTheFrameAreFfAndCounted) {
    RangeModule module(kClockHz);
    Driver driver{module};
    driver.select();
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(driver.wait());
        driver.next();
    }
    ASSERT_TRUE(driver.wait());
    EXPECT_EQ(module.data(), 0xFF);
    EXPECT_EQ(module.overread_count, 2u);
}

TEST(RangeModule, PluggedOutInTheMiddleTimesOutAndPluggedInStartsAnew) {
    RangeModule module(kClockHz);
    module.set_scan(0xFF, kHeights);
    Driver driver{module};
    driver.select();
    ASSERT_TRUE(driver.wait());
    module.set_connected(false, ++driver.t);
    driver.next();  // STROBE 1 is the level of the pull-up: looks acknowledged
    ASSERT_TRUE(driver.wait());
    EXPECT_EQ(module.data(), 0xFF);
    driver.next();
    EXPECT_FALSE(driver.wait());
    module.set_connected(true, ++driver.t);
    EXPECT_EQ(module.next_event_t(), driver.t + kServiceT);
    driver.deselect();
    EXPECT_TRUE(driver.frame().has_value());
}

TEST(RangeModule, AReplayedScanCarriesItsOwnCounter) {
    RangeModule module(kClockHz);
    module.set_scan(200, 0x81, kHeights);
    auto bytes = Driver{module}.frame();
    ASSERT_TRUE(bytes.has_value());
    EXPECT_EQ((*bytes)[0], 200);
    EXPECT_EQ((*bytes)[1], 0x81);
    EXPECT_EQ(sum(*bytes), 0xA5);
    module.set_scan(200, 0x81, kHeights);  // the same again: nothing new
    EXPECT_EQ((*Driver{module}.frame())[0], 200);
    module.set_scan(0x81, kHeights);
    EXPECT_EQ((*Driver{module}.frame())[0], 201) << "a live scan counts on";
}

TEST(RangeModule, PropertiesShowTheMistakes) {
    RangeModule module(kClockHz);
    module.set_lines(true, false, 1000);
    module.set_lines(true, true, 1001);
    std::string all;
    for (const auto& [name, value] : module.properties()) all += name + "=" + value + ";";
    EXPECT_NE(all.find("module=connected;"), std::string::npos) << all;
    EXPECT_NE(all.find("strobes too early=1;"), std::string::npos) << all;
}

RC_GTEST_PROP(RangeModule, EveryFrameCarriesItsScan, (Heights heights, uint8_t present)) {
    RangeModule module(kClockHz);
    module.set_scan(present, heights);
    const auto bytes = Driver{module}.frame();
    RC_ASSERT(bytes.has_value());
    RC_ASSERT(sum(*bytes) == 0xA5);
    RC_ASSERT((*bytes)[1] == present);
    for (unsigned i = 0; i < 8; ++i) {
        const int word = (*bytes)[2 + 2 * i] | (*bytes)[3 + 2 * i] << 8;
        const bool seen = (present >> i & 1) != 0;
        RC_ASSERT(static_cast<int16_t>(word) == (seen ? heights[i] : 0));
    }
}

RC_GTEST_PROP(RangeModule, StridesOfTimeLeaveTheSameState, ()) {
    RangeModule one(kClockHz);
    RangeModule many(kClockHz);
    uint64_t t = 100;
    const auto gaps = *rc::gen::container<std::vector<int>>(rc::gen::inRange<int>(0, 150));
    for (const int gap : gaps) {
        const uint64_t until = t + static_cast<uint64_t>(gap);
        for (; t < until; ++t) many.advance(t);
        t = until;
        const auto action = *rc::gen::inRange<int>(0, 12);
        for (RangeModule* module : {&one, &many}) {
            if (action < 8) module->set_lines(action % 8 != 0, (action & 1) != 0, t);
            if (action == 8) module->set_scan(0x3C, kHeights);
            if (action == 9) module->set_connected(false, t);
            if (action > 9) module->set_connected(true, t);
        }
    }
    one.advance(t + 500);
    many.advance(t + 500);
    RC_ASSERT(one == many);
}

}  // namespace
