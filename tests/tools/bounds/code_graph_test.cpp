// code_graph_test.cpp - blocks, edges and calls of small programs.
#include "tools/bounds/code_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tools/bounds/sample_program.hpp"
#include "tools/budget/budget_error.hpp"

namespace {

using bounds_test::Sample;
using rover_bounds::CodeGraph;
using rover_bounds::Edge;
using rover_bounds::Procedure;

TEST(CodeGraph, ABranchHasBothTimes) {
    const Sample sample("f: ORA A\n JZ out\n NOP\nout: RET\n", {{"f", "f"}});
    const CodeGraph graph = read_code(sample.source(), {0});
    const Procedure& f = graph.at(0);
    EXPECT_EQ(f.name, "f");
    ASSERT_EQ(f.blocks.size(), 3U);  // ORA, JZ; NOP; RET
    std::vector<uint32_t> t;
    for (const Edge& edge : f.edges) t.push_back(edge.t);
    // ORA 4 + JZ not taken 7; ORA 4 + JZ taken 10; NOP 4; RET 10
    std::ranges::sort(t);
    EXPECT_EQ(t, (std::vector<uint32_t>{4, 10, 11, 14}));
}

TEST(CodeGraph, ACallStandsOnTheEdgeAndAConditionalOneOnOneOfTwo) {
    const Sample sample("f: CZ g\n RET\ng: RET\n", {{"f", "f"}, {"g", "g"}});
    const CodeGraph graph = read_code(sample.source(), {0});
    ASSERT_EQ(graph.procedures.size(), 2U);
    const std::vector<Edge>& edges = graph.at(0).edges;
    ASSERT_EQ(edges.size(), 3U);
    EXPECT_EQ(edges[0].t, 9U);
    EXPECT_FALSE(edges[0].callee);
    EXPECT_EQ(edges[1].t, 18U);
    EXPECT_EQ(edges[1].callee, sample.at("g"));
    EXPECT_EQ(edges[0].to, edges[1].to);
}

TEST(CodeGraph, AJumpToAnotherFunctionIsACallBehindWhichItReturns) {
    const Sample sample("f: NOP\n JMP g\ng: RET\n", {{"f", "f"}, {"g", "g"}});
    const CodeGraph graph = read_code(sample.source(), {0});
    ASSERT_EQ(graph.at(0).edges.size(), 1U);
    const Edge& edge = graph.at(0).edges[0];
    EXPECT_EQ(edge.t, 14U);
    EXPECT_EQ(edge.callee, sample.at("g"));
    EXPECT_FALSE(edge.to);
    EXPECT_EQ(graph.reached_from(0), (std::set<uint16_t>{0, sample.at("g")}));
}

TEST(CodeGraph, CodeThatRunsIntoAnotherFunctionCallsItAsWell) {
    const Sample sample("f: NOP\ng: RET\n", {{"f", "f"}, {"g", "g"}});
    const CodeGraph graph = read_code(sample.source(), {0});
    ASSERT_EQ(graph.at(0).edges.size(), 1U);
    EXPECT_EQ(graph.at(0).edges[0].callee, sample.at("g"));
}

TEST(CodeGraph, ATurnEndsWhereItBegan) {
    const Sample sample("f: NOP\nloop: NOP\n JMP loop\n", {{"f", "f"}});
    const CodeGraph graph = read_code(sample.source(), {0});
    const Procedure turn = read_turn(sample.source(), graph, sample.at("loop"));
    ASSERT_EQ(turn.edges.size(), 1U);
    EXPECT_EQ(turn.edges[0].t, 14U);
    EXPECT_FALSE(turn.edges[0].to);
}

std::string error_of(const std::string& source) {
    const Sample sample(source, {{"f", "f"}});
    try {
        (void)read_code(sample.source(), {0});
    } catch (const rover_budget::BudgetError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(CodeGraph, WhatGoesNowhereKnownIsRefusedWithItsLine) {
    EXPECT_EQ(error_of("f: NOP\n PCHL\n"),
              "a.cpp:1: PCHL at 0001H goes to an address that is not known; use a switch without "
              "a table, or a call by name");
    EXPECT_NE(error_of("f: RST 1\n RET\n").find("RST at 0000H"), std::string::npos);
    EXPECT_NE(error_of("f: NOP\n").find("its program goes on at 0001H, where no bytes are"),
              std::string::npos);
}

}  // namespace
