// Comparisons: what they cost, and every predicate over corners, against the host's.
#include <gtest/gtest.h>

#include <array>

#include "tests/toolchain/codegen/coder_fixture.hpp"
#include "tests/toolchain/codegen/compare_programs.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

class RecipesCompare : public CoderFixture {
protected:
    Decision best(Predicate predicate, const Bytes& left, const Bytes& right) {
        const std::vector<Decision> ways = decide(coder(), predicate, left, right, {1, 2});
        EXPECT_FALSE(ways.empty());
        Decision cheapest = ways.at(0);
        for (const Decision& way : ways) {
            if (way.coder.cost < cheapest.coder.cost) cheapest = way;
        }
        return cheapest;
    }
};

TEST_F(RecipesCompare, BytesAreCompared) {
    const Bytes x = in({a});
    const Bytes y = in({c});
    give_back({x[0], y[0]});
    const Decision way = best(Predicate::below, x, y);
    EXPECT_EQ(text_of(way.coder.items), "CMP C");
    EXPECT_EQ(way.condition, Condition::c);
    EXPECT_EQ(best(Predicate::not_below, x, y).condition, Condition::nc);
}

TEST_F(RecipesCompare, AWordIsZeroIfBothBytesAre) {
    const Bytes x = in({l, h});
    give_back({});
    const Bytes zero = facts.function.blocks[0].parameters.empty() ? Bytes{} : x;
    (void)zero;
    const ByteId nought = static_cast<ByteId>(facts.function.bytes.size());
    facts.function.bytes.push_back({ByteInfo::Kind::constant, 0});
    Coder start = coder();
    start.set(Pair::hl, x[0], x[1]);
    const std::vector<Decision> ways = decide(start, Predicate::equal, x, {nought, nought}, {1, 2});
    ASSERT_FALSE(ways.empty());
    EXPECT_EQ(text_of(ways[0].coder.items), "MOV A,L; ORA H");
    EXPECT_EQ(ways[0].condition, Condition::z);
}

TEST_F(RecipesCompare, FlagsOfTheLastOperationAreUsed) {
    const Bytes x = in({b});
    give_back(x);
    const ByteId nought = static_cast<ByteId>(facts.function.bytes.size());
    facts.function.bytes.push_back({ByteInfo::Kind::constant, 0});
    Coder start = coder();
    start.state.tested = x[0];
    const std::vector<Decision> ways = decide(start, Predicate::not_equal, x, {nought}, {1, 2});
    ASSERT_EQ(ways.size(), 1U);
    EXPECT_TRUE(ways[0].coder.items.empty());
    EXPECT_EQ(ways[0].condition, Condition::nz);
}

bool holds(Predicate predicate, uint64_t left, uint64_t right, unsigned bits) {
    const unsigned unused = 64 - bits;
    const auto left_signed = static_cast<int64_t>(left << unused) >> unused;
    const auto right_signed = static_cast<int64_t>(right << unused) >> unused;
    switch (predicate) {
        case Predicate::equal:
            return left == right;
        case Predicate::not_equal:
            return left != right;
        case Predicate::below:
            return left < right;
        case Predicate::not_below:
            return left >= right;
        case Predicate::less:
            return left_signed < right_signed;
        case Predicate::not_less:
            return left_signed >= right_signed;
    }
    return false;
}

// Found by random functions: no way was left where all registers were needed and an operand that
// occurs twice was in A only.
TEST_F(RecipesCompare, AnOperandThatIsInAOnly) {
    const Bytes x = in({a});
    const Bytes others = in({l, h});
    const Bytes more = in({e, d});
    const Bytes rest = in({c, b});
    const Bytes left = {x[0], others[0], more[1], rest[0]};
    const Bytes right = {x[0], others[1], more[0], more[0]};
    const ByteId result = builder.compare(Predicate::equal, left, right);
    give_back({result, others[0], others[1], more[0], more[1], rest[0], rest[1]});
    EXPECT_FALSE(decide(coder(), Predicate::equal, left, right, {1, 2}).empty());
    EXPECT_FALSE(decide(coder(), Predicate::equal, right, left, {1, 2}).empty());
}

// Run-time values of both sides, all pairs of corners, two bytes wide; all in one program a
// predicate would be faster but less plain.
TEST(RecipesCompareProgram, EveryPredicateOverCorners) {
    constexpr std::array<uint64_t, 5> kCorners = {0, 1, 0x7FFF, 0x8000, 0xFF00};
    for (unsigned number = 0; number < 6; ++number) {
        const auto predicate = static_cast<Predicate>(number);
        for (const uint64_t left : kCorners) {
            for (const uint64_t right : kCorners) {
                const uint64_t both = left | right << 16;
                EXPECT_EQ(run_small(both, 4, 1,
                                    [&](Builder& builder, const Bytes& x) {
                                        return Bytes{
                                            builder.compare(predicate, {x[0], x[1]}, {x[2], x[3]})};
                                    }),
                          holds(predicate, left, right, 16) ? 1U : 0U)
                    << number << ": " << left << ", " << right;
            }
        }
    }
}

}  // namespace
