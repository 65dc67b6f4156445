// clone_test.cpp - copies of routines for interrupts.
#include "toolchain/asm/clone.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

constexpr std::string_view kRoutines = R"(
        SECTION mul,code,FUNCTION mul
mul:    SHLD  mul.cells
.loop:  CALL  add
        LXI   H,table
        LDA   mode
        LDA   total
        JMP   .loop
        SECTION mul.cells,persistent
mul.cells: DS 2
        SECTION add,code
add:    CALL  add
        RET
        SECTION table,constant
table:  DW    add
        SECTION mode,initialised
mode:   DB    1
        SECTION total,zero
total:  DS    2
        SECTION isr,code
isr:    CALL  mul
        RET
)";

TEST(Clone, CopiesCodeAndCellsAndRenames) {
    const std::vector<Module> modules = {module_of(kRoutines)};
    const std::vector<std::string> roots = {"mul"};
    const Clones clones = clone_sections(modules, roots, ".isr", {"total"});
    ASSERT_EQ(clones.module.sections.size(), 3u);
    const Section& mul = clones.module.sections[0];
    EXPECT_EQ(mul.name, "mul.isr");
    EXPECT_EQ(mul.function, "mul.isr");
    EXPECT_EQ(mul.items[0].operand.symbol, "mul.isr");
    EXPECT_EQ(mul.items[1].operand.symbol, "mul.cells.isr");
    EXPECT_EQ(mul.items[2].operand.symbol, ".loop");
    EXPECT_EQ(mul.items[3].operand.symbol, "add.isr");
    EXPECT_EQ(mul.items[4].operand.symbol, "table");
    EXPECT_EQ(mul.items[5].operand.symbol, "mode");
    EXPECT_EQ(mul.items[6].operand.symbol, "total");
    EXPECT_EQ(clones.module.sections[1].name, "mul.cells.isr");
    EXPECT_EQ(clones.module.sections[2].items[1].operand.symbol, "add.isr");
    EXPECT_EQ(clones.renaming.size(), 3u);
}

TEST(Clone, BothCopiesLinkSideBySide) {
    std::vector<Module> modules = {module_of(kRoutines)};
    const std::vector<std::string> roots = {"mul"};
    Clones clones = clone_sections(modules, roots, ".isr", {"total"});
    for (Section& section : modules[0].sections) {
        if (section.name == "isr") rename_references(section, clones.renaming);
    }
    modules.push_back(clones.module);
    const Program program = link(modules, rooted({"mul", "isr"}));
    const auto mul = static_cast<std::size_t>(value_of(program, "mul"));
    const auto copy = static_cast<std::size_t>(value_of(program, "mul.isr"));
    const auto isr = static_cast<std::size_t>(value_of(program, "isr"));
    EXPECT_NE(mul, copy);
    EXPECT_EQ(bytes_at(program, isr + 1, 2),
              (Bytes{static_cast<uint8_t>(copy), static_cast<uint8_t>(copy >> 8)}));
    EXPECT_NE(bytes_at(program, mul, 3), bytes_at(program, copy, 3));          // own cells
    EXPECT_EQ(bytes_at(program, mul + 6, 9), bytes_at(program, copy + 6, 9));  // shared data
}

TEST(Clone, AnUnknownRootIsRefused) {
    const std::vector<Module> modules = {module_of(kRoutines)};
    const std::vector<std::string> roots = {"sub"};
    EXPECT_EQ(errors_of([&] { (void)clone_sections(modules, roots, ".isr"); }),
              "'sub' is to be cloned, but no module defines it");
}

}  // namespace
