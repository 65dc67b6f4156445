// documents_test.cpp - JSON and the page: what stands in them.
#include "tools/budget/documents.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/budget/sample_figures.hpp"

namespace {

using budget_test::sample_review;
using testing::HasSubstr;
using testing::Not;

TEST(Json, HasTheInterfacesFieldsAndTheNumbers) {
    const auto document = nlohmann::json::parse(rover_budget::json_text(sample_review()));
    EXPECT_EQ(document["clock_hz"], 3'072'000);
    EXPECT_EQ(document["rom_bytes"], 1000);
    EXPECT_EQ(document["ram_bytes"], 300);
    EXPECT_EQ(document["stack_bytes"], 40);
    const auto& control = document["modules"][0];
    EXPECT_EQ(control["name"], "control");
    EXPECT_EQ(control["rom_bytes"], 600);
    EXPECT_EQ(control["ram_bytes"], 200);
    EXPECT_EQ(control["t_states_mean"], 400.0);
    EXPECT_EQ(control["t_states_worst"], 500);
    EXPECT_EQ(control["budget_t_states"], 500);
    EXPECT_TRUE(document["modules"][2]["budget_t_states"].is_null());
    EXPECT_EQ(rover_budget::parse_numbers(rover_budget::json_text(sample_review()), "x"),
              sample_review().numbers);
}

TEST(Html, IsOnePageWithoutANetworkAndWithoutMarkupFromNames) {
    const std::string html = rover_budget::html_text(sample_review());
    EXPECT_THAT(html, HasSubstr("<!doctype html>"));
    for (const char* outside : {"http", "src=", "href=", "@import", "<script", "url("}) {
        EXPECT_THAT(html, Not(HasSubstr(outside))) << outside;
    }
    EXPECT_THAT(html, Not(HasSubstr("<short>")));
    EXPECT_THAT(html, HasSubstr("&lt;short&gt; step 2"));
}

// 500 of 499: the bar's full length is 105 % of the larger one, 525: 95.24 %, the mark at 95.05 %.
TEST(Html, BarsShowValueAndLimit) {
    const std::string html = rover_budget::html_text(sample_review());
    EXPECT_THAT(html, HasSubstr("<div class=\"fill over\" style=\"width:95.24%\"></div>"
                                "<div class=\"mark\" style=\"left:95.05%\"></div>"));
}

}  // namespace
