// reach_test.cpp - who defines what and who needs whom.
#include "toolchain/asm/reach.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

constexpr std::string_view kChain =
    "SECTION s0,code\nf: CALL g\nSECTION s1,code\ng: LDA alias\nSECTION s2,zero\nv: DS 2\n"
    "SECTION s3,code\nk: CALL f\n";

TEST(Reach, FollowsReferencesAndEquates) {
    std::vector<Module> modules = {module_of(kChain), module_of("SECTION s4,code\nRET\n")};
    modules[0].equates.push_back({"alias", {"v", 1}, {}});
    const NameIndex index(modules);
    const std::vector<std::string> roots = {"f"};
    EXPECT_EQ(index.reachable(roots, [](const Section&) { return false; }),
              (std::vector<bool>{true, true, true, false, false}));
    EXPECT_EQ(index.reachable(roots, [](const Section& section) { return section.name == "s1"; }),
              (std::vector<bool>{true, false, false, false, false}));
    EXPECT_EQ(index.section_of("alias"), 2u);
    EXPECT_EQ(index.section_of("nobody"), std::nullopt);
    EXPECT_EQ(index.equate("alias")->value.offset, 1);
    EXPECT_EQ(index.equate("v"), nullptr);
    EXPECT_EQ(&index.module_of(4), &modules[1]);
}

TEST(Reach, EquatesInACircleEnd) {
    Module module;
    module.equates = {{"x", {"y"}, {}}, {"y", {"x"}, {}}};
    const std::vector<Module> modules = {module};
    EXPECT_EQ(NameIndex(modules).section_of("x"), std::nullopt);
}

TEST(Reach, NamesDefinedTwice) {
    Module second = module_of("\n\nf: NOP\n");
    second.files = {"u.s85"};
    const std::vector<Module> modules = {module_of(kChain), second};
    EXPECT_EQ(errors_of([&] { const NameIndex index(modules); }),
              "u.s85:3: 'f' is defined twice; first in t.s85:2");
    Section section;
    section.name = "s";
    section.items = {label(".x"), label(".x")};
    const std::vector<Module> local = {{"m", {}, {section}, {}}};
    EXPECT_EQ(errors_of([&] { const NameIndex index(local); }),
              "m: '.x' is defined twice in section 's'");
}

}  // namespace
