// Sums and bitwise operations: what the cheapest way costs, by hand from the data sheet's T-states.
#include <gtest/gtest.h>

#include "tests/toolchain/codegen/coder_fixture.hpp"
#include "tests/toolchain/codegen/compare_programs.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

using RecipesAdd = CoderFixture;

TEST_F(RecipesAdd, WordsInHlAndDeAreOneDad) {
    const Bytes x = in({l, h});
    const Bytes y = in({e, d});
    give_back(builder.add(x, y));
    EXPECT_EQ(text_of(best_way().items), "DAD D");
    EXPECT_EQ(best_way().cost, 10);
    EXPECT_EQ(best_way(1).cost, 11);
}

TEST_F(RecipesAdd, DoublingIsDadH) {
    const Bytes x = in({l, h});
    give_back(builder.add(x, x));
    EXPECT_EQ(text_of(best_way().items), "DAD H");
}

TEST_F(RecipesAdd, SmallNumbersAreSteps) {
    const Bytes x = in({e, d});
    give_back(builder.add(x, builder.constant(1, 2)));
    EXPECT_EQ(text_of(best_way().items), "INX D");
    EXPECT_EQ(best_way().cost, 6);
}

TEST_F(RecipesAdd, MinusOneOfAByteIsDcr) {
    const Bytes x = in({b});
    give_back(builder.add(x, builder.constant(0xFF, 1)));
    const Coder way = best_way();
    EXPECT_EQ(text_of(way.items), "DCR B");
    EXPECT_EQ(way.state.tested, operation().results[0]);  // Z and S tell about the result
}

TEST_F(RecipesAdd, BytesGoThroughA) {
    const Bytes x = in({a});
    const Bytes y = in({c});
    give_back(builder.bitwise(Opcode::bit_and, x, y));
    EXPECT_EQ(text_of(best_way().items), "ANA C");
    EXPECT_EQ(best_way().cost, 4);
}

TEST_F(RecipesAdd, AnOperandThatIsStillNeededIsKept) {
    const Bytes x = in({l, h});
    const Bytes y = in({e, d});
    Bytes both = builder.add(x, y);
    both.insert(both.end(), x.begin(), x.end());
    give_back(both);
    for (const Coder& way : translate(coder(), operation(), context())) {
        if (!way.complete()) continue;
        for (const ByteId byte : both) {
            EXPECT_TRUE(way.in_slot(byte) || way.find(byte) != flags) << text_of(way.items);
        }
    }
    EXPECT_GT(best_way().cost, 10);
}

TEST_F(RecipesAdd, DifferencesAreChains) {
    const Bytes x = in({l, h});
    const Bytes y = in({e, d});
    give_back(builder.subtract(x, y));
    // MOV A,L; SUB E; MOV L,A; MOV A,H; SBB D; MOV H,A
    EXPECT_EQ(best_way().cost, 6 * 4);
}

// Found by random functions: the carry of the lower words was added before the upper word was
// doubled, so it counted twice. 2 * 0000'8001H and 2 * FFFF'FFFFH.
TEST(RecipesAddProgram, DoublingALongCountsTheCarryOnce) {
    for (const uint64_t value : {0x00008001ULL, 0xFFFFFFFFULL, 0x12348765ULL}) {
        const auto bits = static_cast<uint32_t>(value);
        EXPECT_EQ(run_small(value, 4, 4,
                            [](Builder& builder, const Bytes& x) { return builder.add(x, x); }),
                  static_cast<uint32_t>(bits + bits));
    }
}

TEST_F(RecipesAdd, NoWayDoublesBehindTheCarry) {
    const Bytes x = in({l, h, e, d});
    give_back(builder.add(x, x));
    std::size_t by_words = 0;
    for (const Coder& way : translate(coder(), operation(), context())) {
        const std::string text = text_of(way.items);
        if (text.find("INX H") != std::string::npos) ++by_words;
        EXPECT_EQ(text.find("INX H; L:; DAD H"), std::string::npos) << text;
    }
    EXPECT_GT(by_words, 0U);
}

TEST(RecipesAddProgram, UpperWordsMayBeTheSameAlone) {
    // Lower words 8001H and 00F0H, upper words both 1234H.
    EXPECT_EQ(run_small(0x123480F1ULL, 4, 4,
                        [](Builder& builder, const Bytes& x) {
                            return builder.add(x, {x[1], x[1], x[2], x[3]});
                        }),
              0x123480F1U + 0x12348080U);
}

}  // namespace
