#include "tools/report/escape.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace {

using report::html;
using report::script_json;

TEST(Html, MarkupBecomesText) {
    EXPECT_EQ(html("<b a=\"1\" c='2'>&amp;</b>"),
              "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp;amp;&lt;/b&gt;");
}

TEST(Html, ControlCharactersAreDroppedButTabAndLineFeedStay) {
    EXPECT_EQ(html(std::string("a\0b\x01\x1b[31m\t\n\x7f", 11)), "ab[31m\t\n");
}

TEST(Html, Utf8PassesUnchanged) {
    EXPECT_EQ(html("25 °C, 3 µm"), "25 °C, 3 µm");
}

TEST(ScriptJson, NoCharacterThatCouldEndTheScriptElement) {
    for (const char* text : {"</script><script>alert(1)</script>", "<!--", "]]>", "&lt;"}) {
        const std::string literal = script_json(text);
        EXPECT_EQ(literal.find_first_of("<>&"), std::string::npos) << literal;
        EXPECT_EQ(nlohmann::json::parse(literal).get<std::string>(), text);
    }
}

TEST(ScriptJson, LineSeparatorsAreEscaped) {
    EXPECT_EQ(script_json("a\u2028b\u2029"), "\"a\\u2028b\\u2029\"");
}

TEST(ScriptJson, BytesThatAreNotUtf8BecomeTheReplacementCharacter) {
    EXPECT_EQ(nlohmann::json::parse(script_json("a\xff"
                                                "b"))
                  .get<std::string>(),
              "a\uFFFDb");
}

// All 256 bytes, alone and doubled: the result is always valid and safe.
TEST(ScriptJson, AnyByteIsSafe) {
    for (int byte = 0; byte < 256; ++byte) {
        for (const std::size_t count : {1u, 2u}) {
            const std::string literal = script_json(std::string(count, static_cast<char>(byte)));
            EXPECT_TRUE(nlohmann::json::accept(literal)) << byte;
            EXPECT_EQ(literal.find_first_of("<>&\n\r"), std::string::npos) << byte;
        }
    }
}

}  // namespace
