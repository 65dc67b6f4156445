// sums_test.cpp - sums, shifts, conversions and table access against 64 bit integers.
#include "firmware/core/sums.hpp"

#include <gtest/gtest.h>

#include "arith_reference.hpp"

namespace {

using namespace reference;
using Words = testing::Types<uint8_t, int8_t, uint16_t, int16_t, uint32_t, int32_t>;
using SignedWords = testing::Types<int8_t, int16_t, int32_t>;
using UnsignedWords = testing::Types<uint8_t, uint16_t, uint32_t>;

template <class T>
class Sums : public testing::Test {};
TYPED_TEST_SUITE(Sums, Words);

TYPED_TEST(Sums, WrapModulo2ToTheWidth) {
    using T = TypeParam;
    compare_pairs<T, T>([](T a, T b) { return rover::add_wrap(a, b); },
                        [](int64_t a, int64_t b) { return wrap<T>(a + b); });
    compare_pairs<T, T>([](T a, T b) { return rover::sub_wrap(a, b); },
                        [](int64_t a, int64_t b) { return wrap<T>(a - b); });
    compare<T>([](T a) { return rover::neg_wrap(a); }, [](int64_t a) { return wrap<T>(-a); });
}

TYPED_TEST(Sums, SaturateAtTheEndsOfTheRange) {
    using T = TypeParam;
    compare_pairs<T, T>([](T a, T b) { return rover::add_sat(a, b); },
                        [](int64_t a, int64_t b) { return saturate<T>(a + b); });
    compare_pairs<T, T>([](T a, T b) { return rover::sub_sat(a, b); },
                        [](int64_t a, int64_t b) { return saturate<T>(a - b); });
}

TYPED_TEST(Sums, AverageIsTheFlooredMeanAndCannotOverflow) {
    using T = TypeParam;
    compare_pairs<T, T>([](T a, T b) { return rover::average(a, b); },
                        [](int64_t a, int64_t b) { return (a + b) >> 1; });
}

template <class T>
class Magnitudes : public testing::Test {};
TYPED_TEST_SUITE(Magnitudes, SignedWords);

TYPED_TEST(Magnitudes, SaturateAtTheMostNegativeValueOnly) {
    using T = TypeParam;
    compare<T>([](T a) { return rover::neg_sat(a); }, [](int64_t a) { return saturate<T>(-a); });
    compare<T>([](T a) { return rover::abs_sat(a); },
               [](int64_t a) { return saturate<T>(a < 0 ? -a : a); });
}

TEST(AbsoluteValue, IsExactInTheUnsignedType) {
    const auto magnitude = [](int64_t a) { return a < 0 ? -a : a; };
    compare<int8_t>([](int8_t a) { return rover::abs_u8(a); }, magnitude);
    compare<int16_t>([](int16_t a) { return rover::abs_u16(a); }, magnitude);
    compare<int32_t>([](int32_t a) { return int64_t{rover::abs_u32(a)}; }, magnitude);
}

template <class T>
class Shifts : public testing::Test {};
TYPED_TEST_SUITE(Shifts, Words);

// Every count up to far beyond the width: the reference divides or multiplies by 2^count in double.
constexpr uint8_t kCountMax = 40;

TYPED_TEST(Shifts, FloorIsTheFlooredQuotientForEveryCount) {
    using T = TypeParam;
    for (uint8_t count = 0; count <= kCountMax; ++count) {
        compare<T>(
            [=](T a) { return rover::shift_floor(a, count); },
            [=](int64_t a) {
                return static_cast<int64_t>(std::floor(std::ldexp(static_cast<double>(a), -count)));
            });
    }
    compare<T>([](T a) { return rover::shift_floor(a, uint8_t{255}); },
               [](int64_t a) { return a < 0 ? -1 : 0; });
    compare<T>([](T a) { return rover::halve_floor(a); }, [](int64_t a) { return a >> 1; });
}

TYPED_TEST(Shifts, RoundHalfUpIsTheRoundedQuotientForEveryCount) {
    using T = TypeParam;
    for (uint8_t count = 0; count <= kCountMax; ++count) {
        compare<T>([=](T a) { return rover::shift_round_half_up(a, count); },
                   [=](int64_t a) {
                       return static_cast<int64_t>(
                           std::floor(std::ldexp(static_cast<double>(a), -count) + 0.5));
                   });
    }
    compare<T>([](T a) { return rover::shift_round_half_up(a, uint8_t{255}); },
               [](int64_t) { return 0; });
}

TYPED_TEST(Shifts, LeftWrapsOrSaturatesForEveryCount) {
    using T = TypeParam;
    // Beyond 31 every bit has left the word, and every value but zero is out of range.
    for (uint8_t count = 0; count <= 31; ++count) {
        compare<T>([=](T a) { return rover::shift_left_wrap(a, count); },
                   [=](int64_t a) { return wrap<T>(a * (int64_t{1} << count)); });
        compare<T>([=](T a) { return rover::shift_left_sat(a, count); },
                   [=](int64_t a) { return saturate<T>(a * (int64_t{1} << count)); });
    }
    for (const uint8_t count : {uint8_t{32}, uint8_t{33}, uint8_t{255}}) {
        compare<T>([=](T a) { return rover::shift_left_wrap(a, count); },
                   [](int64_t) { return 0; });
        compare<T>([=](T a) { return rover::shift_left_sat(a, count); },
                   [](int64_t a) {
                       return a == 0 ? 0 : a < 0 ? kMin<T> : kMax<T>;
                   });
    }
}

TYPED_TEST(Shifts, ConstantCountsGiveTheSame) {
    using T = TypeParam;
    compare<T>([](T a) { return rover::shift_floor<3>(a); }, [](int64_t a) { return a >> 3; });
    compare<T>([](T a) { return rover::shift_round_half_up<3>(a); },
               [](int64_t a) { return (a + 4) >> 3; });
    compare<T>([](T a) { return rover::shift_left_wrap<3>(a); },
               [](int64_t a) { return wrap<T>(a * 8); });
    compare<T>([](T a) { return rover::shift_left_sat<3>(a); },
               [](int64_t a) { return saturate<T>(a * 8); });
}

template <class T>
class Order : public testing::Test {};
TYPED_TEST_SUITE(Order, Words);

TYPED_TEST(Order, MinAndMaxFollowTheValues) {
    using T = TypeParam;
    compare_pairs<T, T>([](T a, T b) { return rover::min(a, b); },
                        [](int64_t a, int64_t b) { return a < b ? a : b; });
    compare_pairs<T, T>([](T a, T b) { return rover::max(a, b); },
                        [](int64_t a, int64_t b) { return a > b ? a : b; });
}

TYPED_TEST(Order, ClampStaysInTheIntervalAndTheLowEndWins) {
    using T = TypeParam;
    const T low{20};
    const T high{100};
    compare<T>([=](T a) { return rover::clamp(a, low, high); },
               [](int64_t a) { return a < 20    ? 20
                                      : a > 100 ? 100
                                                : a; });
    compare<T>([=](T a) { return rover::clamp(a, high, low); }, [](int64_t) { return 100; });
}

template <class T>
class Bits : public testing::Test {};
TYPED_TEST_SUITE(Bits, UnsignedWords);

TYPED_TEST(Bits, AreCombinedOneByOne) {
    using T = TypeParam;
    compare_pairs<T, T>([](T a, T b) { return rover::bit_and(a, b); },
                        [](int64_t a, int64_t b) { return a & b; });
    compare_pairs<T, T>([](T a, T b) { return rover::bit_or(a, b); },
                        [](int64_t a, int64_t b) { return a | b; });
    compare_pairs<T, T>([](T a, T b) { return rover::bit_xor(a, b); },
                        [](int64_t a, int64_t b) { return a ^ b; });
}

template <class T>
class Conversions : public testing::Test {};
TYPED_TEST_SUITE(Conversions, Words);

TYPED_TEST(Conversions, WrapKeepTheLowBits) {
    using T = TypeParam;
    compare<T>([](T a) { return rover::narrow_wrap_u8(a); }, wrap<uint8_t>);
    compare<T>([](T a) { return rover::narrow_wrap_s8(a); }, wrap<int8_t>);
    compare<T>([](T a) { return rover::narrow_wrap_u16(a); }, wrap<uint16_t>);
    compare<T>([](T a) { return rover::narrow_wrap_s16(a); }, wrap<int16_t>);
    compare<T>([](T a) { return rover::narrow_wrap_u32(a); }, wrap<uint32_t>);
    compare<T>([](T a) { return rover::narrow_wrap_s32(a); }, wrap<int32_t>);
}

TYPED_TEST(Conversions, SaturateToTheNearestValue) {
    using T = TypeParam;
    const auto nearest = []<class To>(To) { return [](int64_t a) { return saturate<To>(a); }; };
    compare<T>([](T a) { return rover::narrow_sat_u8(a); }, nearest(uint8_t{}));
    compare<T>([](T a) { return rover::narrow_sat_s8(a); }, nearest(int8_t{}));
    compare<T>([](T a) { return rover::narrow_sat_u16(a); }, nearest(uint16_t{}));
    compare<T>([](T a) { return rover::narrow_sat_s16(a); }, nearest(int16_t{}));
    compare<T>([](T a) { return rover::narrow_sat_u32(a); }, nearest(uint32_t{}));
    compare<T>([](T a) { return rover::narrow_sat_s32(a); }, nearest(int32_t{}));
}

TYPED_TEST(Conversions, WidenKeepsTheValue) {
    using T = TypeParam;
    const auto same = [](int64_t a) { return a; };
    if constexpr (rover::Fits<T, uint16_t>) {
        compare<T>([](T a) { return rover::widen_u16(a); }, same);
    }
    if constexpr (rover::Fits<T, int16_t>) {
        compare<T>([](T a) { return rover::widen_s16(a); }, same);
    }
    if constexpr (rover::Fits<T, uint32_t>) {
        compare<T>([](T a) { return rover::widen_u32(a); }, same);
    }
    if constexpr (rover::Fits<T, int32_t>) {
        compare<T>([](T a) { return rover::widen_s32(a); }, same);
    }
}

TEST(Conversions, FitsIsTrueForContainedRangesOnly) {
    EXPECT_TRUE((rover::Fits<uint8_t, int16_t>));
    EXPECT_TRUE((rover::Fits<uint16_t, int32_t>));
    EXPECT_TRUE((rover::Fits<int8_t, int32_t>));
    EXPECT_FALSE((rover::Fits<int8_t, uint16_t>));
    EXPECT_FALSE((rover::Fits<uint16_t, int16_t>));
    EXPECT_FALSE((rover::Fits<int32_t, int16_t>));
}

TEST(LookUp, BeyondTheEndReadsTheLastEntry) {
    constexpr uint16_t kTable[3] = {10, 20, 65535};
    EXPECT_EQ(rover::look_up(kTable, uint8_t{0}), 10);
    EXPECT_EQ(rover::look_up(kTable, uint8_t{1}), 20);
    EXPECT_EQ(rover::look_up(kTable, uint8_t{2}), 65535);
    EXPECT_EQ(rover::look_up(kTable, uint8_t{3}), 65535);
    EXPECT_EQ(rover::look_up(kTable, uint16_t{65535}), 65535);
}

TEST(Native, ReturnsItsArgument) {
    EXPECT_EQ(rover::native(int16_t{-5}), -5);
    EXPECT_EQ(rover::index_of(uint8_t{7}), 7);
}

}  // namespace
