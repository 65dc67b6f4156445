// units_test.cpp - strong types: the sums that each one allows, and those it refuses.
#include "firmware/core/units.hpp"

#include <gtest/gtest.h>

#include "arith_reference.hpp"

namespace {

using namespace reference;
using rover::Brad16;
using rover::Q15;
using rover::Q4Mm;
using rover::Q4MmWide;

template <class U>
class NarrowUnits : public testing::Test {};
using NarrowUnitTypes = testing::Types<Brad16, Q15, Q4Mm>;
TYPED_TEST_SUITE(NarrowUnits, NarrowUnitTypes);

TYPED_TEST(NarrowUnits, RawAndToUnitAreInverse) {
    compare<int16_t>([](int16_t a) { return raw(rover::to_unit<TypeParam>(a)); },
                     [](int64_t a) { return a; });
}

TEST(Units, AngleDifferenceIsExactAndTheShortWayRound) {
    compare_pairs<int16_t, int16_t>(
        [](int16_t a, int16_t b) { return raw(sub_wrap(Brad16{a}, Brad16{b})); },
        [](int64_t a, int64_t b) {
            // The remainder nearest to zero; half a turn either way reads as -1/2.
            const double short_way = std::remainder(static_cast<double>(a - b), 65536.0);
            return short_way == 32768.0 ? -32768 : static_cast<int64_t>(short_way);
        });
}

TEST(Units, LengthsWrapOrSaturateAsTheNameSays) {
    EXPECT_EQ(add_wrap(Q4Mm{32767}, Q4Mm{1}), Q4Mm{-32768});
    EXPECT_EQ(neg_wrap(Q4Mm{16}), Q4Mm{-16});
    EXPECT_EQ(add_sat(Q4Mm{32767}, Q4Mm{1}), Q4Mm{32767});
    EXPECT_EQ(sub_sat(Q4Mm{-32768}, Q4Mm{1}), Q4Mm{-32768});
    EXPECT_EQ(add_sat(Q15{-32768}, Q15{-1}), Q15{-32768});
    EXPECT_EQ(add_wrap(Q4MmWide{2147483647}, Q4MmWide{1}), Q4MmWide{-2147483647 - 1});
    EXPECT_EQ(add_sat(Q4MmWide{2147483647}, Q4MmWide{1}), Q4MmWide{2147483647});
}

TEST(Units, ScaleIsTheRoundedProduct) {
    compare_pairs<int16_t, int16_t>(
        [](int16_t a, int16_t b) { return raw(rover::scale(Q4Mm{a}, Q15{b})); },
        [](int64_t a, int64_t b) {
            return saturate<int16_t>(std::floor(static_cast<double>(a * b) / 32768.0 + 0.5));
        });
    EXPECT_EQ(rover::mul_q15_sat(Q15{-32768}, Q15{-32768}), Q15{32767});
}

TEST(Units, WideLengthsNarrowToTheNearest) {
    compare<int16_t>([](int16_t a) { return raw(rover::widen(Q4Mm{a})); },
                     [](int64_t a) { return a; });
    compare<int32_t>([](int32_t a) { return raw(rover::narrow_sat(Q4MmWide{a})); },
                     [](int64_t a) { return saturate<int16_t>(a); });
}

TEST(Units, AreAsSmallAsTheirIntegers) {
    EXPECT_EQ(sizeof(Brad16), 2u);
    EXPECT_EQ(sizeof(Q15), 2u);
    EXPECT_EQ(sizeof(Q4Mm), 2u);
    EXPECT_EQ(sizeof(Q4MmWide), 4u);
}

}  // namespace
