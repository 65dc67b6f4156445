// eeprom_test.cpp - the page writer: its accesses, and what becomes of them in the model of the
// part.
#include "firmware/loader/eeprom.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "host_sim/chips/at28c256.hpp"

namespace {

using host_sim::chips::At28c256;
using Page = std::array<uint8_t, rover::loader::kPageSize>;

constexpr uint64_t kClockHz = 3'072'000;

struct Access {
    bool write = false;
    uint16_t address = 0;
    uint8_t byte = 0;
    bool operator==(const Access&) const = default;
};

/// The part on a bus whose every access takes some T-states.
struct Bench {
    static inline At28c256 part{kClockHz};
    static inline uint64_t t = 0;
    static inline uint64_t access_t = 24;
    static inline bool dead = false;
    static inline std::vector<Access> writes;
    static inline unsigned reads = 0;

    static void begin(uint64_t t_of_an_access) {
        part = At28c256(kClockHz);
        part.write_protected = true;
        t = 1'000'000;
        access_t = t_of_an_access;
        dead = false;
        writes.clear();
        reads = 0;
    }
    static uint8_t get(uint16_t address) {
        t += access_t;
        ++reads;
        if (dead) return 0x00;
        part.advance(t);
        return part.read(address, t);
    }
    static void put(uint16_t address, uint8_t byte) {
        t += access_t;
        part.advance(t);
        part.write(address, byte, t);
        writes.push_back({true, address, byte});
    }
};
using Writer = rover::loader::EepromWriter<Bench>;

Page numbered() {
    Page page{};
    for (std::size_t i = 0; i < page.size(); ++i) page[i] = static_cast<uint8_t>(3 * i + 1);
    return page;
}

TEST(EepromWriter, UnlocksAsTheDataSheetSaysThenLoadsThePage) {
    Bench::begin(24);
    const Page page = numbered();
    EXPECT_TRUE(Writer::write(0x1240, page.data()));
    ASSERT_EQ(Bench::writes.size(), 3 + page.size());
    EXPECT_EQ(Bench::writes[0], (Access{true, 0x5555, 0xAA}));
    EXPECT_EQ(Bench::writes[1], (Access{true, 0x2AAA, 0x55}));
    EXPECT_EQ(Bench::writes[2], (Access{true, 0x5555, 0xA0}));
    for (std::size_t i = 0; i < page.size(); ++i) {
        EXPECT_EQ(Bench::writes[3 + i], (Access{true, static_cast<uint16_t>(0x1240 + i), page[i]}));
    }
}

TEST(EepromWriter, ThePageIsThereAndNothingElseIsTouched) {
    for (const uint64_t access_t : {24U, 53U, 400U}) {
        Bench::begin(access_t);
        const Page page = numbered();
        EXPECT_TRUE(Writer::write(0x7FC0, page.data()));
        EXPECT_FALSE(Bench::part.busy(Bench::t));
        for (unsigned at = 0; at < At28c256::kSize; ++at) {
            const uint8_t expected = at < 0x7FC0 ? 0xFF : page[at - 0x7FC0];
            ASSERT_EQ(Bench::part.contents[at], expected) << at;
        }
        EXPECT_TRUE(Bench::part.write_protected);
        EXPECT_EQ(Bench::part.busy_write_count + Bench::part.protected_write_count, 0u);
    }
}

TEST(EepromWriter, EveryLastByteEndsThePolling) {
    for (unsigned last = 0; last < 256; ++last) {
        Bench::begin(24);
        Page page = numbered();
        page.back() = static_cast<uint8_t>(last);
        EXPECT_TRUE(Writer::write(0x0C00, page.data()));
        EXPECT_EQ(Bench::part.contents[0x0C3F], last);
        EXPECT_EQ(Bench::part.cycle_count, 1u);
    }
}

TEST(EepromWriter, APartThatNeverEndsIsGivenUpBehindABound) {
    Bench::begin(24);
    Bench::dead = true;
    Page page = numbered();
    page.back() = 0x80;  // reads as its complement for ever
    EXPECT_FALSE(Writer::write(0x0C00, page.data()));
    EXPECT_EQ(Bench::reads, rover::loader::kPollsMax);
}

}  // namespace
