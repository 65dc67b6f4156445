// multiply_test.cpp - products against host arithmetic; stated T-states are attained, never passed.
#include <gtest/gtest.h>

#include "tests/toolchain/runtime/runtime_machine.hpp"

namespace runtime_test {
namespace {

constexpr unsigned kRandom = 1'000'000;

/// Calls `check` with pairs of corners, and with random pairs.
template <typename Check>
void with_pairs(unsigned left_bits, unsigned right_bits, unsigned random, Check check) {
    const auto right = corners(right_bits);
    for (const uint64_t a : corners(left_bits)) {
        for (const uint64_t b : right) ASSERT_NO_FATAL_FAILURE(check(a, b));
    }
    auto& source = random_source();
    for (unsigned i = 0; i < random; ++i) {
        const uint64_t a = lumpy(source, left_bits);
        ASSERT_NO_FATAL_FAILURE(check(a, lumpy(source, right_bits)));
    }
}

TEST(Multiply, EightByEightOfAllOperands) {
    Calls mul8("__mul8");
    Calls mul8s("__mul8s");
    for (unsigned a = 0; a < 256; ++a) {
        for (unsigned e = 0; e < 256; ++e) {
            const Registers in{.a = static_cast<uint8_t>(a), .de = static_cast<uint16_t>(e)};
            const Registers out = mul8(in);
            ASSERT_EQ(out.hl, a * e) << a << " * " << e;
            ASSERT_EQ(out.de, e) << "D = 0 is promised";
            const int product = static_cast<int8_t>(a) * static_cast<int8_t>(e);
            ASSERT_EQ(mul8s(in).hl, static_cast<uint16_t>(product)) << a << " * " << e;
        }
    }
    mul8.expect_stated();
    mul8s.expect_stated();
}

TEST(Multiply, EightBySixteen) {
    Calls low("__mul8_16");
    Calls full("__mul8_16w");
    const auto check = [&](uint64_t de, uint64_t a) {
        const Registers in{.a = static_cast<uint8_t>(a), .de = static_cast<uint16_t>(de)};
        const Registers out = low(in);
        ASSERT_EQ(out.hl, a * de & 0xFFFF) << a << " * " << de;
        ASSERT_EQ(out.a, 0) << "A = 0 is promised";
        const Registers wide = full(in);
        ASSERT_EQ(static_cast<uint64_t>(wide.a) << 16 | wide.hl, a * de) << a << " * " << de;
    };
    for (const uint64_t de : corners(16)) {
        for (unsigned a = 0; a < 256; ++a) ASSERT_NO_FATAL_FAILURE(check(de, a));
    }
    with_pairs(16, 8, kRandom, check);
    low.expect_stated();
    full.expect_stated();
}

// A byte without and a word with a sign: every byte, and every word at some bytes.
TEST(Multiply, EightBySignedSixteen) {
    Calls mixed("__mul8_s16w");
    const auto check = [&](uint64_t de, uint64_t a) {
        const Registers in{.a = static_cast<uint8_t>(a), .de = static_cast<uint16_t>(de)};
        const Registers out = mixed(in);
        const int64_t product = static_cast<int64_t>(a) * static_cast<int16_t>(de);
        ASSERT_EQ(static_cast<uint64_t>(out.a) << 16 | out.hl,
                  static_cast<uint64_t>(product) & 0xFFFFFF)
            << a << " * " << static_cast<int16_t>(de);
    };
    for (const uint64_t de : corners(16)) {
        for (unsigned a = 0; a < 256; ++a) ASSERT_NO_FATAL_FAILURE(check(de, a));
    }
    for (const unsigned a : {1U, 0x80U, 0xFFU}) {
        for (unsigned de = 0; de < 0x10000; ++de) ASSERT_NO_FATAL_FAILURE(check(de, a));
    }
    with_pairs(16, 8, kRandom, check);
    mixed.expect_stated();
}

TEST(Multiply, SixteenBySixteenLow) {
    Calls mul16("__mul16");
    const auto check = [&](uint64_t a, uint64_t b) {
        const Registers in{.de = static_cast<uint16_t>(b), .hl = static_cast<uint16_t>(a)};
        ASSERT_EQ(mul16(in).hl, a * b & 0xFFFF) << a << " * " << b;
    };
    with_pairs(16, 16, kRandom, check);
    for (unsigned a = 0; a < 0x10000; ++a) ASSERT_NO_FATAL_FAILURE(check(a, 0xA5C3));
    mul16.expect_stated();
}

// The time depends on one factor alone, so all its values are all cases.
TEST(Multiply, SixteenBySixteenToThirtyTwo) {
    Calls unsigned_product("__umul16w");
    Calls signed_product("__smul16w");
    const auto check = [&](uint64_t a, uint64_t b) {
        const Registers in{.de = static_cast<uint16_t>(b), .hl = static_cast<uint16_t>(a)};
        ASSERT_EQ(unsigned_product(in).dehl(), a * b) << a << " * " << b;
        const int product = static_cast<int16_t>(a) * static_cast<int16_t>(b);
        ASSERT_EQ(signed_product(in).dehl(), static_cast<uint32_t>(product)) << a << " * " << b;
    };
    with_pairs(16, 16, kRandom, check);
    for (unsigned a = 0; a < 0x10000; ++a) {
        for (const unsigned b : {0x0001U, 0x0101U, 0x7FFFU, 0x8000U, 0x8001U, 0xFFFFU}) {
            ASSERT_NO_FATAL_FAILURE(check(a, b));
            ASSERT_NO_FATAL_FAILURE(check(b, a));
        }
    }
    unsigned_product.expect_stated();
    signed_product.expect_stated();
}

TEST(Multiply, ThirtyTwoByThirtyTwo) {
    Calls mul32("__mul32");
    const uint16_t cells = runtime().address("__mul32.cells");
    const auto check = [&](uint64_t a, uint64_t b) {
        runtime().write(cells, 4, b);
        ASSERT_EQ(mul32(with_dehl(static_cast<uint32_t>(a))).dehl(), a * b & 0xFFFFFFFF)
            << a << " * " << b;
        ASSERT_EQ(runtime().read(cells, 4), b);
    };
    with_pairs(32, 32, kRandom, check);
    for (const uint64_t a : {0x00000000U, 0x00010101U, 0x00000101U, 0xFFFFFFFFU}) {
        for (const uint64_t b : {0x00000101U, 0x00010101U, 0x01010101U, 0xFFFFFFFFU}) {
            ASSERT_NO_FATAL_FAILURE(check(a, b));
        }
    }
    mul32.expect_stated();
}

}  // namespace
}  // namespace runtime_test
