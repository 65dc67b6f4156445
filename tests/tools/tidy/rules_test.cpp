#include "tools/tidy/rules.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <fstream>
#include <iterator>

namespace {

using testing::HasSubstr;

const char* const kSmallTable = R"(
[limits]
line_length = 10
line_length_files = [".cpp"]
generated_mark = "made by"
[includes]
directories = [""]
[mirror]
paths = ["a/"]
)";

std::string message_of(const std::string& toml) {
    try {
        tidy::parse_rules(toml);
    } catch (const tidy::RuleError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(ParseRules, TheTableOfTheRepositoryIsValid) {
    std::ifstream in(ROVER_SOURCE_DIR "/tools/tidy/rules.toml");
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    const tidy::Rules rules = tidy::parse_rules(text);
    EXPECT_EQ(rules.line_length, 100);
    EXPECT_EQ(tidy::longest_match(rules.function_limits, "firmware/core/a.hpp")->lines, 50);
    EXPECT_EQ(tidy::longest_match(rules.function_limits, "tools/a.cpp")->lines, 70);
}

TEST(ParseRules, ErrorsNameTheLine) {
    EXPECT_THAT(message_of("[limits\n"), HasSubstr("line 1"));
    EXPECT_THAT(message_of(std::string(kSmallTable) + "[[forbid]]\nrule = 'x'\n"),
                HasSubstr("line 10: missing or mistyped key 'pattern'"));
    EXPECT_THAT(message_of(std::string(kSmallTable) +
                           "[[forbid]]\nrule = 'x'\npattern = '('\npaths = ['']\nmessage = ''\n"),
                HasSubstr("line 10: bad pattern"));
    EXPECT_THAT(message_of("[limits]\nline_length = 'a'\n"), HasSubstr("'line_length'"));
}

TEST(ParseRules, AnExemptionNeedsAReason) {
    EXPECT_THAT(
        message_of(std::string(kSmallTable) + "[[exempt]]\npath = 'a'\nrule = 'b'\nreason = ''\n"),
        HasSubstr("an exemption needs a reason"));
}

TEST(LongestMatch, PrefersTheDeeperPath) {
    const std::vector<tidy::FunctionLimit> limits = {{"", 1}, {"a/b/", 3}, {"a/", 2}};
    EXPECT_EQ(tidy::longest_match(limits, "a/b/c")->lines, 3);
    EXPECT_EQ(tidy::longest_match(limits, "a/c")->lines, 2);
    EXPECT_EQ(tidy::longest_match(limits, "c")->lines, 1);
    EXPECT_EQ(tidy::longest_match(std::vector<tidy::FunctionLimit>{{"a/", 1}}, "b"), nullptr);
}

TEST(ApplyExemptions, RemovesWhatTheyCoverAndNothingElse) {
    tidy::Rules rules;
    rules.exemptions = {{"a/b.hpp", "r", "why"}, {"c/", "r", "why"}};
    const auto left = tidy::apply_exemptions(
        {{"a/b.hpp", 1, "r", ""}, {"a/b.hpp", 2, "s", ""}, {"c/d.hpp", 3, "r", ""}}, rules);
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0].line, 2);
}

TEST(ApplyExemptions, AnExemptionThatCoversNothingIsReported) {
    tidy::Rules rules;
    rules.exemptions = {{"a/b.hpp", "r", "why"}};
    const auto left = tidy::apply_exemptions({}, rules);
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0].rule, "stale-exemption");
    EXPECT_EQ(left[0].file, "a/b.hpp");
}

}  // namespace
