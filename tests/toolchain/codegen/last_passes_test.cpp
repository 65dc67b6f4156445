// last_passes_test.cpp - loads in front of branches, short forms, calls in front of returns: by
// hand. Random code goes through them in cleanup_test.cpp.
#include <gtest/gtest.h>

#include "tests/toolchain/codegen/code_items.hpp"
#include "tests/toolchain/codegen/coder_fixture.hpp"
#include "toolchain/codegen/early_loads.hpp"
#include "toolchain/codegen/peephole.hpp"
#include "toolchain/codegen/short_forms.hpp"
#include "toolchain/codegen/tail_calls.hpp"

namespace {

using namespace toolchain::codegen;
using codegen_test::item;
using codegen_test::jump;
using codegen_test::label;
using codegen_test::number;
using codegen_test::slot;
using codegen_test::text_of;
using enum Register;
using Items = std::vector<CodeItem>;

constexpr auto kA = set_of(a);
constexpr auto kAb = static_cast<RegisterSet>(set_of(a) | set_of(b));
constexpr uint8_t kMviA = 0x3E, kMviB = 0x06, kAni = 0xE6, kOraB = 0xB0, kSubB = 0x90, kXraA = 0xAF;

std::string early(Items items, RegisterSet at_return) {
    load_early(items, at_return);
    improve(items);
    return text_of(items);
}

std::string shortened(Items items, RegisterSet at_return) {
    take_short_forms(items, at_return);
    return text_of(items);
}

// -- Loads in front of branches ------------------------------------------------------------------

TEST(EarlyLoads, OfAConstantThatIsOneOrTheOther) {
    EXPECT_EQ(early({jump(op::kJz, 1), number(kMviB, 5), label(2), number(op::kSta, 0x9000),
                     item(op::kRet), label(1), number(kMviB, 6), jump(op::kJmp, 2)},
                    set_of(b)),
              "MVI B,d8; JZ a16; MVI B,d8; L:; STA a16; RET");
}

TEST(EarlyLoads, ALoadAndAReturnBecomeAConditionalReturn) {
    EXPECT_EQ(early({jump(op::kJnz, 1), item(mov(a, b)), number(op::kSta, 0x9000), item(kXraA),
                     item(op::kRet), label(1), number(kMviA, 3), item(op::kRet)},
                    kA),
              "MVI A,d8; RNZ; MOV A,B; STA a16; XRA A; RET");
}

TEST(EarlyLoads, BetweenTheBranchAndWhereItGoes) {
    EXPECT_EQ(early({jump(op::kJz, 1), number(kMviA, 3), item(op::kRet), label(1), item(mov(a, b)),
                     number(op::kSta, 0x9000), item(op::kRet)},
                    kA),
              "MVI A,d8; RNZ; MOV A,B; STA a16; RET");
}

TEST(EarlyLoads, NotWhereTheOtherWayWantsWhatIsThere) {
    const Items wanted = {jump(op::kJz, 1), number(op::kSta, 0x9000), item(op::kRet),
                          label(1),         number(kMviA, 3),         item(op::kRet)};
    EXPECT_EQ(early(wanted, kA), text_of(wanted));
}

TEST(EarlyLoads, NotOfMemoryThatMayBeVolatile) {
    const Items reads = {jump(op::kJz, 1), item(0x04), item(mov(a, b)),
                         item(op::kRet),   label(1),   number(op::kLda, 0x9000),
                         item(op::kRet)};
    EXPECT_EQ(early(reads, kA), text_of(reads));
}

TEST(EarlyLoads, NotWithFlagsThatSomebodyReads) {
    const Items flags = {jump(op::kJc, 1), number(kMviA, 1), label(2),
                         item(0xC8),       item(mov(b, a)),  item(op::kRet),
                         label(1),         item(kXraA),      jump(op::kJmp, 2)};
    EXPECT_EQ(early(flags, kAb), text_of(flags));
}

TEST(EarlyLoads, NotInALoopForTheSakeOfAWayOutOfIt) {
    const Items loop = {label(0),         jump(op::kJz, 1),  item(0x05),     item(mov(a, b)),
                        item(0x0D),       jump(op::kJnz, 0), item(op::kRet), label(1),
                        number(kMviA, 3), item(op::kRet)};
    EXPECT_EQ(early(loop, kA), text_of(loop));
}

// -- Short forms ---------------------------------------------------------------------------------

TEST(ShortForms, ZeroWithoutFlags) {
    EXPECT_EQ(shortened({number(kMviA, 0), item(op::kRet)}, kA), "XRA A; RET");
    EXPECT_EQ(shortened({number(kMviA, 0), item(0x88), item(op::kRet)}, kA),
              "MVI A,d8; ADC B; RET");
}

TEST(ShortForms, AnOperandInMemory) {
    EXPECT_EQ(shortened({item(mov_from_memory(b)), item(kOraB), item(op::kRet)}, kA), "ORA M; RET");
    EXPECT_EQ(
        shortened({item(mov_from_memory(b)), item(mov(a, c)), item(kSubB), item(op::kRet)}, kA),
        "MOV A,C; SUB M; RET");
    EXPECT_EQ(shortened({item(mov_from_memory(b)), item(kOraB), item(op::kRet)}, kAb),
              "MOV B,M; ORA B; RET");
}

TEST(ShortForms, BitsAtTheEndsOfA) {
    EXPECT_EQ(
        shortened({number(kAni, 0x01), jump(op::kJz, 1), item(0x04), label(1), item(op::kRet)},
                  set_of(b)),
        "RRC; JNC a16; INR B; L:; RET");
    EXPECT_EQ(shortened({number(kAni, 0x40), item(0xC0), item(0x04), item(op::kRet)}, set_of(b)),
              "ADD A; RM; INR B; RET");
    EXPECT_EQ(shortened({number(kAni, 0x40), item(0xC0), item(0x04), item(op::kRet)}, kAb),
              "ANI d8; RNZ; INR B; RET");
    EXPECT_EQ(shortened({number(kAni, 0x02), item(0xC0), item(0x04), item(op::kRet)}, set_of(b)),
              "ANI d8; RNZ; INR B; RET");
}

// -- Calls in front of returns -------------------------------------------------------------------

CodeItem call(uint32_t symbol) {
    return item(op::kCall, {CodeOperand::Kind::symbol, CodeOperand::Part::word, symbol, 0});
}

TEST(TailCalls, ACallInFrontOfAReturnIsAJump) {
    Items items = {call(7), item(0x04), call(8), item(op::kRet)};
    jump_to_last_calls(items, 99);
    EXPECT_EQ(text_of(items), "CALL a16; INR B; JMP a16");
    EXPECT_EQ(items.back().operand.id, 8U);
}

TEST(TailCalls, ABranchToOneGoesThere) {
    Items items = {jump(op::kJz, 1), item(0x04), item(op::kRet), label(1), call(8), item(op::kRet)};
    jump_to_last_calls(items, 99);
    EXPECT_EQ(text_of(items), "JZ a16; INR B; RET");
    EXPECT_EQ(items.front().operand.id, 8U);
}

TEST(TailCalls, ACallThroughAPointerStays) {
    Items items = {call(99), item(op::kRet)};
    jump_to_last_calls(items, 99);
    EXPECT_EQ(text_of(items), "CALL a16; RET");
}

}  // namespace
