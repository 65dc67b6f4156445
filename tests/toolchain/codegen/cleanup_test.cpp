// Finished code behind its last passes: by hand, and random code that must still compute the same.
#include "toolchain/codegen/cleanup.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "host_sim/cpu/flat_machine.hpp"
#include "tests/toolchain/codegen/code_items.hpp"
#include "tests/toolchain/codegen/coder_fixture.hpp"
#include "toolchain/codegen/early_loads.hpp"
#include "toolchain/codegen/merge_tails.hpp"
#include "toolchain/codegen/peephole.hpp"
#include "toolchain/codegen/short_forms.hpp"

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

constexpr uint32_t kSlots = 8;

std::string cleaned(Items items, RegisterSet at_return) {
    clean_up(items, kSlots, at_return);
    return text_of(items);
}

constexpr auto kA = set_of(a);
constexpr auto kHl = static_cast<RegisterSet>(set_of(h) | set_of(l));

TEST(Cleanup, ASlotThatIsStillInARegisterIsNotLoaded) {
    EXPECT_EQ(cleaned({slot(op::kSta, 2), item(mov(b, a)), number(0x3E, 7), number(op::kOut, 1),
                       slot(op::kLda, 2), item(op::kRet)},
                      kA),
              "MOV B,A; MVI A,d8; OUT p8; MOV A,B; RET");
}

TEST(Cleanup, StoresThatNobodyReadsDisappear) {
    EXPECT_EQ(cleaned({slot(op::kShld, 0), slot(op::kSta, 3), item(op::kRet)}, kHl), "RET");
}

TEST(Cleanup, StoresOutsideOfTheFrameStay) {
    EXPECT_EQ(cleaned({number(op::kSta, 0x9000), number(op::kLda, 0x9000), item(op::kRet)}, 0),
              "STA a16; LDA a16; RET");
}

TEST(Cleanup, StacksThatKeepNothingDisappear) {
    EXPECT_EQ(cleaned({item(op::kPushPsw), item(mov(a, b)), number(op::kSta, 0x9000),
                       item(op::kPopPsw), number(0x3E, 1), item(op::kRet)},
                      kA),
              "MOV A,B; STA a16; MVI A,d8; RET");
    EXPECT_EQ(cleaned({item(op::kPushPsw), item(mov(a, b)), number(op::kSta, 0x9000),
                       item(op::kPopPsw), item(op::kRet)},
                      kA),
              "PUSH PSW; MOV A,B; STA a16; POP PSW; RET");
}

TEST(Cleanup, WordsInHalvesAreOne) {
    EXPECT_EQ(cleaned({number(0x26, 0x12), number(0x2E, 0x34), item(op::kRet)}, kHl),
              "LXI H,d16; RET");
}

TEST(Cleanup, ByteMovesGoTheShortWay) {
    EXPECT_EQ(cleaned({item(mov(a, b)), item(mov(l, a)), item(mov(a, c)), item(mov(h, a)),
                       item(op::kRet)},
                      kHl),
              "MOV L,B; MOV H,C; RET");
}

TEST(Cleanup, FlagsDecideWhatMayBeShort) {
    EXPECT_EQ(cleaned({number(0xC6, 1), item(op::kRet)}, kA), "INR A; RET");
    EXPECT_EQ(cleaned({number(0xC6, 1), item(0x88 | 0), item(op::kRet)}, kA), "ADI d8; ADC B; RET");
    EXPECT_EQ(cleaned({number(0xEE, 0xFF), item(op::kRet)}, kA), "CMA; RET");
    EXPECT_EQ(cleaned({number(0x3E, 0), item(0x9C), item(op::kRet)}, kA), "SBB A; SUB H; RET");
    EXPECT_EQ(cleaned({number(0x3E, 0), item(0x9C), item(0x9D), item(op::kRet)}, kA),
              "MVI A,d8; SBB H; SBB L; RET");
}

TEST(Cleanup, WhatAllWaysToALabelAgreeOnIsKnown) {
    EXPECT_EQ(cleaned({number(0x06, 5), jump(op::kJz, 1), item(mov(c, a)), label(1),
                       number(0x3E, 5), item(op::kRet)},
                      static_cast<RegisterSet>(kA | set_of(b) | set_of(c))),
              "MVI B,d8; JZ a16; MOV C,A; L:; MOV A,B; RET");
}

TEST(Cleanup, ALoopForgets) {
    EXPECT_EQ(cleaned({number(0x06, 5), label(1), number(0x06, 5), item(0x05), item(0x0D),
                       jump(op::kJnz, 1), item(op::kRet)},
                      set_of(b)),
              "L:; MVI B,d8; DCR B; DCR C; JNZ a16; RET");
}

TEST(MergeTails, EqualEndsOfWaysToOneLabelAreThereOnce) {
    Items items = {jump(op::kJz, 1), item(0x04), item(0x0C), jump(op::kJmp, 2), label(1),
                   item(0x14),       item(0x0C), label(2),   item(op::kRet)};
    uint32_t next = 3;
    merge_tails(items, next);
    EXPECT_EQ(text_of(items), "JZ a16; INR B; JMP a16; L:; INR D; L:; INR C; L:; RET");
}

TEST(MergeTails, ReturnsMergeIfThatSavesEnough) {
    const Items short_one = {jump(op::kJz, 1), item(0x04), item(0x0C), item(op::kRet),
                             label(1),         item(0x14), item(0x0C), item(op::kRet)};
    Items items = short_one;
    uint32_t next = 2;
    merge_tails(items, next);
    EXPECT_EQ(text_of(items), text_of(short_one));
    items = {jump(op::kJz, 1),
             number(op::kSta, 0x9000),
             number(op::kLda, 0x9001),
             item(op::kRet),
             label(1),
             item(0x14),
             number(op::kSta, 0x9000),
             number(op::kLda, 0x9001),
             item(op::kRet)};
    merge_tails(items, next);
    EXPECT_EQ(text_of(items), "JZ a16; L:; STA a16; LDA a16; RET; L:; INR D; JMP a16");
}

TEST(MergeTails, HalfOfAPushAndPopIsNoTail) {
    Items items = {jump(op::kJz, 1),  item(op::kPushPsw), item(0x04),         item(op::kPopPsw),
                   jump(op::kJmp, 2), label(1),           item(op::kPushPsw), item(0x0C),
                   item(op::kPopPsw), label(2),           item(op::kRet)};
    const std::string before = text_of(items);
    uint32_t next = 3;
    merge_tails(items, next);
    EXPECT_EQ(text_of(items), before);
}

// -- Random code
// -----------------------------------------------------------------------------------

constexpr uint16_t kCode = 0x0100;
constexpr uint16_t kFrame = 0x8000;
constexpr uint16_t kData = 0x9000;

class RandomCode {
public:
    explicit RandomCode(uint64_t seed) : random_(seed) {}

    Items make() {
        const unsigned count = 8 + below(40);
        const unsigned labels = 1 + below(4);
        for (unsigned i = 0; i < count; ++i) {
            if (below(8) == 0 && next_label_ < labels) add(label(next_label_++));
            piece(labels);
        }
        while (next_label_ < labels) add(label(next_label_++));
        add(item(op::kRet));
        return items_;
    }

private:
    unsigned below(unsigned end) { return static_cast<unsigned>(random_() % end); }
    void add(const CodeItem& one) { items_.push_back(one); }
    Register any() { return kRegisters[below(7)]; }
    uint8_t pair(uint8_t opcode) { return static_cast<uint8_t>(opcode | below(3) << 4); }
    int32_t value() {
        constexpr std::array<int32_t, 6> kFavourites = {0, 1, 2, 0x7F, 0x80, 0xFF};
        return kFavourites[below(6)];
    }

    void piece(unsigned labels) {
        switch (below(16)) {
            case 0:
            case 1:
            case 2:
                return add(item(mov(any(), any())));
            case 3:
                return add(number(by_register(op::kMvi, any()), value()));
            case 4:
                return add(number(pair(op::kLxi), value() << 8 | value()));
            case 5:
                return add(slot(below(2) == 0 ? op::kLda : op::kSta, static_cast<int>(below(4))));
            case 6:
                return add(slot(below(2) == 0 ? op::kLhld : op::kShld, static_cast<int>(below(4))));
            case 7:
            case 8:
                return add(item(
                    static_cast<uint8_t>(0x80 | below(8) << 3 | static_cast<unsigned>(any()))));
            case 9:
                return add(number(static_cast<uint8_t>(0xC6 | below(8) << 3), value()));
            case 10:
                return add(item(below(2) == 0
                                    ? pair(op::kInx)
                                    : by_register(below(2) == 0 ? op::kInr : op::kDcr, any())));
            case 11:
                return through_pointer();
            case 12:
                if (below(2) == 0) {
                    constexpr std::array<uint8_t, 7> kOfA = {0x07, 0x0F, 0x17, 0x1F,
                                                             0x2F, 0x37, 0x3F};
                    return add(item(kOfA[below(7)]));
                }
                return add(item(below(2) == 0 ? op::kXchg : pair(op::kDad)));
            case 13:
                return add(number(op::kSta, kData + static_cast<int>(below(4))));
            case 14:
                return keep(labels);
            default:
                // Mostly forward, so that most programs end.
                if (below(4) == 0) return add(jump(jump_if(condition()), below(labels)));
                if (next_label_ < labels) {
                    const uint32_t to = next_label_ + below(labels - next_label_);
                    return add(jump(below(5) == 0 ? op::kJmp : jump_if(condition()), to));
                }
                if (below(3) == 0) add(item(0xC8));  // RZ
        }
    }
    Condition condition() { return static_cast<Condition>(std::array{0, 1, 2, 3, 6, 7}[below(6)]); }

    void through_pointer() {
        add(slot(by_pair(op::kLxi, Pair::hl), static_cast<int>(below(3))));
        if (below(2) == 0) add(item(by_pair(op::kInx, Pair::hl)));
        switch (below(4)) {
            case 0:
                return add(item(mov_from_memory(any())));
            case 1:
                return add(item(mov_to_memory(kRegisters[below(7)])));
            case 2:
                return add(item(static_cast<uint8_t>(0x86 | below(8) << 3)));
            default:
                return add(item(0x34));  // INR M
        }
    }

    void keep(unsigned labels) {
        const auto which = static_cast<uint8_t>(below(4) << 4);
        add(item(static_cast<uint8_t>(op::kPush | which)));
        for (unsigned i = below(4); i > 0; --i) {
            const std::size_t before = items_.size();
            piece(labels);
            // No way in or out between.
            while (items_.size() > before && leaves(items_.back())) items_.pop_back();
        }
        add(item(static_cast<uint8_t>(op::kPop | which)));
    }
    static bool leaves(const CodeItem& one) {
        return one.operand.kind == CodeOperand::Kind::label || (one.opcode & 0xC7) == 0xC0;
    }

    std::mt19937_64 random_;
    Items items_;
    uint32_t next_label_ = 0;
};

void place(const Items& items, host_sim::FlatMachine& machine) {
    std::map<uint32_t, uint16_t> labels;
    for (const bool write : {false, true}) {
        uint16_t at = kCode;
        for (const CodeItem& one : items) {
            if (one.kind == CodeItem::Kind::label) labels[one.operand.id] = at;
            if (one.kind != CodeItem::Kind::instruction) continue;
            const unsigned size = toolchain::isa::instruction(one.opcode).bytes;
            int32_t value = one.operand.offset;
            if (one.operand.kind == CodeOperand::Kind::frame) value += kFrame;
            if (one.operand.kind == CodeOperand::Kind::label && write) {
                value = labels.at(one.operand.id);
            }
            if (write) {
                machine.memory.bytes[at] = one.opcode;
                if (size > 1) machine.memory.bytes[at + 1U] = static_cast<uint8_t>(value);
                if (size > 2) machine.memory.bytes[at + 2U] = static_cast<uint8_t>(value >> 8);
            }
            at = static_cast<uint16_t>(at + size);
        }
    }
}

struct Result {
    bool ended = false;
    std::array<uint8_t, 8> registers{};
    std::array<uint8_t, 4> data{};
    uint64_t t = 0;
};

Result run(const Items& items, uint64_t seed) {
    host_sim::FlatMachine machine{host_sim::InstructionSet::documented};
    std::mt19937 random(static_cast<uint32_t>(seed));
    for (uint8_t& byte : machine.memory.bytes) byte = 0;
    for (uint32_t i = 0; i < kSlots; ++i) {
        machine.memory.bytes[kFrame + i] = static_cast<uint8_t>(random());
    }
    machine.memory.bytes[0] = op::kHlt;  // where it returns to
    place(items, machine);
    host_sim::CpuState& cpu = machine.cpu;
    cpu.pc = kCode;
    cpu.sp = 0xF000;
    cpu.b = static_cast<uint8_t>(random()), cpu.c = static_cast<uint8_t>(random());
    cpu.d = static_cast<uint8_t>(random()), cpu.e = static_cast<uint8_t>(random());
    cpu.h = static_cast<uint8_t>(random()), cpu.l = static_cast<uint8_t>(random());
    cpu.a = static_cast<uint8_t>(random());
    Result result;
    result.ended = machine.run(20'000) == host_sim::RunEnd::halted;
    result.registers = {cpu.b, cpu.c, cpu.d, cpu.e, cpu.h, cpu.l, 0, cpu.a};
    for (unsigned i = 0; i < 4; ++i) result.data[i] = machine.memory.bytes[kData + i];
    result.t = cpu.t;
    return result;
}

TEST(Cleanup, RandomCodeComputesTheSame) {
    constexpr uint64_t kPrograms = 20'000;
    constexpr uint64_t kStates = 4;
    unsigned compared = 0;
    uint64_t before_t = 0;
    uint64_t after_t = 0;
    for (uint64_t seed = 1; seed <= kPrograms; ++seed) {
        const Items before = RandomCode(seed).make();
        const auto wanted = static_cast<RegisterSet>(seed * 2654435761U >> 8 & 0xBFU);
        Items after = before;
        clean_up(after, kSlots, wanted);
        improve(after);
        load_early(after, wanted);
        improve(after);
        uint32_t next_label = 100;
        merge_tails(after, next_label);
        improve(after);
        take_short_forms(after, wanted);
        for (uint64_t state = 0; state < kStates; ++state) {
            const Result expected = run(before, seed + state);
            if (!expected.ended) continue;
            const Result seen = run(after, seed + state);
            ASSERT_TRUE(seen.ended) << "seed " << seed;
            ASSERT_EQ(seen.data, expected.data) << "seed " << seed << '\n'
                                                << text_of(before) << '\n'
                                                << text_of(after);
            for (const Register which : kRegisters) {
                if ((wanted & set_of(which)) == 0) continue;
                const auto number = static_cast<unsigned>(which);
                ASSERT_EQ(seen.registers[number], expected.registers[number])
                    << "seed " << seed << " register " << number << '\n'
                    << text_of(before) << '\n'
                    << text_of(after);
            }
            ++compared;
            before_t += expected.t;
            after_t += seen.t;
        }
    }
    EXPECT_GT(compared, kPrograms * kStates * 9 / 10);
    EXPECT_LT(after_t, before_t);
}

}  // namespace
