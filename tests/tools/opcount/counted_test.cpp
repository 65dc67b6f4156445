// counted_test.cpp - counting integers give the same bits, and count what the helpers stand for.
#include <gtest/gtest.h>

#include <type_traits>

#include "sample_kernel.hpp"

uint32_t sample_with_plain_words(int16_t a, int16_t b);  // sample_plain.cpp

namespace {

using namespace rover;

/// What `work` adds to the tally.
template <class Work>
OperationTally tally_of(Work work) {
    operation_tally() = {};
    work();
    return operation_tally();
}

/// A tally with only these: add_sub, compare, multiply, divide, shift, logic, table_lookup.
OperationTally expected(std::array<uint64_t, kOperationCount> count) {
    return {count};
}

const S16 kA{1000};
const S16 kB{-37};

TEST(Counted, GivesTheSameBitsAsPlainWords) {
    for (int32_t a = -32768; a <= 32767; a += 331) {
        for (int32_t b = -32768; b <= 32767; b += 257) {
            const auto first = static_cast<int16_t>(a);
            const auto second = static_cast<int16_t>(b);
            ASSERT_EQ(sample::everything(first, second), sample_with_plain_words(first, second))
                << a << ", " << b;
        }
    }
}

TEST(Counted, EveryHelperIsItsElementaryOperations) {
    EXPECT_EQ(tally_of([] { (void)add_wrap(kA, kB); }), expected({1, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(tally_of([] { (void)abs_u16(kA); }), expected({1, 0, 0, 0, 0, 0, 0}));
    EXPECT_EQ(tally_of([] { (void)clamp(kA, kB, kA); }), expected({0, 2, 0, 0, 0, 0, 0}));
    EXPECT_EQ(tally_of([] { (void)narrow_sat_u8(kA); }), expected({0, 1, 0, 0, 0, 0, 0}));
    EXPECT_EQ(tally_of([] { (void)mul_wide(kA, kB); }), expected({0, 0, 1, 0, 0, 0, 0}));
    EXPECT_EQ(tally_of([] { (void)div_round_half_up(kA, kB); }), expected({0, 0, 0, 1, 0, 0, 0}));
    EXPECT_EQ(tally_of([] { (void)shift_floor<3>(kA); }), expected({0, 0, 0, 0, 1, 0, 0}));
    EXPECT_EQ(tally_of([] { (void)shift_floor(kA, 3); }), expected({0, 0, 0, 0, 1, 0, 0}));
    EXPECT_EQ(tally_of([] { (void)bit_and(U8{1}, U8{2}); }), expected({0, 0, 0, 0, 0, 1, 0}));
    EXPECT_EQ(tally_of([] { (void)look_up(sample::kSquares, U8{2}); }),
              expected({0, 0, 0, 0, 0, 0, 1}));
    EXPECT_EQ(tally_of([] { (void)average(kA, kB); }), expected({1, 0, 0, 0, 1, 0, 0}));
    EXPECT_EQ(tally_of([] { (void)lerp_q6(kA, kB, U8{9}); }), expected({2, 0, 1, 0, 1, 0, 0}));
}

TEST(Counted, ComparisonsCountOneEach) {
    EXPECT_EQ(tally_of([] {
                  EXPECT_TRUE(kA > kB);
                  EXPECT_FALSE(kA == kB);
                  EXPECT_TRUE(kA != S16{7});
                  EXPECT_TRUE(kA >= 0);
              }),
              expected({0, 4, 0, 0, 0, 0, 0}));
}

TEST(Counted, CopiesAndWrappingConversionsAreFree) {
    EXPECT_EQ(tally_of([] {
                  const S16 copy = kA;
                  (void)narrow_wrap_u8(copy);
                  (void)widen_s32(copy);
                  (void)native(copy);
                  (void)to_unit<Brad16>(copy);
              }),
              expected({}));
}

TEST(Counted, RingAccessIsOneSumOneMaskOneLookUp) {
    Ring<S16, 4> ring;
    EXPECT_EQ(tally_of([&] { ring.at(U8{1}) = kA; }), expected({1, 0, 0, 0, 0, 1, 1}));
}

TEST(Counted, SquareRootOf16BitsIsEightPasses) {
    // 255 = 0b11111111 squared subtracts in each pass. Six digits in a byte: what is left and the
    // trial change; a comparison; four shifts, two of them by whole bytes; a mask. Two more: trial,
    // what is left, root; a comparison; three shifts. Two shifts between.
    EXPECT_EQ(tally_of([] { (void)isqrt(U16{65025}); }),
              expected({6 * 2 + 2 * 3, 8, 0, 0, 6 * 4 + 2 + 2 * 3, 6, 0}));
}

TEST(Counted, ConstantsAreEvaluatedWithoutCounting) {
    EXPECT_EQ(tally_of([] {
                  constexpr S16 kSum = add_wrap(S16{1}, S16{2});
                  (void)kSum;
              }),
              expected({}));
}

TEST(Counted, TotalIsTheSumOfTheCategories) {
    const OperationTally tally = expected({1, 2, 3, 4, 5, 6, 7});
    EXPECT_EQ(tally.total(), 28u);
    EXPECT_EQ(tally[Operation::divide], 4u);
    EXPECT_EQ(tally[Operation::table_lookup], 7u);
}

TEST(Counted, TypesDoNotMix) {
    EXPECT_FALSE((std::is_convertible_v<U16, uint16_t>));
    EXPECT_FALSE((std::is_convertible_v<U16, S16>));
    EXPECT_FALSE((std::is_constructible_v<S16, U16>));
}

}  // namespace
