// flow_facts_test.cpp - lines of flow.csv.
#include "tools/bounds/flow_facts.hpp"

#include <gtest/gtest.h>

#include "tools/budget/budget_error.hpp"

namespace {

using rover_bounds::FlowTable;
using rover_bounds::LoopKind;
using rover_bounds::parse_flow;

TEST(FlowFacts, AFactIsASumThatIsAtMostANumber) {
    const FlowTable table =
        parse_flow("# comment\n\nfact,*::a(*#2 + 3 *b* + 1 <= 5 *::c() + 7,why, indeed\n", "f");
    ASSERT_EQ(table.facts.size(), 1U);
    const auto& fact = table.facts[0];
    ASSERT_EQ(fact.terms.size(), 3U);
    EXPECT_EQ(fact.terms[0].factor, 1);
    EXPECT_EQ(fact.terms[0].item.pattern, "*::a(*");
    EXPECT_EQ(fact.terms[0].item.loop, 2U);
    EXPECT_EQ(fact.terms[1].factor, 3);
    EXPECT_FALSE(fact.terms[1].item.loop);
    EXPECT_EQ(fact.terms[2].factor, -5);
    EXPECT_EQ(fact.most, 6);
    EXPECT_EQ(fact.line, 3U);
    EXPECT_EQ(fact.reason, "why, indeed");
}

TEST(FlowFacts, RulesOfLoops) {
    const FlowTable table = parse_flow("turns,f#1 9,a\nendless,g#2,b\nwaits,h#1,c\n", "f");
    ASSERT_EQ(table.loops.size(), 3U);
    EXPECT_EQ(table.loops[0].turns, 9U);
    EXPECT_EQ(table.loops[0].item.loop, 1U);
    EXPECT_EQ(table.loops[1].kind, LoopKind::endless);
    EXPECT_EQ(table.loops[2].kind, LoopKind::waits);
}

TEST(FlowFacts, APatternIsOfTheWholeName) {
    EXPECT_TRUE((rover_bounds::FlowItem{"*::f(*", {}}.fits("x::f(int)")));
    EXPECT_FALSE((rover_bounds::FlowItem{"*::f()", {}}.fits("x::f()::$_0")));
}

TEST(FlowFacts, WhatIsNoLineIsRefusedWithItsNumber) {
    const auto error = [](const char* line) -> std::string {
        try {
            (void)parse_flow(line, "flow.csv");
        } catch (const rover_budget::BudgetError& refused) {
            return refused.what();
        }
        return "accepted";
    };
    EXPECT_EQ(error("fact,a <= 1\n").find("flow.csv:1: has no reason"), 0U);
    EXPECT_EQ(error("\nwhat,a <= 1,b\n").find("flow.csv:2: begins with no known word"), 0U);
    EXPECT_EQ(error("fact,a + b,c\n").find("flow.csv:1: is no fact"), 0U);
    EXPECT_EQ(error("fact,a <= 1 <= 2,c\n").find("flow.csv:1: has two signs"), 0U);
    EXPECT_EQ(error("fact,a#x <= 1,c\n").find("flow.csv:1: has a loop without a number"), 0U);
    EXPECT_EQ(error("turns,f 3,c\n").find("flow.csv:1: names no loop"), 0U);
    EXPECT_EQ(error("turns,f#1,c\n").find("flow.csv:1: has no number of turns"), 0U);
    EXPECT_EQ(error("endless,f#1 3,c\n").find("flow.csv:1: says more"), 0U);
}

}  // namespace
