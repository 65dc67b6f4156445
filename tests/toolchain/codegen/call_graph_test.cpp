// Who calls whom, through pointers too; groups, order, cycles.
#include "toolchain/codegen/call_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/toolchain/codegen/call_programs.hpp"

namespace {

using namespace toolchain::codegen;
using codegen_test::module_with_calls;

TEST(CallGraph, CalleesComeBeforeCallers) {
    const Module module = module_with_calls({{2, 1}, {3}, {1}, {}});
    const CallGraph graph(module);
    EXPECT_EQ(graph.bottom_up(), (std::vector<std::size_t>{3, 1, 2, 0}));
    EXPECT_EQ(graph.callees(0).size(), 2U);
    EXPECT_EQ(graph.index_of(module.symbol_ids.at("f2")), 2U);
    EXPECT_EQ(graph.index_of(kNone), CallGraph::kNoFunction);
}

TEST(CallGraph, ACycleIsTheShortestWayBack) {
    const Module module = module_with_calls({{1}, {2}, {3, 1}, {1}, {4}});
    const CallGraph graph(module);
    EXPECT_FALSE(graph.is_recursive(0));
    EXPECT_TRUE(graph.is_recursive(1));
    EXPECT_TRUE(graph.is_recursive(3));
    EXPECT_TRUE(graph.is_recursive(4));
    EXPECT_EQ(graph.group(1), graph.group(3));
    EXPECT_NE(graph.group(1), graph.group(4));
    const auto cycle = graph.cycle(1);
    ASSERT_EQ(cycle.size(), 2U);
    EXPECT_EQ(cycle[0].callee, 2U);
    EXPECT_EQ(cycle[0].place.line, 11U);
    EXPECT_EQ(cycle[1].callee, 1U);
    EXPECT_EQ(cycle[1].place.line, 22U);
    EXPECT_TRUE(graph.cycle(0).empty());
}

// Groups against reachability, found by walking.
TEST(CallGraph, GroupsAreThoseThatReachEachOther) {
    std::mt19937 random(8085);
    for (int round = 0; round < 200; ++round) {
        const std::size_t count = 1 + random() % 9;
        std::vector<std::vector<std::size_t>> calls(count);
        for (auto& callees : calls) {
            for (std::size_t k = 0; k < count; ++k) {
                if (random() % 5 == 0) callees.push_back(k);
            }
        }
        std::vector<std::vector<bool>> reaches(count, std::vector<bool>(count, false));
        for (std::size_t from = 0; from < count; ++from) {
            const std::function<void(std::size_t)> walk = [&](std::size_t at) {
                for (const std::size_t callee : calls[at]) {
                    if (reaches[from][callee]) continue;
                    reaches[from][callee] = true;
                    walk(callee);
                }
            };
            walk(from);
        }
        const Module module = module_with_calls(calls);
        const CallGraph graph(module);
        std::vector<std::size_t> place(count);
        for (std::size_t i = 0; i < count; ++i) place[graph.bottom_up().at(i)] = i;
        for (std::size_t a = 0; a < count; ++a) {
            ASSERT_EQ(graph.is_recursive(a), reaches[a][a]);
            for (std::size_t b = 0; b < count; ++b) {
                const bool together = a == b || (reaches[a][b] && reaches[b][a]);
                ASSERT_EQ(graph.group(a) == graph.group(b), together);
                if (reaches[a][b] && !together) {
                    ASSERT_LT(place[b], place[a]);
                }
            }
        }
    }
}

/// `target(word) -> byte` whose address is in data; `other(word) -> word` whose address is a value;
/// `plain(word) -> byte`, called by name only. f0 calls through a pointer.
struct PointerModule {
    Module module = module_with_calls({{}});

    PointerModule() {
        add("target", 1);
        add("other", 2);
        add("plain", 1);
        Variable table;
        table.symbol = module.intern("table");
        table.size = 2;
        table.initial = {{0, module.intern("target"), 0, false},
                         {0, module.intern("target"), 0, true}};
        module.variables.push_back(table);
        Function& caller = module.functions[0];
        Builder builder(caller);
        const Bytes address = builder.address(module.intern("other"), 0);
        (void)builder.call(module.intern("plain"), {builder.constant(1, 2)}, 1);
        (void)builder.call_indirect(address, {builder.constant(7, 2)}, 1);
        mark_signatures(module);
    }

    void add(const std::string& name, uint32_t result_size) {
        Function function;
        function.symbol = module.intern(name);
        function.result_size = result_size;
        function.blocks.emplace_back();
        Builder builder(function);
        const Bytes parameter = builder.parameter(2);
        function.parameters = {parameter};
        function.blocks[0].parameters = parameter;
        Terminator end;
        end.kind = Terminator::Kind::give_back;
        end.left = Bytes(parameter.begin(), parameter.begin() + result_size);
        builder.terminate(end);
        module.functions.push_back(function);
    }
};

TEST(CallGraph, AddressesAreTakenByCodeAndByData) {
    const PointerModule test;
    EXPECT_TRUE(test.module.functions[1].address_taken);
    EXPECT_TRUE(test.module.functions[2].address_taken);
    EXPECT_FALSE(test.module.functions[3].address_taken);  // called by name only
    EXPECT_FALSE(test.module.functions[0].address_taken);
    EXPECT_EQ(test.module.symbols[test.module.functions[1].signature], "p2r1");
    EXPECT_EQ(test.module.symbols[test.module.functions[2].signature], "p2r2");
}

TEST(CallGraph, ACallThroughAPointerReachesItsSignature) {
    const PointerModule test;
    const CallGraph graph(test.module);
    const auto& edges = graph.callees(0);
    ASSERT_EQ(edges.size(), 2U);
    EXPECT_EQ(edges[0].callee, 3U);
    EXPECT_FALSE(edges[0].through_pointer);
    EXPECT_EQ(edges[1].callee, 1U);  // not `other`: its result has another size
    EXPECT_TRUE(edges[1].through_pointer);
    EXPECT_TRUE(graph.targets(kNone).empty());
}

}  // namespace
