// replace_test.cpp - sections that stand in for others of the same names.
#include "toolchain/asm/replace.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

TEST(Replace, SectionsOfTheSameNameGiveWayAndNewOnesCome) {
    std::vector<Module> modules = {
        module_of("        SECTION one,code\none: NOP\n        RET\n"
                  "        SECTION two,code\ntwo: RET\n")};
    std::vector<Module> by;
    by.push_back(
        module_of("        SECTION one,code\none: RET\n"
                  "        SECTION three,code\nthree: RET\n"));
    replace_sections(modules, std::move(by));
    ASSERT_EQ(modules.size(), 2U);
    ASSERT_EQ(modules[0].sections.size(), 1U);
    EXPECT_EQ(modules[0].sections[0].name, "two");
    ASSERT_EQ(modules[1].sections.size(), 2U);
    EXPECT_EQ(modules[1].sections[0].name, "one");
    EXPECT_EQ(section_size(modules[1].sections[0]), 1U);
    EXPECT_EQ(modules[1].sections[1].name, "three");
}

}  // namespace
