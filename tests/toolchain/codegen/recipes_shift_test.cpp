// Shifts and copies of the sign: costs by hand, results by arithmetic.
#include <gtest/gtest.h>

#include "tests/toolchain/codegen/coder_fixture.hpp"
#include "tests/toolchain/codegen/compare_programs.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

using RecipesShift = CoderFixture;

TEST_F(RecipesShift, AWordToTheLeftIsDadForEachBit) {
    const Bytes x = in({l, h});
    give_back(builder.shift_left(x, 3));
    EXPECT_EQ(text_of(best_way().items), "DAD H; DAD H; DAD H");
    EXPECT_EQ(best_way().cost, 30);
}

TEST_F(RecipesShift, AByteByFourTurnsAndMasks) {
    const Bytes x = in({a});
    give_back(builder.shift_right(x, 4));
    EXPECT_EQ(best_way().cost, 4 * 4 + 7);  // four rotations and ANI
}

TEST_F(RecipesShift, TheSignFillsAByteByCarry) {
    const Bytes x = in({a});
    give_back({builder.sign_extended(x, 2)[1]});
    EXPECT_EQ(text_of(best_way().items), "RAL; SBB A");
    EXPECT_EQ(best_way().cost, 8);
}

// Every count and width, on a value with alternating and corner bits in every byte.
TEST(RecipesShiftProgram, EveryCountAndWidth) {
    constexpr uint64_t kValue = 0xA5C3'7E81'96F0'0F3CULL;
    for (const std::size_t size : {1U, 2U, 3U, 4U, 5U, 8U}) {
        const auto bits = static_cast<unsigned>(8 * size);
        const uint64_t mask = size == 8 ? UINT64_MAX : (uint64_t{1} << bits) - 1;
        const uint64_t value = (kValue | uint64_t{1} << (bits - 1)) & mask;
        const auto extended = static_cast<int64_t>(value | ~mask);
        for (unsigned count = 1; count < 8; ++count) {
            EXPECT_EQ(run_small(value, size, size,
                                [&](Builder& builder, const Bytes& x) {
                                    return builder.shift_left(x, count);
                                }),
                      value << count & mask);
            EXPECT_EQ(run_small(value, size, size,
                                [&](Builder& builder, const Bytes& x) {
                                    return builder.shift_right(x, count);
                                }),
                      value >> count);
            EXPECT_EQ(run_small(value, size, size,
                                [&](Builder& builder, const Bytes& x) {
                                    return builder.shift_right_signed(x, count);
                                }),
                      static_cast<uint64_t>(extended >> count) & mask);
        }
    }
}

}  // namespace
