// Which comparisons the carry of a sum answers: every byte constant against arithmetic, and what
// must not be taken for an answer.
#include "toolchain/codegen/carries.hpp"

#include <gtest/gtest.h>

#include "tests/toolchain/codegen/coder_fixture.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

class Carries : public CoderFixture {
protected:
    CarryAnswer answer(Predicate predicate, const Bytes& left, const Bytes& right) {
        Terminator end;
        end.kind = Terminator::Kind::branch;
        end.predicate = predicate;
        end.left = left;
        end.right = right;
        end.edges = {{.target = 0}, {.target = 0}};
        function.blocks[0].terminator = end;
        return find_carry_answers(function, function.blocks[0]).back();
    }
};

TEST_F(Carries, ASumIsBelowItsOperandsIfItWraps) {
    const Bytes x = in({l, h});
    const Bytes y = in({e, d});
    const Bytes sum = builder.add(x, y);
    for (const Bytes& operand : {x, y}) {
        for (const Predicate predicate : {Predicate::below, Predicate::not_below}) {
            EXPECT_EQ(answer(predicate, sum, operand).from, 0U);
            EXPECT_FALSE(answer(predicate, sum, operand).inverted);
        }
        EXPECT_EQ(answer(Predicate::less, sum, operand).from, kNone);
        EXPECT_EQ(answer(Predicate::equal, sum, operand).from, kNone);
        EXPECT_EQ(answer(Predicate::below, operand, sum).from, kNone);
    }
    const Bytes low(sum.begin(), sum.begin() + 1);
    EXPECT_EQ(answer(Predicate::below, low, {x[0]}).from, kNone) << "the carry is of all bytes";
}

TEST_F(Carries, ADifferenceBorrows) {
    const Bytes x = in({a});
    const Bytes y = in({c});
    (void)builder.subtract(x, y);
    EXPECT_EQ(answer(Predicate::below, x, y).from, 0U);
    EXPECT_FALSE(answer(Predicate::below, x, y).inverted);
    EXPECT_EQ(answer(Predicate::below, y, x).from, kNone);
}

TEST_F(Carries, NoSumNoAnswer) {
    const Bytes x = in({a});
    const Bytes y = in({c});
    (void)builder.bitwise(Opcode::bit_and, x, y);
    EXPECT_EQ(answer(Predicate::below, x, y).from, kNone);
}

// x + number carries from 256 - number on.
TEST_F(Carries, ConstantsAnswerWhereTheSumTurns) {
    const Bytes x = in({a});
    for (unsigned number = 1; number < 256; ++number) {
        function.blocks[0].operations.clear();
        (void)builder.add(x, builder.constant(number, 1));
        ASSERT_EQ(function.blocks[0].operations.size(), 1U);
        for (unsigned limit = 0; limit < 256; ++limit) {
            const Bytes bound = builder.constant(limit, 1);
            for (const bool bound_first : {false, true}) {
                const CarryAnswer seen = bound_first ? answer(Predicate::below, bound, x)
                                                     : answer(Predicate::below, x, bound);
                const bool wanted = limit + number == (bound_first ? 255U : 256U);
                ASSERT_EQ(seen.from, wanted ? 0U : kNone) << number << " " << limit;
                if (!wanted) continue;
                for (unsigned value = 0; value < 256; ++value) {
                    const bool carry = value + number > 255;
                    const bool holds = bound_first ? limit < value : value < limit;
                    ASSERT_EQ(holds, carry != seen.inverted) << number << " " << value;
                }
            }
        }
    }
}

TEST_F(Carries, TheComparisonTakesTheFlagThatIsThere) {
    const Bytes x = in({a});
    const Bytes y = in({c});
    const Bytes sum = builder.add(x, y);
    Terminator end;
    end.kind = Terminator::Kind::branch;
    end.predicate = Predicate::below;
    end.left = sum;
    end.right = x;
    end.edges = {{.target = 1}, {.target = 2}};
    function.blocks[0].terminator = end;
    for (const BlockId block : {1U, 2U}) {
        function.blocks.emplace_back();
        function.blocks[block].terminator.kind = Terminator::Kind::give_back;
        function.blocks[block].terminator.left = block == 1 ? sum : x;
    }
    function.result_size = 1;
    facts = find_facts(function);
    Coder start = coder();
    start.position = 1;
    start.state.carry_of = 0;
    const auto decisions = decide(start, Predicate::below, facts.function.blocks[0].terminator.left,
                                  facts.function.blocks[0].terminator.right, {1, 2});
    ASSERT_FALSE(decisions.empty());
    EXPECT_TRUE(decisions[0].coder.items.empty());
    EXPECT_EQ(decisions[0].condition, Condition::c);
    start.emit(0xB7);  // ORA A: the carry is another
    EXPECT_EQ(start.state.carry_of, kNone);
}

}  // namespace
