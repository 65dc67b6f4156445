// shift_test.cpp - shifts by all 256 counts against host arithmetic; stated T-states are attained.
#include <gtest/gtest.h>

#include "tests/toolchain/runtime/runtime_machine.hpp"

namespace runtime_test {
namespace {

constexpr unsigned kRandom = 300;  // values besides the corners, each with all counts

/// value << count, and >> of both kinds, in `bits`; any count.
uint64_t left(uint64_t value, unsigned count, unsigned bits) {
    return count >= bits ? 0 : value << count & (~uint64_t{0} >> (64 - bits));
}
uint64_t right(uint64_t value, unsigned count, unsigned bits) {
    return count >= bits ? 0 : value >> count;
}
uint64_t right_signed(uint64_t value, unsigned count, unsigned bits) {
    const uint64_t all = ~uint64_t{0} >> (64 - bits);
    if ((value >> (bits - 1) & 1) == 0) return right(value, count, bits);
    return ~right(~value & all, count, bits) & all;
}

template <typename Check>
void with_values(unsigned bits, Check check) {
    auto values = corners(bits);
    for (unsigned i = 0; i < kRandom; ++i) values.push_back(lumpy(random_source(), bits));
    for (const uint64_t value : values) {
        for (unsigned count = 0; count < 256; ++count) {
            ASSERT_NO_FATAL_FAILURE(check(value, count));
        }
    }
}

TEST(Shift, EightBitsOfAllOperands) {
    Calls shl("__shl8");
    Calls lshr("__lshr8");
    Calls ashr("__ashr8");
    for (unsigned value = 0; value < 256; ++value) {
        for (unsigned count = 0; count < 256; ++count) {
            const Registers in{.a = static_cast<uint8_t>(value),
                               .de = static_cast<uint16_t>(count)};
            ASSERT_EQ(shl(in).a, left(value, count, 8)) << value << " by " << count;
            ASSERT_EQ(lshr(in).a, right(value, count, 8)) << value << " by " << count;
            ASSERT_EQ(ashr(in).a, right_signed(value, count, 8)) << value << " by " << count;
        }
    }
    shl.expect_stated();
    lshr.expect_stated();
    ashr.expect_stated();
}

TEST(Shift, SixteenBits) {
    Calls shl("__shl16");
    Calls lshr("__lshr16");
    Calls ashr("__ashr16");
    with_values(16, [&](uint64_t value, unsigned count) {
        const Registers in{.a = static_cast<uint8_t>(count), .hl = static_cast<uint16_t>(value)};
        ASSERT_EQ(shl(in).hl, left(value, count, 16)) << value << " by " << count;
        ASSERT_EQ(lshr(in).hl, right(value, count, 16)) << value << " by " << count;
        ASSERT_EQ(ashr(in).hl, right_signed(value, count, 16)) << value << " by " << count;
    });
    shl.expect_stated();
    lshr.expect_stated();
    ashr.expect_stated();
}

TEST(Shift, ThirtyTwoBits) {
    Calls shl("__shl32");
    Calls lshr("__lshr32");
    Calls ashr("__ashr32");
    with_values(32, [&](uint64_t value, unsigned count) {
        Registers in = with_dehl(static_cast<uint32_t>(value));
        in.a = static_cast<uint8_t>(count);
        ASSERT_EQ(shl(in).dehl(), left(value, count, 32)) << value << " by " << count;
        ASSERT_EQ(lshr(in).dehl(), right(value, count, 32)) << value << " by " << count;
        ASSERT_EQ(ashr(in).dehl(), right_signed(value, count, 32)) << value << " by " << count;
    });
    shl.expect_stated();
    lshr.expect_stated();
    ashr.expect_stated();
}

TEST(Shift, SixtyFourBits) {
    Calls shl("__shl64");
    Calls lshr("__lshr64");
    Calls ashr("__ashr64");
    const uint16_t a = runtime().address("__wide.a");
    const auto shifted = [&](Calls& call, uint64_t value, unsigned count) {
        runtime().write(a, 8, value);
        (void)call({.a = static_cast<uint8_t>(count)});
        return runtime().read(a, 8);
    };
    with_values(64, [&](uint64_t value, unsigned count) {
        ASSERT_EQ(shifted(shl, value, count), left(value, count, 64)) << value << " by " << count;
        ASSERT_EQ(shifted(lshr, value, count), right(value, count, 64)) << value << " by " << count;
        ASSERT_EQ(shifted(ashr, value, count), right_signed(value, count, 64))
            << value << " by " << count;
    });
    shl.expect_stated();
    lshr.expect_stated();
    ashr.expect_stated();
}

}  // namespace
}  // namespace runtime_test
