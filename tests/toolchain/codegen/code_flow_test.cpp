// Data flow of finished code: what is live, where a slot's address may be, which values are equal.
#include "toolchain/codegen/code_flow.hpp"

#include <gtest/gtest.h>

#include "tests/toolchain/codegen/code_items.hpp"
#include "toolchain/codegen/coder.hpp"
#include "toolchain/codegen/known_values.hpp"

namespace {

using namespace toolchain::codegen;
using codegen_test::item;
using codegen_test::jump;
using codegen_test::label;
using codegen_test::slot;
using enum Register;
using Items = std::vector<CodeItem>;

TEST(CodeFlow, TableWordsAreExitsOfTheJumpToTheirRoutine) {
    CodeItem word = jump(0, 7);
    word.kind = CodeItem::Kind::word;
    const Items items = {item(op::kJmp, {CodeOperand::Kind::symbol, CodeOperand::Part::word, 1, 0}),
                         label(1), word};
    const std::vector<Exits> exits = find_exits(items);
    EXPECT_EQ(exits[0].labels, std::vector<uint32_t>{7});
    EXPECT_FALSE(exits[0].falls);
    EXPECT_FALSE(exits[2].falls);
}

// A loop that reads B in its next turn, and a slot behind it.
TEST(CodeFlow, WhatALoopReadsLaterIsLiveAtItsEnd) {
    const Items items = {label(1),          item(mov(a, b)),   item(0x3D),
                         jump(op::kJnz, 1), slot(op::kLda, 3), item(op::kRet)};
    const std::vector<Exits> exits = find_exits(items);
    std::vector<SlotAccess> accesses(items.size());
    accesses[4] = {3, 1, true, false};
    const std::vector<Live> live = find_live(items, exits, accesses, resource::kA);
    EXPECT_EQ(live[2].registers & resource::of(0U), resource::of(0U));
    EXPECT_TRUE(live[2].slots.test(3));
    EXPECT_EQ(live[4].registers, resource::kA);
    EXPECT_FALSE(live[4].slots.test(3));
}

TEST(CodeFlow, ASlotsAddressIsFollowed) {
    const Items items = {slot(by_pair(op::kLxi, Pair::hl), 2), item(op::kXchg),
                         item(by_pair(op::kInx, Pair::de)),    item(mov(b, d)),
                         item(by_pair(op::kLxi, Pair::de)),    item(op::kRet)};
    const std::vector<ResourceSet> held = find_slot_pointers(items, find_exits(items));
    EXPECT_EQ(held[1], resource::kHl);
    EXPECT_EQ(held[3], resource::kDe);
    EXPECT_EQ(held[4], resource::kDe | resource::of(0U));
    EXPECT_EQ(held[5], resource::of(0U));
}

TEST(KnownValues, ASlotReachedThroughAPairIsKnown) {
    const Items items = {slot(op::kSta, 4), slot(by_pair(op::kLxi, Pair::hl), 3),
                         item(by_pair(op::kInx, Pair::hl)), item(mov_from_memory(b)),
                         item(op::kRet)};
    const std::vector<Exits> exits = find_exits(items);
    const std::vector<ResourceSet> pointers = find_slot_pointers(items, exits);
    KnownValues known(items, exits, 8);
    for (std::size_t i = 0; i + 1 < items.size(); ++i) {
        const SlotAccess access = known.access(items[i], pointers[i]);
        if (i == 3) {
            EXPECT_EQ(access.first, 4U);
            EXPECT_TRUE(access.reads);
        }
        known.step(items[i], exits[i], access);
    }
    EXPECT_EQ(known.in(a), known.in(b));
    EXPECT_EQ(known.find(known.in(a), resource::kA), b);
}

TEST(KnownValues, APointerThatMayBeASlotMayBeAnySlot) {
    const Items items = {slot(by_pair(op::kLxi, Pair::hl), 3), item(by_pair(op::kDad, Pair::de)),
                         item(mov_to_memory(a)), item(op::kRet)};
    const std::vector<Exits> exits = find_exits(items);
    const std::vector<ResourceSet> pointers = find_slot_pointers(items, exits);
    KnownValues known(items, exits, 8);
    known.step(items[0], exits[0], {});
    known.step(items[1], exits[1], {});
    const SlotAccess access = known.access(items[2], pointers[2]);
    EXPECT_EQ(access.first, SlotAccess::kAnywhere);
    const ValueNumber before = known.state.slots[1];
    known.step(items[2], exits[2], access);
    EXPECT_NE(known.state.slots[1], before);
}

TEST(KnownValues, ConstantsAreCounted) {
    const Items items = {item(by_pair(op::kLxi, Pair::bc),
                              {CodeOperand::Kind::number, CodeOperand::Part::word, 0, 0x12FF}),
                         item(by_pair(op::kInx, Pair::bc)), item(op::kRet)};
    const std::vector<Exits> exits = find_exits(items);
    KnownValues known(items, exits, 0);
    known.step(items[0], exits[0], {});
    known.step(items[1], exits[1], {});
    EXPECT_EQ(known.constant_in(b), 0x13);
    EXPECT_EQ(known.constant_in(c), 0x00);
}

}  // namespace
