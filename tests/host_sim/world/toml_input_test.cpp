// toml_input_test.cpp - typed, ranged access to TOML tables, every refusal with its line.
#include "host_sim/world/toml_input.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace host_sim {
namespace {

const char* const kText =
    "word = \"hello\"\n"
    "count = 3\n"
    "ratio = 0.5\n"
    "list = [1, 2.5]\n"
    "flag = true\n"
    "[inner]\n"
    "deep = -7\n";

std::string error_of(const std::function<void(const TomlTable&)>& use) {
    const toml::table parsed = parse_toml(kText, "f.toml");
    try {
        use(TomlTable(parsed, "f.toml", ""));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(TomlTable, GivesValuesInRange) {
    const toml::table parsed = parse_toml(kText, "f.toml");
    const TomlTable root(parsed, "f.toml", "");
    EXPECT_EQ(root.text("word"), "hello");
    EXPECT_EQ(root.integer("count", 0, 3), 3);
    EXPECT_EQ(root.number("count", 3, 3), 3);
    EXPECT_EQ(root.number("ratio", 0, 1), 0.5);
    EXPECT_EQ(root.numbers("list", 0, 3), (std::vector<double>{1, 2.5}));
    EXPECT_EQ(root.table("inner").integer("deep", -10, 0), -7);
    EXPECT_EQ(root.optional_number("none", 0, 1), std::nullopt);
    EXPECT_EQ(root.optional_number("ratio", 0, 1), 0.5);
}

TEST(TomlTable, RefusesWithLineAndKey) {
    const struct {
        std::function<void(const TomlTable&)> use;
        const char* expected;
    } cases[] = {
        {[](const TomlTable& t) { (void)t.number("ratio", 1, 2); }, "f.toml:3: 'ratio' must be"},
        {[](const TomlTable& t) { (void)t.number("flag", 0, 2); }, "f.toml:5: 'flag' must be"},
        {[](const TomlTable& t) { (void)t.number("word", 0, 2); }, "f.toml:1: 'word' must be"},
        {[](const TomlTable& t) { (void)t.integer("ratio", 0, 1); },
         "f.toml:3: 'ratio' must be a whole"},
        {[](const TomlTable& t) { (void)t.numbers("list", 0, 2); }, "f.toml:4: 'list' must be"},
        {[](const TomlTable& t) { (void)t.numbers("ratio", 0, 2); },
         "f.toml:3: 'ratio' must be a list"},
        {[](const TomlTable& t) { (void)t.text("count"); }, "f.toml:2: 'count' must be a text"},
        {[](const TomlTable& t) { (void)t.table("count"); }, "f.toml:2: 'count' must be a table"},
        {[](const TomlTable& t) { (void)t.text("none"); }, "'none' is missing"},
        {[](const TomlTable& t) { (void)t.optional_number("ratio", 2, 3); }, "f.toml:3:"},
        {[](const TomlTable& t) { (void)t.table("inner").number("deep", 0, 1); },
         "f.toml:7: 'inner.deep' must be"},
        {[](const TomlTable& t) { t.table("inner").allow_only({"other"}); },
         "f.toml:7: 'inner.deep' is not known here; allowed: other"},
    };
    for (const auto& one : cases) {
        const std::string message = error_of(one.use);
        EXPECT_NE(message.find(one.expected), std::string::npos) << one.expected << ": " << message;
    }
    EXPECT_EQ(error_of([](const TomlTable& t) {
                  t.allow_only({"word", "count", "ratio", "list", "flag", "inner"});
              }),
              "no error");
}

TEST(ParseToml, SaysWhereTheTextIsNotToml) {
    try {
        parse_toml("a = 1\nb = = 2\n", "f.toml");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find("f.toml:2: not valid TOML"), 0u) << error.what();
    }
}

}  // namespace
}  // namespace host_sim
