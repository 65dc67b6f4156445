// object_test.cpp - sizes of items, names, messages. Sizes are from Intel's opcode table.
#include "toolchain/asm/object.hpp"

#include <gtest/gtest.h>

namespace {

using namespace toolchain::assembly;

TEST(Object, SizesOfItems) {
    EXPECT_EQ(item_size(instruction(0x00)), 1u);            // NOP
    EXPECT_EQ(item_size(instruction(0x3E, {"", 5})), 2u);   // MVI A
    EXPECT_EQ(item_size(instruction(0xCD, {"away"})), 3u);  // CALL
    EXPECT_EQ(item_size(data_bytes({1, 2, 3, 4})), 4u);
    EXPECT_EQ(item_size(data_byte({"x", 0, Part::low})), 1u);
    EXPECT_EQ(item_size(data_word({"x"})), 2u);
    EXPECT_EQ(item_size(space(300)), 300u);
    EXPECT_EQ(item_size(label("x", LabelKind::data, 9)), 0u);
    EXPECT_EQ(item_size(note("loop 4")), 0u);

    Section section;
    section.items = {label("x"), instruction(0xCD, {"away"}), space(7)};
    EXPECT_EQ(section_size(section), 10u);
}

TEST(Object, ReferencesAreOperandsAndNotLabels) {
    EXPECT_EQ(reference_of(instruction(0xCD, {"away"})), "away");
    EXPECT_EQ(reference_of(data_word({"table", 2})), "table");
    EXPECT_EQ(reference_of(label("here")), "");
    EXPECT_EQ(reference_of(instruction(0x3E, {"", 5})), "");
}

TEST(Object, KindsAndLocalNames) {
    EXPECT_EQ(kind_name(SectionKind::persistent), "persistent");
    EXPECT_TRUE(is_local(".loop"));
    EXPECT_TRUE(is_local("?1"));
    EXPECT_FALSE(is_local("mul.cells"));
    EXPECT_FALSE(is_local(""));
    EXPECT_TRUE(in_rom(SectionKind::constant));
    EXPECT_FALSE(in_rom(SectionKind::initialised));
}

TEST(Object, AnErrorSaysEveryMistake) {
    const Error error({{"a.s85", 3, "one"}, {"a.s85", 0, "two"}, {"", 0, "three"}});
    EXPECT_STREQ(error.what(), "a.s85:3: one\na.s85: two\nthree");
    EXPECT_EQ(error.diagnostics().size(), 3u);
}

}  // namespace
