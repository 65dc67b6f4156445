// multiply_test.cpp - products, quotients and interpolation against 64 bit integers and double.
#include "firmware/core/multiply.hpp"

#include <gtest/gtest.h>

#include "arith_reference.hpp"

namespace {

using namespace reference;
using Words = testing::Types<uint8_t, int8_t, uint16_t, int16_t, uint32_t, int32_t>;
using NarrowWords = testing::Types<uint8_t, int8_t, uint16_t, int16_t>;

template <class T>
class Products : public testing::Test {};
TYPED_TEST_SUITE(Products, NarrowWords);

template <class A, class B>
void expect_exact_product() {
    compare_pairs<A, B>([](A a, B b) { return int64_t{rover::mul_wide(a, b)}; },
                        [](int64_t a, int64_t b) { return a * b; });
}

TYPED_TEST(Products, WideAreExactForEverySecondType) {
    expect_exact_product<TypeParam, uint8_t>();
    expect_exact_product<TypeParam, int8_t>();
    expect_exact_product<TypeParam, uint16_t>();
    expect_exact_product<TypeParam, int16_t>();
}

TYPED_TEST(Products, SaturateAtTheEndsOfTheRange) {
    using T = TypeParam;
    compare_pairs<T, T>([](T a, T b) { return rover::mul_sat(a, b); },
                        [](int64_t a, int64_t b) { return saturate<T>(a * b); });
}

TEST(Products, HaveTheNarrowestTypeThatHoldsThem) {
    EXPECT_TRUE((rover::kSameType<rover::Product<uint8_t, uint8_t>, uint16_t>));
    EXPECT_TRUE((rover::kSameType<rover::Product<int8_t, uint8_t>, int16_t>));
    EXPECT_TRUE((rover::kSameType<rover::Product<uint16_t, uint8_t>, uint32_t>));
    EXPECT_TRUE((rover::kSameType<rover::Product<int16_t, uint16_t>, int32_t>));
}

template <class T>
class WrappedProducts : public testing::Test {};
TYPED_TEST_SUITE(WrappedProducts, Words);

TYPED_TEST(WrappedProducts, AreModulo2ToTheWidth) {
    using T = TypeParam;
    // The 64 bit reference product wraps as an unsigned number, which the modulus divides.
    compare_pairs<T, T>([](T a, T b) { return rover::mul_wrap(a, b); },
                        [](int64_t a, int64_t b) {
                            const auto product =
                                static_cast<uint64_t>(a) * static_cast<uint64_t>(b);
                            return wrap<T>(static_cast<int64_t>(product));
                        });
}

TEST(MulQ15Sat, ErrorIsAtMostHalfAnLsbExceptAtMinusOneTimesMinusOne) {
    for (int32_t a = -32768; a <= 32767; ++a) {
        for (int32_t b = -32768; b <= 32767; b += 257) {
            const auto result =
                rover::mul_q15_sat(static_cast<int16_t>(a), static_cast<int16_t>(b));
            const double error_lsb = result - a * static_cast<double>(b) / 32768.0;
            const double bound_lsb = (a == -32768 && b == -32768) ? 1.0 : 0.5;
            if (std::abs(error_lsb) > bound_lsb) FAIL() << "a=" << a << " b=" << b;
        }
    }
}

TEST(MulQ15Sat, TiesRoundUp) {
    EXPECT_EQ(rover::mul_q15_sat(int16_t{1}, int16_t{16384}), 1);
    EXPECT_EQ(rover::mul_q15_sat(int16_t{-1}, int16_t{16384}), 0);
    EXPECT_EQ(rover::mul_q15_sat(int16_t{-32768}, int16_t{-32768}), 32767);
}

template <class T>
class Quotients : public testing::Test {};
TYPED_TEST_SUITE(Quotients, Words);

TYPED_TEST(Quotients, FloorIsDefinedForEveryPair) {
    using T = TypeParam;
    compare_pairs<T, T>([](T a, T b) { return rover::div_floor(a, b); },
                        [](int64_t a, int64_t b) { return quotient<T>(a, b, 0.0); });
}

TYPED_TEST(Quotients, RoundHalfUpIsDefinedForEveryPair) {
    using T = TypeParam;
    compare_pairs<T, T>([](T a, T b) { return rover::div_round_half_up(a, b); },
                        [](int64_t a, int64_t b) { return quotient<T>(a, b, 0.5); });
}

// By sign of the dividend, zero over zero is zero: the documented choice, written out.
TEST(Quotients, ByZeroSaturateByTheSignOfTheDividend) {
    EXPECT_EQ(rover::div_floor(int16_t{5}, int16_t{0}), 32767);
    EXPECT_EQ(rover::div_floor(int16_t{-5}, int16_t{0}), -32768);
    EXPECT_EQ(rover::div_floor(int16_t{0}, int16_t{0}), 0);
    EXPECT_EQ(rover::div_round_half_up(uint32_t{1}, uint32_t{0}), 0xFFFF'FFFFu);
    EXPECT_EQ(rover::div_round_sat_s16(-1, int16_t{0}), -32768);
    EXPECT_EQ(rover::div_floor_sat_u16(uint32_t{0}, uint16_t{0}), 0);
}

TEST(Quotients, WithNarrowResultsSaturate) {
    // A wide quotient saturates like its narrow one: infinities and large values both clamp.
    compare_pairs<uint32_t, uint16_t>(
        [](uint32_t a, uint16_t b) { return rover::div_floor_sat_u16(a, b); },
        [](int64_t a, int64_t b) { return quotient<uint16_t>(a, b, 0.0); });
    compare_pairs<uint32_t, uint16_t>(
        [](uint32_t a, uint16_t b) { return rover::div_round_sat_u16(a, b); },
        [](int64_t a, int64_t b) { return quotient<uint16_t>(a, b, 0.5); });
    compare_pairs<int32_t, int16_t>(
        [](int32_t a, int16_t b) { return rover::div_floor_sat_s16(a, b); },
        [](int64_t a, int64_t b) { return quotient<int16_t>(a, b, 0.0); });
    compare_pairs<int32_t, int16_t>(
        [](int32_t a, int16_t b) { return rover::div_round_sat_s16(a, b); },
        [](int64_t a, int64_t b) { return quotient<int16_t>(a, b, 0.5); });
}

/// a + (b - a) f / 2^shift with the difference modulo 2^16 and the correction rounded half up.
int64_t interpolated(int64_t a, int64_t b, int64_t fraction, int shift) {
    const double correction =
        std::ldexp(static_cast<double>(wrap<int16_t>(b - a) * fraction), -shift);
    return wrap<int16_t>(a + static_cast<int64_t>(std::floor(correction + 0.5)));
}

TEST(Lerp, RoundsHalfUpAndWrapsForEveryFraction) {
    constexpr int16_t kFirst[] = {-32768, 777, 32767};
    for (const int16_t a : kFirst) {
        compare_pairs<int16_t, uint8_t>(
            [=](int16_t b, uint8_t f) { return rover::lerp_q6(a, b, f); },
            [=](int64_t b, int64_t f) { return interpolated(a, b, f, 6); });
        compare_pairs<int16_t, uint8_t>(
            [=](int16_t b, uint8_t f) { return rover::lerp_q8(a, b, f); },
            [=](int64_t b, int64_t f) { return interpolated(a, b, f, 8); });
    }
}

TEST(Lerp, HitsBothEnds) {
    for (int32_t a = -32768; a <= 32767; a += 255) {
        for (int32_t b = -32768; b <= 32767; b += 257) {
            const auto first = static_cast<int16_t>(a);
            const auto second = static_cast<int16_t>(b);
            ASSERT_EQ(rover::lerp_q6(first, second, uint8_t{0}), first);
            ASSERT_EQ(rover::lerp_q6(first, second, uint8_t{64}), second);
        }
    }
}

}  // namespace
