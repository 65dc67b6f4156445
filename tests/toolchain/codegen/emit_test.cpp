// Functions and variables as sections: what the assembler would print of them.
#include "toolchain/codegen/emit.hpp"

#include <gtest/gtest.h>

#include <string>

namespace {

using namespace toolchain::codegen;
using toolchain::assembly::Item;
using toolchain::assembly::ItemKind;
using toolchain::assembly::Section;
using toolchain::assembly::SectionKind;

CodeItem instruction(uint8_t opcode, CodeOperand operand = {}, uint32_t line = 0) {
    CodeItem item;
    item.opcode = opcode;
    item.operand = operand;
    item.file = line == 0 ? kNone : 0;
    item.line = line;
    return item;
}

TEST(Emit, CodeOfAFunction) {
    Module module;
    module.files = {"t.c"};
    Function function;
    function.symbol = module.intern("_Z4stepi");
    const SymbolId table = module.intern(".str");
    using Kind = CodeOperand::Kind;
    using Part = CodeOperand::Part;
    FunctionCode code;
    code.items = {
        instruction(0x3A, {Kind::frame, Part::word, 0, 3}, 7),
        {CodeItem::Kind::loop_bound, 0, {Kind::number, Part::word, 0, 16}},
        {CodeItem::Kind::label, 0, {Kind::label, Part::word, 4, 0}},
        instruction(0x3E, {Kind::symbol, Part::high, table, 2}),
        instruction(0xC3, {Kind::label, Part::word, 4, 0}, 8),
        {CodeItem::Kind::word, 0, {Kind::label, Part::word, 4, 0}},
    };
    const Section section = code_section(module, SafeNames(module), function, code);
    EXPECT_EQ(section.name, "_Z4stepi");
    EXPECT_EQ(section.function, "_Z4stepi");
    EXPECT_EQ(section.title, "step(int)");
    EXPECT_EQ(section.location, (toolchain::assembly::Location{0, 7}));
    ASSERT_EQ(section.items.size(), 7U);
    EXPECT_EQ(section.items[0].operand.symbol, "_Z4stepi");
    EXPECT_EQ(section.items[1].operand.symbol, "_Z4stepi@frame");
    EXPECT_EQ(section.items[1].operand.offset, 3);
    EXPECT_EQ(section.items[1].location.line, 7U);
    EXPECT_EQ(section.items[2].text, "loop 16");
    EXPECT_EQ(section.items[3].operand.symbol, ".4");
    EXPECT_EQ(section.items[4].operand.symbol, "_.str");
    EXPECT_EQ(section.items[4].operand.part, toolchain::assembly::Part::high);
    EXPECT_EQ(section.items[4].operand.offset, 2);
    EXPECT_FALSE(section.items[4].location.known());
    EXPECT_EQ(section.items[5].operand.symbol, ".4");
    EXPECT_EQ(section.items[6].kind, ItemKind::word);
    EXPECT_EQ(section_size(section), 3U + 2 + 3 + 2);
}

TEST(Emit, AFrameHasSlotsAndObjects) {
    Module module;
    Function function;
    function.symbol = module.intern("f");
    function.frame = {{module.intern("f@args"), 8}, {module.intern("f@frame.0"), 5}};
    FunctionCode code;
    code.frame_bytes = 3;
    const Section frame = frame_section(SafeNames(module), function, code);
    EXPECT_EQ(frame.kind, SectionKind::frame);
    EXPECT_EQ(frame.name, "f@frame");
    EXPECT_EQ(frame.function, "f");
    EXPECT_EQ(section_size(frame), 16U);
    ASSERT_EQ(frame.items.size(), 6U);
    EXPECT_EQ(frame.items[0].operand.symbol, "f@args");
    EXPECT_EQ(frame.items[2].operand.symbol, "f@frame.0");
    EXPECT_EQ(frame.items[4].operand.symbol, "f@frame");
    EXPECT_EQ(section_size(frame_section(SafeNames(module), Function{.symbol = 0}, {})), 0U);
}

// By hand: c at 0, gap up to 4, b at 4, a at 10, slots at 11.
TEST(Emit, TheMostAlignedObjectsOfAFrameComeFirst) {
    Module module;
    Function function;
    function.symbol = module.intern("f");
    function.frame = {
        {module.intern("a"), 1, 1}, {module.intern("b"), 6, 4}, {module.intern("c"), 3, 8}};
    FunctionCode code;
    code.frame_bytes = 2;
    const FrameLayout layout = frame_layout(function, code);
    EXPECT_EQ(layout.offsets, (std::vector<uint32_t>{0, 4, 10}));
    EXPECT_EQ(layout.alignment, 8U);
    EXPECT_EQ(layout.size, 13U);
    const Section frame = frame_section(SafeNames(module), function, code);
    EXPECT_EQ(frame.alignment, 8U);
    EXPECT_EQ(section_size(frame), 13U);
    EXPECT_EQ(frame.items[0].operand.symbol, "c");
    EXPECT_EQ(frame.items[2].size, 1U);
    EXPECT_EQ(frame.items[3].operand.symbol, "b");
}

TEST(Emit, CodeIsAlignedIfItsAddressIsTaken) {
    Module module;
    Function function;
    function.symbol = module.intern("f");
    function.alignment = 2;
    EXPECT_EQ(code_section(module, SafeNames(module), function, {}).alignment, 1U);
    function.address_taken = true;
    EXPECT_EQ(code_section(module, SafeNames(module), function, {}).alignment, 2U);
}

class EmitVariable : public testing::Test {
protected:
    Module module;
    Variable variable;

    void SetUp() override {
        variable.symbol = module.intern("v");
        variable.size = 4;
    }
    Section section() { return variable_section(module, SafeNames(module), variable); }
};

TEST_F(EmitVariable, GoesWhereItBelongs) {
    EXPECT_EQ(section().kind, SectionKind::zero);
    variable.initial.assign(4, Datum{});
    EXPECT_EQ(section().kind, SectionKind::zero);
    variable.initial[2].value = 1;
    EXPECT_EQ(section().kind, SectionKind::initialised);
    variable.is_constant = true;
    EXPECT_EQ(section().kind, SectionKind::constant);
    EXPECT_EQ(section_size(section()), 4U);
    variable.initial.clear();
    EXPECT_EQ(section().kind, SectionKind::constant);
    EXPECT_EQ(section_size(section()), 4U);
    variable.symbol = module.intern("__args@p8r0");
    EXPECT_EQ(section().kind, SectionKind::persistent);
}

TEST_F(EmitVariable, AddressesAreWordsAndHalvesAreBytes) {
    const SymbolId other = module.intern("other");
    variable.size = 6;
    variable.initial = {Datum{7, kNone, 0, false}, Datum{0, other, 5, false},
                        Datum{0, other, 5, true},  Datum{0, other, 1, true},
                        Datum{0, other, 2, false}, Datum{9, kNone, 0, false}};
    const Section made = section();
    ASSERT_EQ(made.items.size(), 6U);
    EXPECT_EQ(made.items[1].bytes, std::vector<uint8_t>{7});
    EXPECT_EQ(made.items[2].kind, ItemKind::word);
    EXPECT_EQ(made.items[2].operand.offset, 5);
    EXPECT_EQ(made.items[3].kind, ItemKind::byte);
    EXPECT_EQ(made.items[3].operand.part, toolchain::assembly::Part::high);
    EXPECT_EQ(made.items[4].operand.part, toolchain::assembly::Part::low);
    EXPECT_EQ(made.items[5].bytes, std::vector<uint8_t>{9});
    EXPECT_EQ(section_size(made), 6U);
}

TEST_F(EmitVariable, WhatHasNoInitialValueIsZero) {
    variable.initial = {Datum{3, kNone, 0, false}};
    EXPECT_EQ(section_size(section()), 4U);
}

}  // namespace
