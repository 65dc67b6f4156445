// tree_checks_test.cpp - the rules that look at all files together, on small invented trees.
#include "tools/tidy/tree_checks.hpp"

#include <gtest/gtest.h>
#include <fstream>
#include <iterator>

namespace {

using Files = std::vector<tidy::SourceFile>;
using Found = std::vector<std::string>;

const tidy::Rules& repository_rules() {
    static const tidy::Rules rules = [] {
        std::ifstream in(ROVER_SOURCE_DIR "/tools/tidy/rules.toml");
        return tidy::parse_rules(std::string{std::istreambuf_iterator<char>(in), {}});
    }();
    return rules;
}

Found names(const std::vector<tidy::Violation>& violations) {
    Found result;
    for (const tidy::Violation& violation : violations) {
        result.push_back(violation.file + ":" + std::to_string(violation.line) + ":" +
                         violation.rule);
    }
    return result;
}

Found includes(const Files& files) {
    return names(tidy::check_includes(files, repository_rules()));
}

/// The tree that has one include, from `from` to `to`.
Found include_from_to(const std::string& from, const std::string& to) {
    return includes({{from, "#include \"" + to + "\"\n"}, {to, ""}});
}

TEST(Layers, HalIncludesNothingElse) {
    EXPECT_EQ(include_from_to("hal/a.hpp", "hal/b.hpp"), Found{});
    EXPECT_EQ(include_from_to("hal/a.hpp", "firmware/b.hpp"), Found{"hal/a.hpp:1:layer"});
}

TEST(Layers, FirmwareIncludesHalOnly) {
    EXPECT_EQ(include_from_to("firmware/a.hpp", "hal/b.hpp"), Found{});
    EXPECT_EQ(include_from_to("firmware/a.hpp", "host_sim/b.hpp"), Found{"firmware/a.hpp:1:layer"});
    EXPECT_EQ(include_from_to("firmware/a.hpp", "tools/b.hpp"), Found{"firmware/a.hpp:1:layer"});
}

TEST(Layers, HostSimulationSeesOnlyTheOpenPartsOfFirmware) {
    for (const char* to : {"hal/a.hpp", "firmware/core/a.hpp", "firmware/config/a.hpp",
                           "firmware/executive/estimates.hpp", "host_sim/world/b.hpp"}) {
        EXPECT_EQ(include_from_to("host_sim/log/a.hpp", to), Found{}) << to;
    }
    EXPECT_EQ(include_from_to("host_sim/log/a.hpp", "firmware/estimation/a.hpp"),
              Found{"host_sim/log/a.hpp:1:layer"});
    EXPECT_EQ(include_from_to("host_sim/log/a.hpp", "tools/a.hpp"),
              Found{"host_sim/log/a.hpp:1:layer"});
}

TEST(Layers, BindAndCampaignSeeAllOfFirmware) {
    EXPECT_EQ(include_from_to("host_sim/bind/a.hpp", "firmware/estimation/a.hpp"), Found{});
    EXPECT_EQ(include_from_to("host_sim/campaign/a.hpp", "firmware/estimation/a.hpp"), Found{});
}

TEST(Layers, ToolchainStandsAloneAndToolsAndTestsSeeEverything) {
    EXPECT_EQ(include_from_to("toolchain/a.hpp", "hal/a.hpp"), Found{"toolchain/a.hpp:1:layer"});
    EXPECT_EQ(include_from_to("tools/a.hpp", "firmware/a.hpp"), Found{});
    EXPECT_EQ(include_from_to("tests/a.cpp", "host_sim/a.hpp"), Found{});
}

TEST(Includes, AreFoundBesideTheFileAndInTheIncludeDirectories) {
    EXPECT_EQ(includes({{"tools/a.cpp", "#include \"b.hpp\"\n"}, {"tools/b.hpp", ""}}), Found{});
    EXPECT_EQ(includes({{"firmware/a.hpp", "#include \"words.hpp\"\n"},
                        {"firmware/config/native/words.hpp", ""}}),
              Found{});
    EXPECT_EQ(includes({{"tools/a.cpp", "\n#include \"gone.hpp\"\n"}}),
              Found{"tools/a.cpp:2:include-path"});
    EXPECT_EQ(includes({{"tools/a.cpp", "// #include \"gone.hpp\"\n"}}), Found{});
    EXPECT_EQ(includes({{"tools/a.cpp", "#include \"firmware_identity.hpp\"\n"}}), Found{});
}

TEST(Includes, CyclesAreReportedOnceEach) {
    EXPECT_EQ(includes({{"hal/a.hpp", "#include \"hal/b.hpp\"\n"},
                        {"hal/b.hpp", "#include \"hal/c.hpp\"\n"},
                        {"hal/c.hpp", "#include \"hal/a.hpp\"\n"}}),
              Found{"hal/c.hpp:1:include-cycle"});
    EXPECT_EQ(includes({{"hal/a.hpp", "#include \"hal/a.hpp\"\n"}}),
              Found{"hal/a.hpp:1:include-cycle"});
    EXPECT_EQ(includes({{"hal/a.hpp", "#include \"hal/b.hpp\"\n#include \"hal/c.hpp\"\n"},
                        {"hal/b.hpp", "#include \"hal/c.hpp\"\n"},
                        {"hal/c.hpp", ""}}),
              Found{});
}

Found mirror(const Files& files) {
    return names(tidy::check_mirror(files, repository_rules()));
}

TEST(Mirror, CodeNeedsATestInTheMirroredFolder) {
    const tidy::SourceFile code{"firmware/core/a.hpp", "inline void f() {}\n"};
    const std::string include = "#include \"firmware/core/a.hpp\"\n";
    EXPECT_EQ(mirror({code}), Found{"firmware/core/a.hpp:0:mirror"});
    EXPECT_EQ(mirror({code, {"tests/firmware/core/a_test.cpp", include}}), Found{});
    EXPECT_EQ(mirror({code, {"tests/firmware/core/b_test.cpp", include}}), Found{});
    EXPECT_EQ(mirror({code, {"tests/firmware/core/a_test.cpp", ""}}),
              Found{"firmware/core/a.hpp:0:mirror"});
    EXPECT_EQ(mirror({code, {"tests/firmware/a_test.cpp", include}}),
              Found{"firmware/core/a.hpp:0:mirror"});
}

TEST(Mirror, ADeclarationCountsAndASourceBelongsToItsHeader) {
    EXPECT_EQ(mirror({{"tools/a.hpp", "void f();\n"}, {"tools/a.cpp", "void f() {}\n"}}),
              Found{"tools/a.hpp:0:mirror"});
    EXPECT_EQ(mirror({{"tools/part_of_a.cpp", "void f() {}\n"}}), Found{});
}

TEST(Mirror, DataAndTestsNeedNone) {
    EXPECT_EQ(mirror({{"hal/a.hpp", "struct S {\n    int a = 0;\n};\n"}}), Found{});
    EXPECT_EQ(mirror({{"tests/support/a.hpp", "inline void f() {}\n"}}), Found{});
}

Found pages(const Files& files) {
    return names(tidy::check_pages(files));
}

TEST(Pages, LinksLeadToTrackedFilesFoldersAndHeadings) {
    const Files others = {{"docs/b.md", "# A heading\n"}, {"tools/x/y.cpp", ""}};
    const auto page = [&](const std::string& text) {
        Files files = others;
        files.push_back({"docs/a.md", text});
        return pages(files);
    };
    EXPECT_EQ(page("[b](b.md) [c](b.md#a-heading) [d](../tools/x) [e](../tools/x/)\n"), Found{});
    EXPECT_EQ(page("# Own\n[f](#own) [g](https://example.org/x)\n"), Found{});
    EXPECT_EQ(page("[b](gone.md)\n"), Found{"docs/a.md:1:page-link"});
    EXPECT_EQ(page("\n[b](b.md#gone)\n"), Found{"docs/a.md:2:page-link"});
    EXPECT_EQ(page("[b](../../shared/data)\n"), Found{"docs/a.md:1:page-link"});
}

TEST(Pages, CommandsAreTrackedScriptsOrTargets) {
    const Files tree = {{"tools/run", ""}, {"tools/CMakeLists.txt", "add_executable(rover85 a)\n"}};
    const auto page = [&](const std::string& command) {
        Files files = tree;
        files.push_back({"README.md", "```\n" + command + "\n```\n"});
        return pages(files);
    };
    EXPECT_EQ(page("./tools/run --seed 1"), Found{});
    EXPECT_EQ(page("build/bin/rover85 sweep"), Found{});
    EXPECT_EQ(page("./tools/gone"), Found{"README.md:2:page-command"});
    EXPECT_EQ(page("build/bin/gone"), Found{"README.md:2:page-command"});
}

TEST(CheckTree, SortsByFileAndLine) {
    tidy::Rules rules = repository_rules();
    rules.exemptions.clear();
    const Files files = {{"hal/b.hpp", "// b.\n#pragma once\nint a;\nlong b;\n"},
                         {"hal/a.hpp", "// a.\n"}};
    const Found found = names(tidy::check_tree(files, rules));
    EXPECT_EQ(found, (Found{"hal/a.hpp:1:pragma-once", "hal/b.hpp:3:explicit-width",
                            "hal/b.hpp:4:explicit-width"}));
}

}  // namespace
