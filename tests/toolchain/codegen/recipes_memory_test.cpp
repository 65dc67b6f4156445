// Loads and stores: T-states by hand, and the order of volatile accesses.
#include <gtest/gtest.h>

#include "tests/toolchain/codegen/coder_fixture.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

using RecipesMemory = CoderFixture;

TEST_F(RecipesMemory, AWordAtAFixedAddressIsLhld) {
    give_back(builder.load(builder.address(module.intern("v"), 0), 2, false));
    EXPECT_EQ(text_of(best_way().items), "LHLD a16");
    EXPECT_EQ(best_way().cost, 16);
}

TEST_F(RecipesMemory, AByteAtAFixedAddressIsLda) {
    give_back(builder.load(builder.address(module.intern("v"), 5), 1, false));
    const Coder way = best_way();
    EXPECT_EQ(text_of(way.items), "LDA a16");
    EXPECT_EQ(way.items[0].operand.offset, 5);
    EXPECT_EQ(way.cost, 13);
}

TEST_F(RecipesMemory, AByteThroughDeIsLdax) {
    const Bytes pointer = in({e, d});
    give_back(builder.load(pointer, 1, false));
    EXPECT_EQ(text_of(best_way().items), "LDAX D");
    EXPECT_EQ(best_way().cost, 7);
}

TEST_F(RecipesMemory, AWordIsStoredByShld) {
    const Bytes x = in({l, h});
    builder.store(builder.address(module.intern("v"), 0), x, false);
    give_back({});
    EXPECT_EQ(text_of(best_way().items), "SHLD a16");
}

TEST_F(RecipesMemory, AConstantThroughHlIsMviM) {
    const Bytes pointer = in({l, h});
    builder.store(pointer, builder.constant(7, 1), false);
    give_back({});
    EXPECT_EQ(text_of(best_way().items), "MVI M,d8");
    EXPECT_EQ(best_way().cost, 10);
}

/// Instructions that read or write memory at the program's will.
int accesses(const std::vector<CodeItem>& items) {
    int count = 0;
    for (const CodeItem& item : items) {
        const bool fixed = item.opcode == op::kLda || item.opcode == op::kSta;
        const bool symbol = item.operand.kind == CodeOperand::Kind::symbol;
        const std::string text(toolchain::isa::instruction(item.opcode).text());
        if (fixed && symbol) ++count;
        if ((item.opcode == op::kLhld || item.opcode == op::kShld) && symbol) count += 2;
        if (text.ends_with(",M") || text.starts_with("LDAX")) ++count;
    }
    return count;
}

TEST_F(RecipesMemory, EveryWayReadsEachVolatileByteOnce) {
    give_back(builder.load(builder.address(module.intern("v"), 0), 3, true));
    const Ways ways = translate(coder(), operation(), context());
    ASSERT_FALSE(ways.empty());
    for (const Coder& way : ways) EXPECT_EQ(accesses(way.items), 3) << text_of(way.items);
}

}  // namespace
