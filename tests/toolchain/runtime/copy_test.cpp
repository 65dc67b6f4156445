// copy_test.cpp - blocks of all lengths up to 600 and at every overlap, against the host's memory
// functions; the computed jump with all indices.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "tests/toolchain/runtime/runtime_machine.hpp"

namespace runtime_test {
namespace {

constexpr uint16_t kSource = 0x4000;
constexpr uint16_t kTarget = 0x6000;
constexpr unsigned kBorder = 16;  // bytes in front and behind that must not change
constexpr unsigned kLongest = 600;

void fill_random(uint16_t address, unsigned size) {
    for (unsigned i = 0; i < size; ++i) {
        runtime().write(static_cast<uint16_t>(address + i), 1, random_source()());
    }
}

std::vector<uint8_t> bytes_at(unsigned address, unsigned size) {
    const auto begin = runtime().memory().bytes.begin() + address;
    return {begin, begin + size};
}

uint16_t plus(unsigned address, unsigned offset) {
    return static_cast<uint16_t>(address + offset);
}

/// T-states of `count` turns of a loop of `per_turn` with a counter of two bytes, up to its end;
/// the outer counter ticks once in 256 turns.
unsigned turns_t(unsigned count, unsigned per_turn) {
    constexpr unsigned kCounters = 14 + 11;  // DCR, JNZ taken; JNZ not taken 3 less, then the outer
    const unsigned outer = (count + 255) / 256;
    return count * (per_turn + 14) + outer * (kCounters - 14) - 3;
}

/// By hand from the T-states of the instructions, RET included.
unsigned memcpy_t(unsigned size) {
    const unsigned odd = 28 + ((size & 1) != 0 ? 33U : 10U) + 28 + ((size & 2) != 0 ? 59U : 10U);
    const unsigned turns = size / 4;
    if (turns == 0) return odd + 4 + 4 + 7 + 4 + 12;
    const unsigned set_up = turns % 256 != 0 ? 4 + 4 + 10 + 4 : 4 + 4 + 7 + 4 + 6 + 10;
    return odd + set_up + turns_t(turns, 104) + 10;
}
unsigned memmove_t(unsigned size, bool backward) {
    return memcpy_t(size) + (backward ? 16U + 7 + 28 : 16U + 10);
}
unsigned memset_t(unsigned size) {
    const unsigned odd = 12 + 4 + 4 + 4 + ((size & 1) != 0 ? 20U : 10U) + 4 +
                         ((size & 2) != 0 ? 33U : 10U) + 4 + ((size & 4) != 0 ? 59U : 10U);
    const unsigned turns = size / 8;
    const unsigned end = 10 + 10;
    const unsigned looked = 7 + 4 + 4 + 4;
    if (turns == 0) return odd + looked + 7 + 4 + 10 + end;
    const unsigned split = 12 + 4 + 7 + 4 + 4 + 4 + 7 + 4 + 8;
    const unsigned set_up = size < 256         ? 7 + 4 + 7 + 4 + 10
                            : turns % 256 == 0 ? 10 + split + 10
                                               : 10 + split + 7 + 4;
    return odd + looked + set_up + turns_t(turns, 104) + end;
}

/// Copies `size` bytes and compares everything around.
void copy_and_check(Calls& call, unsigned size) {
    fill_random(kSource, size);
    fill_random(kTarget - kBorder, size + 2 * kBorder);
    auto expected = bytes_at(kTarget - kBorder, size + 2 * kBorder);
    std::ranges::copy(bytes_at(kSource, size), expected.begin() + kBorder);
    const Registers out = call({.bc = static_cast<uint16_t>(size), .de = kSource, .hl = kTarget});
    ASSERT_EQ(bytes_at(kTarget - kBorder, size + 2 * kBorder), expected) << size;
    ASSERT_EQ(out.de, plus(kSource, size)) << size;
    ASSERT_EQ(out.hl, plus(kTarget, size)) << size;
    ASSERT_EQ(out.bc & 0xFF, 0) << size;
}

TEST(Copy, MemcpyOfAllLengths) {
    Calls memcpy("__memcpy");
    for (unsigned size = 0; size <= kLongest; ++size) {
        ASSERT_NO_FATAL_FAILURE(copy_and_check(memcpy, size));
        ASSERT_EQ(runtime().last_t(), memcpy_t(size)) << size;
    }
    for (const unsigned size : {1020U, 1023U, 1024U, 1025U, 2048U, 2052U}) {
        ASSERT_NO_FATAL_FAILURE(copy_and_check(memcpy, size));
        ASSERT_EQ(runtime().last_t(), memcpy_t(size)) << size;
    }
    // The whole memory onto itself: a copy of 65535 bytes from 1 on to 1 changes nothing.
    const auto before = runtime().memory();
    const Registers out = memcpy({.bc = 0xFFFF, .de = 1, .hl = 1});
    EXPECT_EQ(out.bc, 0);
    EXPECT_EQ(out.de, 0);
    memcpy.expect_stated();
    const auto unchanged = std::equal(before.bytes.begin(), before.bytes.begin() + 0xFE00,
                                      runtime().memory().bytes.begin());
    EXPECT_TRUE(unchanged) << "but for the stack";
}

TEST(Copy, Memcpy8OfAllLengths) {
    Calls memcpy8("__memcpy8");
    for (unsigned size = 0; size < 256; ++size) {
        ASSERT_NO_FATAL_FAILURE(copy_and_check(memcpy8, size));
    }
    memcpy8.expect_stated();
}

TEST(Copy, MemcpyMovesDownOverAnOverlap) {
    Calls memcpy("__memcpy");
    Calls memcpy8("__memcpy8");
    for (unsigned distance = 0; distance < 20; ++distance) {
        for (unsigned size = 0; size < 60; ++size) {
            for (Calls* call : {&memcpy, &memcpy8}) {
                fill_random(kSource, size + distance + 1);
                auto expected = bytes_at(kSource, size + distance + 1);
                std::memmove(expected.data(), expected.data() + distance, size);
                (void)(*call)({.bc = static_cast<uint16_t>(size),
                               .de = plus(kSource, distance),
                               .hl = kSource});
                ASSERT_EQ(bytes_at(kSource, size + distance + 1), expected);
            }
        }
    }
}

TEST(Copy, MemmoveAtEveryOverlap) {
    Calls memmove("__memmove");
    for (unsigned size = 0; size < 70; ++size) {
        for (unsigned from = 0; from <= 80; ++from) {
            constexpr unsigned kTo = 40;
            fill_random(kSource, 160);
            auto expected = bytes_at(kSource, 160);
            std::memmove(expected.data() + kTo, expected.data() + from, size);
            const Registers out = memmove({.bc = static_cast<uint16_t>(size),
                                           .de = plus(kSource, from),
                                           .hl = plus(kSource, kTo)});
            ASSERT_EQ(bytes_at(kSource, 160), expected) << size << " from " << from;
            ASSERT_EQ(out.bc, 0);
        }
    }
    for (const unsigned size : {255U, 256U, 257U, 1023U, 1024U, 1027U}) {
        fill_random(kSource, 1100);
        auto expected = bytes_at(kSource, 1100);
        std::memmove(expected.data() + 5, expected.data(), size);
        (void)memmove({.bc = static_cast<uint16_t>(size), .de = kSource, .hl = kSource + 5});
        ASSERT_EQ(bytes_at(kSource, 1100), expected) << size;
        ASSERT_EQ(runtime().last_t(), memmove_t(size, true)) << size;
    }
    EXPECT_EQ(memmove.best_t(), memmove_t(0, false));
    // As many bytes as leave the routines and the stack alone, then by the formula.
    const auto before = runtime().memory();
    (void)memmove({.bc = 0xAFFF, .de = 0x4000, .hl = 0x4001});
    runtime().memory() = before;
    EXPECT_EQ(runtime().last_t(), memmove_t(0xAFFF, true));
    EXPECT_EQ(runtime().routine("__memmove").best_t, memmove_t(0, false));
    EXPECT_EQ(runtime().routine("__memmove").worst_t, memmove_t(0xFFFF, true));
}

TEST(Copy, MemsetOfAllLengths) {
    Calls memset("__memset");
    for (unsigned size = 0; size <= 2 * kLongest; ++size) {
        fill_random(kTarget - kBorder, size + 2 * kBorder);
        auto expected = bytes_at(kTarget - kBorder, size + 2 * kBorder);
        const auto value = static_cast<uint8_t>(random_source()());
        std::fill_n(expected.begin() + kBorder, size, value);
        const Registers out =
            memset({.a = value, .bc = static_cast<uint16_t>(size), .hl = kTarget});
        ASSERT_EQ(bytes_at(kTarget - kBorder, size + 2 * kBorder), expected) << size;
        ASSERT_EQ(out.hl, plus(kTarget, size)) << size;
        ASSERT_EQ(out.bc, 0) << size;
        ASSERT_EQ(runtime().last_t(), memset_t(size)) << size;
    }
    const auto before = runtime().memory();
    (void)memset({.a = 0x5A, .bc = 0xBFFF, .hl = 0x3000});
    EXPECT_EQ(runtime().last_t(), memset_t(0xBFFF));
    EXPECT_EQ(bytes_at(0x3000, 0xBFFF), std::vector<uint8_t>(0xBFFF, 0x5A));
    runtime().memory() = before;
    EXPECT_EQ(runtime().routine("__memset").best_t, memset_t(0));
    EXPECT_EQ(runtime().routine("__memset").worst_t, memset_t(0xFFFF));
}

TEST(Copy, JumpIndexReachesAllEntries) {
    Calls jump("__jumpindex");
    constexpr uint16_t kLanding = 0x7000;  // 256 times: MVI B,n; RET
    for (const uint16_t table : std::array<uint16_t, 4>{0x5000, 0x50FF, 0x5001, 0x5080}) {
        for (unsigned i = 0; i < 256; ++i) {
            const uint16_t landing = plus(kLanding, 3 * i);
            runtime().write(landing, 3, 0xC90006 | i << 8);
            runtime().write(plus(table, 2 * i), 2, landing);
        }
        for (unsigned i = 0; i < 256; ++i) {
            const uint16_t entry = runtime().address("__jumpindex");
            const Registers out =
                runtime().call(entry, {.a = static_cast<uint8_t>(i), .hl = table});
            ASSERT_EQ(out.bc >> 8, i);
        }
    }
    // MVI and RET take 17 T.
    const uint16_t ret = kLanding;
    runtime().write(ret, 1, 0xC9);
    for (unsigned i = 0; i < 256; ++i) runtime().write(plus(0x50FF, 2 * i), 2, ret);
    for (unsigned i = 0; i < 256; ++i) (void)jump({.a = static_cast<uint8_t>(i), .hl = 0x50FF});
    for (unsigned i = 0; i < 256; ++i) runtime().write(plus(0x5000, 2 * i), 2, ret);
    for (unsigned i = 0; i < 256; ++i) (void)jump({.a = static_cast<uint8_t>(i), .hl = 0x5000});
    constexpr unsigned kRetT = 10;
    EXPECT_EQ(jump.best_t() - kRetT, runtime().routine("__jumpindex").best_t);
    EXPECT_EQ(jump.worst_t() - kRetT, runtime().routine("__jumpindex").worst_t);
}

TEST(CallHl, GoesToHlAndReturnsToTheCaller) {
    constexpr uint16_t kRoutine = 0x7000;
    runtime().write(kRoutine, 3, 0xC94206);  // MVI B,42H; RET
    const Registers in = {.a = 1, .bc = 0x0304, .de = 0x0506, .hl = kRoutine};
    const Registers out = runtime().call(runtime().address("__callhl"), in);
    EXPECT_EQ(out.bc, 0x4204);
    EXPECT_EQ(out.a, in.a);
    EXPECT_EQ(out.de, in.de);
    EXPECT_EQ(out.hl, in.hl);
    constexpr unsigned kRoutineT = 7 + 10;
    EXPECT_EQ(runtime().last_t() - kRoutineT, runtime().routine("__callhl").worst_t);
}

}  // namespace
}  // namespace runtime_test
