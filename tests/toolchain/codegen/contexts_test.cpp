// What the main program and each interrupt reach.
#include "toolchain/codegen/contexts.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "tests/toolchain/codegen/call_programs.hpp"

namespace {

using namespace toolchain::codegen;
using codegen_test::module_with_calls;
using Flags = std::vector<bool>;

TEST(Contexts, VectorsHaveNames) {
    EXPECT_EQ(vector_title(0x24), "TRAP");
    EXPECT_EQ(vector_title(0x2C), "RST 5.5");
    EXPECT_EQ(vector_title(0x34), "RST 6.5");
    EXPECT_EQ(vector_title(0x3C), "RST 7.5");
    EXPECT_EQ(vector_title(0x38), "RST 7");
    EXPECT_EQ(vector_title(0x08), "RST 1");
    for (const int32_t none : {-1, 0, 4, 0x0C, 0x14, 0x1C, 0x25, 0x40, 0x44}) {
        EXPECT_EQ(vector_title(none), "") << none;
    }
    EXPECT_EQ(vector_suffix(0x3C), "@rst75");
    EXPECT_EQ(vector_suffix(0x24), "@trap");
    EXPECT_EQ(vector_suffix(0x38), "@rst7");
}

TEST(Contexts, ReachAndOwnership) {
    // 0 main, 1 RST 7.5, 2 TRAP; 3 shared by all, 4 by the interrupts, 5 by nobody.
    Module module = module_with_calls({{3}, {4}, {3, 4}, {}, {3}, {}});
    module.functions[1].interrupt = 0x3C;
    module.functions[2].interrupt = 0x24;
    const CallGraph graph(module);
    const auto contexts = find_contexts(module, graph, {0});
    ASSERT_EQ(contexts.size(), 3U);
    EXPECT_EQ(contexts[0].reached, (Flags{true, false, false, true, false, false}));
    EXPECT_EQ(contexts[1].suffix, "@trap");  // by vectors
    EXPECT_EQ(contexts[1].reached, (Flags{false, false, true, true, true, false}));
    EXPECT_EQ(contexts[2].reached, (Flags{false, true, false, true, true, false}));
    EXPECT_EQ(owners(contexts, 6), (std::vector<std::size_t>{0, 2, 1, 0, 1, kNoContext}));
}

TEST(Contexts, AFunctionWhoseAddressIsTakenIsKept) {
    Module module = module_with_calls({{}, {2}, {}});
    module.functions[1].address_taken = true;
    const auto contexts = find_contexts(module, CallGraph(module), {0});
    EXPECT_EQ(contexts[0].reached, (Flags{true, true, true}));
    EXPECT_EQ(contexts[0].roots, (std::vector<std::size_t>{0, 1}));
}

}  // namespace
