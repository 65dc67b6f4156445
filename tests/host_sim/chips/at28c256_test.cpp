// at28c256_test.cpp - the EEPROM against its data sheet. At 3.072 MHz a T-state lasts 325.52 ns:
//   tBLC  150 us * 3.072 MHz =    460.8 -> 461 T
//   tWC    10 ms             =  30720   T
//   tEC    20 ms             =  61440   T
//   start   5 ms             =  15360   T
#include "host_sim/chips/at28c256.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

namespace {

using host_sim::chips::At28c256;
using host_sim::chips::kNever;

constexpr uint64_t kClockHz = 3'072'000;
constexpr uint64_t kLoadT = 461;
constexpr uint64_t kWriteT = 30'720;
constexpr uint64_t kEraseT = 61'440;
constexpr uint64_t kCycleT = kLoadT + kWriteT;  ///< from the last byte loaded to the end

using Bytes = std::vector<std::pair<uint16_t, uint8_t>>;

const Bytes kProtect = {{0x5555, 0xAA}, {0x2AAA, 0x55}, {0x5555, 0xA0}};
const Bytes kUnprotect = {{0x5555, 0xAA}, {0x2AAA, 0x55}, {0x5555, 0x80},
                          {0x5555, 0xAA}, {0x2AAA, 0x55}, {0x5555, 0x20}};
const Bytes kErase = {{0x5555, 0xAA}, {0x2AAA, 0x55}, {0x5555, 0x80},
                      {0x5555, 0xAA}, {0x2AAA, 0x55}, {0x5555, 0x10}};

/// A part and the time; bytes are written 50 T apart, as a fast loop of the 8085 does.
struct Bench {
    At28c256 chip{kClockHz};
    uint64_t t = 1000;

    void put(uint16_t address, uint8_t value) {
        t += 50;
        chip.write(address, value, t);
    }
    void put(const Bytes& bytes) {
        for (const auto& [address, value] : bytes) put(address, value);
    }
    uint8_t get(uint16_t address) { return chip.read(address, ++t); }
    void finish() {
        t = std::max(t, chip.cycle_end_t);
        chip.advance(t);
        ASSERT_FALSE(chip.busy(t));
    }
    void run(const Bytes& bytes) {
        put(bytes);
        finish();
    }
};

Bytes operator+(Bytes left, const Bytes& right) {
    left.insert(left.end(), right.begin(), right.end());
    return left;
}

TEST(At28c256, NewPartIsErasedUnprotectedAndQuiet) {
    At28c256 chip(kClockHz);
    EXPECT_TRUE(std::all_of(chip.data(), chip.data() + 32768, [](uint8_t b) { return b == 0xFF; }));
    EXPECT_FALSE(chip.write_protected);
    EXPECT_FALSE(chip.busy(0));
    EXPECT_EQ(chip.next_event_t(), kNever);
}

TEST(At28c256, ByteWriteLastsLoadTimeAndWriteCycle) {
    Bench bench;
    bench.chip.write(0x1234, 0x5A, 2000);
    EXPECT_EQ(bench.chip.next_event_t(), 2000 + 461 + 30'720);
    EXPECT_TRUE(bench.chip.busy(2000 + kCycleT - 1));
    EXPECT_FALSE(bench.chip.busy(2000 + kCycleT));
    EXPECT_NE(bench.chip.read(0x1234, 2000 + kCycleT - 1), 0x5A);
    EXPECT_EQ(bench.chip.read(0x1234, 2000 + kCycleT), 0x5A);
    EXPECT_EQ(bench.chip.data()[0x1234], 0x5A);
    EXPECT_EQ(bench.chip.next_event_t(), kNever);
}

TEST(At28c256, WriteCycleCanBeShortenedForFasterParts) {
    At28c256 chip(kClockHz, 3'000'000);  // the -F part: 3 ms = 9216 T
    chip.write(0, 1, 100);
    EXPECT_EQ(chip.next_event_t(), 100u + 461 + 9216);
}

TEST(At28c256, LoadTimeRestartsWithEveryByte) {
    Bench bench;
    bench.chip.write(0x0100, 1, 1000);
    bench.chip.write(0x0101, 2, 1460);  // 460 T = 149.7 us: in time
    EXPECT_EQ(bench.chip.next_event_t(), 1460 + kCycleT);
    bench.chip.write(0x0102, 3, 1460 + 461);  // 150.1 us: too late
    EXPECT_EQ(bench.chip.busy_write_count, 1u);
    EXPECT_EQ(bench.chip.last_ignored_address, 0x0102);
    EXPECT_EQ(bench.chip.next_event_t(), 1460 + kCycleT) << "an ignored byte prolongs nothing";
    bench.chip.advance(1460 + kCycleT);
    EXPECT_EQ(bench.chip.data()[0x0100], 1);
    EXPECT_EQ(bench.chip.data()[0x0101], 2);
    EXPECT_EQ(bench.chip.data()[0x0102], 0xFF);
    EXPECT_EQ(bench.chip.cycle_count, 1u);
}

TEST(At28c256, WholePageIsOneCycleInAnyOrder) {
    Bench bench;
    for (unsigned i = 0; i < 64; ++i) {
        const unsigned offset = i * 37 % 64;  // 37 is odd, so every offset comes once
        bench.put(static_cast<uint16_t>(0x4C0 + offset), static_cast<uint8_t>(offset * 3));
    }
    bench.finish();
    for (unsigned i = 0; i < 64; ++i) EXPECT_EQ(bench.chip.data()[0x4C0 + i], i * 3);
    EXPECT_EQ(bench.chip.page_writes[0x4C0 / 64], 1u);
    EXPECT_EQ(bench.chip.cycle_count, 1u);
}

TEST(At28c256, ByteMayBeAlteredWithinTheLoadTime) {
    Bench bench;
    bench.run({{0x100, 1}, {0x100, 2}});
    EXPECT_EQ(bench.chip.data()[0x100], 2);
}

TEST(At28c256, BytesThatWereNotLoadedKeepTheirValue) {
    Bench bench;
    bench.run({{0x140, 1}, {0x141, 2}});
    bench.run({{0x141, 9}});
    EXPECT_EQ(bench.chip.data()[0x140], 1);
    EXPECT_EQ(bench.chip.data()[0x141], 9);
    EXPECT_EQ(bench.chip.page_writes[5], 2u);
}

TEST(At28c256, PageOfTheLastByteTakesAllWhenLoadsCrossAPage) {
    Bench bench;
    bench.run({{0x103, 0x11}, {0x144, 0x22}});  // offsets 3 and 4 of pages 4 and 5
    EXPECT_EQ(bench.chip.page_crossing_count, 1u);
    EXPECT_EQ(bench.chip.data()[0x103], 0xFF);
    EXPECT_EQ(bench.chip.data()[0x143], 0x11);
    EXPECT_EQ(bench.chip.data()[0x144], 0x22);
    EXPECT_EQ(bench.chip.page_writes[4], 0u);
    EXPECT_EQ(bench.chip.page_writes[5], 1u);
}

TEST(At28c256, DataPollingShowsTheComplementOfBit7AtAnyAddress) {
    for (const uint8_t value : {uint8_t{0x00}, uint8_t{0x7F}, uint8_t{0x80}, uint8_t{0xFF}}) {
        Bench bench;
        bench.put(0x200, value);
        for (const int address : {0x0200, 0x0000, 0x7FFF}) {
            EXPECT_EQ(bench.get(static_cast<uint16_t>(address)) & 0x80, ~value & 0x80)
                << "while bytes may still come";
        }
        bench.t += kLoadT;
        EXPECT_EQ(bench.get(0x200) & 0x80, ~value & 0x80) << "while it programs";
        bench.finish();
        EXPECT_EQ(bench.get(0x200), value);
    }
}

TEST(At28c256, ToggleBitChangesWithEveryReadUntilTheEnd) {
    Bench bench;
    bench.put(0x200, 0x40);
    uint8_t before = bench.get(0x200);
    for (int i = 0; i < 10; ++i) {
        bench.t += 3000;
        const uint8_t now = bench.get(static_cast<uint16_t>(i * 999));
        EXPECT_EQ((before ^ now) & 0x40, 0x40) << i;
        before = now;
    }
    bench.finish();
    EXPECT_EQ(bench.get(0x200), bench.get(0x200));
}

TEST(At28c256, ProgramThatRunsFromThePartDuringACycleFetchesPollingBytes) {
    Bench bench;
    const std::vector<uint8_t> program(256, 0xC3);
    bench.chip.load(program, 0x1000);
    bench.put(0x7000, 0x3C);
    EXPECT_NE(bench.get(0x1000), 0xC3);
    bench.finish();
    EXPECT_EQ(bench.get(0x1000), 0xC3);
}

TEST(At28c256, ProtectionStartsAtTheEndOfTheCycleWithAndWithoutData) {
    Bench bare;
    bare.put(kProtect);
    EXPECT_FALSE(bare.chip.write_protected);
    EXPECT_TRUE(bare.chip.busy(bare.t + kCycleT - 1));
    bare.finish();
    EXPECT_TRUE(bare.chip.write_protected);
    EXPECT_EQ(bare.chip.data()[0x5555], 0xFF) << "command bytes are not data";
    EXPECT_EQ(bare.chip.data()[0x2AAA], 0xFF);

    Bench with_data;
    with_data.run(kProtect + Bytes{{0x5555, 0xAA}, {0x5556, 0x12}});
    EXPECT_TRUE(with_data.chip.write_protected);
    EXPECT_EQ(with_data.chip.data()[0x5555], 0xAA) << "the addresses can hold data, too";
    EXPECT_EQ(with_data.chip.data()[0x5556], 0x12);
}

TEST(At28c256, ProtectedWriteProgramsNothingButTakesACycle) {
    Bench bench;
    bench.run(kProtect);
    bench.put({{0x300, 0x12}, {0x301, 0x34}});
    EXPECT_EQ(bench.chip.protected_write_count, 2u) << "known as soon as it happens";
    EXPECT_TRUE(bench.chip.busy(bench.t + kCycleT - 1));
    EXPECT_EQ(bench.get(0x300) & 0x80, 0x80) << "polling: complement of 34h";
    bench.finish();
    EXPECT_EQ(bench.chip.data()[0x300], 0xFF);
    EXPECT_EQ(bench.chip.protected_write_count, 2u);
    EXPECT_EQ(bench.chip.last_ignored_address, 0x301);
    EXPECT_EQ(bench.chip.page_writes[0x300 / 64], 0u);
    EXPECT_TRUE(bench.chip.write_protected);
}

TEST(At28c256, ProtectedPartIsWrittenBehindTheSameThreeBytesAndStaysProtected) {
    Bench bench;
    bench.run(kProtect);
    bench.run(kProtect + Bytes{{0x300, 0x12}});
    EXPECT_EQ(bench.chip.data()[0x300], 0x12);
    EXPECT_TRUE(bench.chip.write_protected);
    bench.run({{0x300, 0x13}});
    EXPECT_EQ(bench.chip.data()[0x300], 0x12);
}

TEST(At28c256, ProtectionIsLiftedBySixBytes) {
    Bench bench;
    bench.run(kProtect);
    bench.run(kUnprotect + Bytes{{0x300, 0x12}});
    EXPECT_FALSE(bench.chip.write_protected);
    EXPECT_EQ(bench.chip.data()[0x300], 0x12);
    bench.run({{0x301, 0x13}});
    EXPECT_EQ(bench.chip.data()[0x301], 0x13);
    EXPECT_EQ(bench.chip.data()[0x5555], 0xFF);
}

TEST(At28c256, EraseLastsTwentyMillisecondsTakesNoMoreBytesAndKeepsTheProtection) {
    Bench bench;
    bench.run({{0x0000, 1}, {0x0001, 2}});
    bench.run({{0x7FFF, 3}});
    bench.run(kProtect);
    bench.put(kErase);
    EXPECT_EQ(bench.chip.next_event_t(), bench.t + kEraseT);
    bench.put(0x100, 0x12);
    EXPECT_EQ(bench.chip.busy_write_count, 1u);
    bench.finish();
    EXPECT_TRUE(std::all_of(bench.chip.data(), bench.chip.data() + 32768,
                            [](uint8_t b) { return b == 0xFF; }));
    EXPECT_TRUE(bench.chip.write_protected);
    EXPECT_EQ(bench.chip.page_writes[511], 2u);
}

TEST(At28c256, EveryUnfinishedCommandIsDataOfTheLastPage) {
    for (size_t length = 1; length < kUnprotect.size(); ++length) {
        Bench bench;
        const Bytes part(kUnprotect.begin(), kUnprotect.begin() + static_cast<long>(length));
        bench.run(part);
        const uint32_t page = part.back().first & 0x7FC0u;
        // Offsets: 5555h -> 15h, 2AAAh -> 2Ah.
        EXPECT_EQ(bench.chip.data()[page + 0x15], length == 3 ? 0x80 : 0xAA) << length;
        EXPECT_EQ(bench.chip.data()[page + 0x2A], length >= 2 ? 0x55 : 0xFF) << length;
        EXPECT_FALSE(bench.chip.write_protected);
        EXPECT_EQ(bench.chip.page_writes[page / 64], 1u);
    }
}

TEST(At28c256, EveryUnfinishedCommandIsIgnoredByAProtectedPart) {
    for (size_t length = 1; length < kUnprotect.size(); ++length) {
        Bench bench;
        bench.run(kProtect);
        const At28c256 before = bench.chip;
        bench.run(Bytes(kUnprotect.begin(), kUnprotect.begin() + static_cast<long>(length)));
        EXPECT_TRUE(bench.chip.contents == before.contents) << length;
        EXPECT_TRUE(bench.chip.write_protected) << length;
        EXPECT_EQ(bench.chip.protected_write_count, length);
    }
}

TEST(At28c256, WrongByteAnywhereInACommandMakesItData) {
    for (size_t wrong = 0; wrong < kUnprotect.size(); ++wrong) {
        for (const bool wrong_address : {false, true}) {
            Bench bench;
            bench.run(kProtect);
            Bytes bytes = kUnprotect;
            if (wrong_address) {
                bytes[wrong].first ^= 0x0001;
            } else {
                bytes[wrong].second ^= 0x01;
            }
            bench.run(bytes + Bytes{{0x300, 0x12}});
            EXPECT_TRUE(bench.chip.write_protected) << wrong;
            EXPECT_EQ(bench.chip.data()[0x300], 0xFF) << wrong;
            EXPECT_EQ(bench.chip.protected_write_count, 7u) << wrong;
        }
    }
}

TEST(At28c256, CommandThatPausesForTheLoadTimeIsTwoCycles) {
    Bench bench;
    bench.run(kProtect);
    bench.put({{0x5555, 0xAA}, {0x2AAA, 0x55}});
    bench.t += kLoadT;  // the window has closed: A0h comes while the part is busy
    bench.put({{0x5555, 0xA0}, {0x300, 0x12}});
    bench.finish();
    EXPECT_EQ(bench.chip.busy_write_count, 2u);
    EXPECT_EQ(bench.chip.protected_write_count, 2u);
    EXPECT_EQ(bench.chip.data()[0x300], 0xFF);
}

TEST(At28c256, CommandIsOnlyKnownAtTheBeginningOfACycle) {
    Bench bench;
    bench.run(Bytes{{0x300, 0x12}} + kProtect);
    EXPECT_FALSE(bench.chip.write_protected);
    EXPECT_EQ(bench.chip.data()[0x5540 + 0x15], 0xA0) << "last value at offset 15h";
    EXPECT_EQ(bench.chip.data()[0x5540 + 0x2A], 0x55);
    EXPECT_EQ(bench.chip.data()[0x5540], 0x12);
}

TEST(At28c256, BusyWriteLeavesTheCycleAsItIs) {
    Bench bench;
    bench.put(0x300, 0x12);
    bench.t += kLoadT;
    const uint64_t end = bench.chip.next_event_t();
    bench.put(0x301, 0x99);
    EXPECT_EQ(bench.chip.next_event_t(), end);
    EXPECT_EQ(bench.get(0x300) & 0x80, 0x80) << "still the complement of 12h, not of 99h";
    bench.finish();
    EXPECT_EQ(bench.chip.data()[0x301], 0xFF);
}

TEST(At28c256, PowerFailureWhileLoadingLosesTheBytesAndNothingElse) {
    Bench bench;
    bench.put(kProtect + Bytes{{0x300, 0x12}});
    bench.chip.power_off(bench.t + kLoadT - 1);
    EXPECT_FALSE(bench.chip.busy(bench.t + kLoadT));
    EXPECT_EQ(bench.chip.data()[0x300], 0xFF);
    EXPECT_FALSE(bench.chip.write_protected) << "protection starts at the end of the cycle";
    EXPECT_EQ(bench.chip.interrupted_count, 0u);
}

TEST(At28c256, PowerFailureWhileProgrammingLeavesLoadedBytesHalfDone) {
    Bench bench;
    bench.run({{0x300, 0x0F}, {0x301, 0x0F}, {0x302, 0x0F}});
    bench.put({{0x300, 0x11}, {0x301, 0x22}});
    bench.chip.power_off(bench.t + kLoadT);
    EXPECT_EQ(bench.chip.data()[0x300], 0xBB) << "even: 11h with bits 7, 5, 3, 1 still erased";
    EXPECT_EQ(bench.chip.data()[0x301], 0x0F) << "odd: as before";
    EXPECT_EQ(bench.chip.data()[0x302], 0x0F) << "not loaded";
    EXPECT_EQ(bench.chip.interrupted_count, 1u);
    EXPECT_EQ(bench.chip.page_writes[0x300 / 64], 2u);
    EXPECT_EQ(bench.chip.next_event_t(), kNever);
}

TEST(At28c256, PowerFailureAfterTheCycleChangesNothing) {
    Bench bench;
    bench.put(0x300, 0x12);
    bench.chip.power_off(bench.t + kCycleT);
    EXPECT_EQ(bench.chip.data()[0x300], 0x12);
    EXPECT_EQ(bench.chip.interrupted_count, 0u);
}

TEST(At28c256, PowerFailureDuringEraseHitsTheWholePart) {
    Bench bench;
    const std::vector<uint8_t> zeros(32768, 0x00);
    bench.chip.load(zeros);
    bench.put(kErase);
    bench.chip.power_off(bench.t + kEraseT - 1);
    EXPECT_EQ(bench.chip.data()[0x0000], 0xFF);
    EXPECT_EQ(bench.chip.data()[0x0001], 0x00);
    EXPECT_EQ(bench.chip.data()[0x7FFE], 0xFF);
    EXPECT_EQ(bench.chip.data()[0x7FFF], 0x00);
}

TEST(At28c256, WritesWithinFiveMillisecondsOfPowerOnAreIgnored) {
    Bench bench;
    bench.run(kProtect);
    bench.chip.power_off(bench.t);
    bench.chip.power_on(100'000);
    EXPECT_TRUE(bench.chip.write_protected) << "power does not change the protection";
    bench.chip.write(0x300, 1, 100'000 + 15'359);
    EXPECT_FALSE(bench.chip.busy(100'000 + 15'359));
    EXPECT_EQ(bench.chip.power_on_write_count, 1u);
    bench.chip.write(0x300, 1, 100'000 + 15'360);
    EXPECT_TRUE(bench.chip.busy(100'000 + 15'360));
}

TEST(At28c256, ResetOfTheProcessorDoesNotStopACycle) {
    Bench bench;
    bench.put(0x300, 0x12);
    bench.chip.reset();
    EXPECT_TRUE(bench.chip.busy(bench.t + 1));
    bench.finish();
    EXPECT_EQ(bench.chip.data()[0x300], 0x12);
}

TEST(At28c256, ProgrammerRefusesWhatDoesNotFit) {
    At28c256 chip(kClockHz);
    const std::vector<uint8_t> bytes(2, 0x55);
    chip.load(bytes, 0x7FFE);
    EXPECT_EQ(chip.data()[0x7FFF], 0x55);
    EXPECT_THROW(chip.load(bytes, 0x7FFF), std::length_error);
}

TEST(At28c256, PropertiesShowTheMistakes) {
    Bench bench;
    bench.run(kProtect);
    bench.run({{0x0321, 1}});
    const auto properties = bench.chip.properties();
    const auto value = [&](const std::string& name) {
        for (const auto& property : properties) {
            if (property.name == name) return property.value;
        }
        return std::string("(missing)");
    };
    EXPECT_EQ(value("data protection"), "on");
    EXPECT_EQ(value("writes ignored: protected"), "1");
    EXPECT_EQ(value("last ignored address"), "0321h");
    EXPECT_EQ(value("state"), "idle");
}

RC_GTEST_PROP(At28c256, PageWritesReadBackAndTouchNoOtherPage, ()) {
    Bench bench;
    std::vector<uint8_t> expected(32768, 0xFF);
    for (int round = 0; round < 6; ++round) {
        const auto page = *rc::gen::inRange<unsigned>(0, 512);
        const auto bytes = *rc::gen::container<std::vector<std::pair<unsigned, uint8_t>>>(
            rc::gen::pair(rc::gen::inRange<unsigned>(0, 64), rc::gen::arbitrary<uint8_t>()));
        const bool protect = *rc::gen::arbitrary<bool>();
        if (bench.chip.write_protected || protect) bench.put(kProtect);
        // Without a command in front, AAh at 5555h would be the beginning of one: same result,
        // it is data as long as no second byte of a command follows.
        for (const auto& [offset, value] : bytes) {
            bench.put(static_cast<uint16_t>(page * 64 + offset), value);
            expected[page * 64 + offset] = value;
        }
        bench.finish();
    }
    RC_ASSERT(std::equal(expected.begin(), expected.end(), bench.chip.data()));
    RC_ASSERT(bench.chip.page_crossing_count == 0u);
    RC_ASSERT(bench.chip.protected_write_count == 0u);
}

RC_GTEST_PROP(At28c256, RandomWritesOnlyChangeThePageOfTheLastByte, ()) {
    Bench bench;
    const auto addresses = *rc::gen::nonEmpty(rc::gen::container<std::vector<uint16_t>>(
        rc::gen::element<uint16_t>(0x5555, 0x2AAA, 0x0000, 0x0040, 0x7FFF, 0x5540)));
    for (const uint16_t address : addresses) {
        bench.put(address, *rc::gen::element<uint8_t>(0xAA, 0x55, 0xA0, 0x80, 0x20, 0x10, 0x00));
    }
    const unsigned last_page = addresses.back() / 64u;
    bench.finish();
    for (unsigned i = 0; i < 32768; ++i) {
        if (i / 64 != last_page) RC_ASSERT(bench.chip.data()[i] == 0xFF);
    }
}

RC_GTEST_PROP(At28c256, StridesOfTimeLeaveTheSameState, ()) {
    Bench one;
    Bench many;
    const auto gaps =
        *rc::gen::container<std::vector<uint16_t>>(rc::gen::inRange<uint16_t>(1, 40'000));
    for (const uint16_t gap : gaps) {
        const auto address = *rc::gen::element<uint16_t>(0x5555, 0x2AAA, 0x0123);
        const auto value = *rc::gen::element<uint8_t>(0xAA, 0x55, 0xA0, 0x80, 0x20, 0x10);
        for (uint64_t t = many.t; t < many.t + gap; t += gap / 7u + 1u) many.chip.advance(t);
        one.t += gap;
        many.t += gap;
        one.chip.write(address, value, one.t);
        many.chip.write(address, value, many.t);
    }
    RC_ASSERT(one.chip == many.chip);
}

}  // namespace
