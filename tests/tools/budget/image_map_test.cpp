// image_map_test.cpp - a map file by hand, and what is refused.
#include "tools/budget/image_map.hpp"

#include <gtest/gtest.h>

#include "tests/tools/budget/sample_map.hpp"
#include "tools/budget/budget_error.hpp"

namespace {

using budget_test::kMap;
using rover_budget::BudgetError;
using rover_budget::ImageMap;

TEST(ParseMap, TakesWhatItKnows) {
    const ImageMap map = rover_budget::parse_map(kMap, "a.map");
    EXPECT_EQ(map.rom_used, 45u);
    EXPECT_EQ(map.ram_used, 20u);
    EXPECT_EQ(map.region("stack").first, 0xFEF8u);
    EXPECT_EQ(map.region("stack").size, 8u);
    ASSERT_EQ(map.sections.size(), 6u);
    EXPECT_EQ(map.sections[4].kind, "initialised");
    ASSERT_EQ(map.functions.size(), 2u);
    EXPECT_EQ(map.functions[0].stack_bytes, 6u);
    EXPECT_EQ(map.functions[1].stack_bytes, std::nullopt);
    EXPECT_THROW((void)map.region("data"), BudgetError);
}

TEST(ParseMap, RefusesWithFileAndLine) {
    const auto error_of = [](const std::string& text) -> std::string {
        try {
            (void)rover_budget::parse_map(text, "a.map");
        } catch (const BudgetError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_NE(error_of("").find("a.map:1: is no map file"), std::string::npos);
    const std::string first = "# rover85 map 1\n";
    for (const char* line : {"section 0000 00G0 code 0000 f", "section 0000 0010 code 0000",
                             "function 0000 rom 1 ram 0 t - stack 2 f", "region frames 0000",
                             "range ROM 0000 7FFF free 3 used 4"}) {
        EXPECT_EQ(error_of(first + line).substr(0, 8), "a.map:2:") << line;
    }
}

}  // namespace
