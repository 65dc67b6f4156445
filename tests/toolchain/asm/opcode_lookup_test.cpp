// opcode_lookup_test.cpp - every entry is found by its own text; opcodes from Intel's table.
#include "toolchain/asm/opcode_lookup.hpp"

#include <gtest/gtest.h>

#include "toolchain/asm/source_lines.hpp"

namespace {

using namespace toolchain::assembly;

const toolchain::isa::Instruction* find(std::string_view mnemonic,
                                        const std::vector<std::string>& operands) {
    return find_instruction(mnemonic, operands,
                            [](std::string_view text) { return std::stoi(std::string(text)); });
}

TEST(OpcodeLookup, ByHand) {
    EXPECT_EQ(find("MOV", {"b", "M"})->opcode, 0x46);
    EXPECT_EQ(find("LXI", {"SP", "stack+2"})->opcode, 0x31);
    EXPECT_EQ(find("RST", {"7"})->opcode, 0xFF);
    EXPECT_EQ(find("JX5", {"away"})->opcode, 0xFD);
    EXPECT_EQ(find("CALL", {"\"b\""})->opcode, 0xCD);
    EXPECT_EQ(find("LDIR", {}), nullptr);
    EXPECT_THROW((void)find("MOV", {"M", "M"}), Mistake);
    EXPECT_THROW((void)find("MVI", {"B", "C"}), Mistake);
    EXPECT_THROW((void)find("RET", {"1"}), Mistake);
}

TEST(OpcodeLookup, EveryEntryIsFoundByItsOwnText) {
    for (const auto& entry : toolchain::isa::instruction_set()) {
        const SourceLine line = split_line(entry.text());  // placeholders are names like d16
        const auto* found = find(line.operation, line.operands);
        ASSERT_NE(found, nullptr) << entry.text();
        EXPECT_EQ(found->opcode, entry.opcode) << entry.text();
    }
}

}  // namespace
