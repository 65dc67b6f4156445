#include "tools/tidy/markdown.hpp"

#include <gtest/gtest.h>

namespace {

TEST(LinkTargets, FindsInlineLinksWithTheirLines) {
    const auto links = tidy::link_targets("# A\nsee [b](b.md) and [c](c/d.md#e \"title\")\n");
    ASSERT_EQ(links.size(), 2u);
    EXPECT_EQ(links[0].line, 2);
    EXPECT_EQ(links[0].text, "b.md");
    EXPECT_EQ(links[1].text, "c/d.md#e");
}

TEST(LinkTargets, IgnoresCode) {
    EXPECT_TRUE(tidy::link_targets("```\n[b](b.md)\n```\n`[c](c.md)`\n").empty());
}

// The rule GitHub applies: lower case, blanks to hyphens, punctuation dropped.
TEST(HeadingAnchors, AreFormedAsGithubForms) {
    const auto anchors = tidy::heading_anchors("# What it is\n## Q formats, units & names\n#no\n");
    EXPECT_EQ(anchors, (std::vector<std::string>{"what-it-is", "q-formats-units--names"}));
}

TEST(CommandPrograms, AreTheFirstWordsOfCommandLinesInCode) {
    const auto programs = tidy::command_programs(
        "Use `./tools/no`.\n```\n./tools/run --seed 1\n$ build/bin/rover85 sweep\nls\n```\n");
    ASSERT_EQ(programs.size(), 2u);
    EXPECT_EQ(programs[0].line, 3);
    EXPECT_EQ(programs[0].text, "./tools/run");
    EXPECT_EQ(programs[1].text, "build/bin/rover85");
}

}  // namespace
