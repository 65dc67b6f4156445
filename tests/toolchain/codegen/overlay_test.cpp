// Frames of functions that can be active together never overlap; otherwise they begin as low as
// they can.
#include "toolchain/codegen/overlay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "tests/toolchain/codegen/call_programs.hpp"

namespace {

using namespace toolchain::codegen;
using codegen_test::module_with_calls;

TEST(Overlay, ABranchTakesTheLongestWay) {
    // 0 calls 1 and 2, 1 calls 3, 2 calls 3.
    const Module module = module_with_calls({{1, 2}, {3}, {3}, {}});
    const CallGraph graph(module);
    const std::vector<uint32_t> sizes = {10, 1, 5, 7};
    const std::vector<std::size_t> roots = {0};
    const Overlay overlay = overlay_frames(graph, roots, sizes, 100);
    EXPECT_EQ(overlay.offsets, (std::vector<uint32_t>{100, 110, 110, 115}));
    EXPECT_EQ(overlay.end, 122U);
}

TEST(Overlay, TheLongerWayMayComeFirst) {
    const Module module = module_with_calls({{2, 1}, {3}, {3}, {}});
    const CallGraph graph(module);
    const std::vector<std::size_t> roots = {0};
    const std::vector<uint32_t> sizes = {0, 9, 2, 1};
    EXPECT_EQ(overlay_frames(graph, roots, sizes, 0).offsets[3], 9U);
}

TEST(Overlay, FunctionsThatRecurseHaveFramesBehindEachOther) {
    const Module module = module_with_calls({{1}, {2}, {1, 3}, {}});
    const CallGraph graph(module);
    const std::vector<std::size_t> roots = {0};
    const std::vector<uint32_t> sizes = {1, 2, 4, 8};
    const Overlay overlay = overlay_frames(graph, roots, sizes, 0);
    EXPECT_EQ(std::min(overlay.offsets[1], overlay.offsets[2]), 1U);
    EXPECT_EQ(overlay.offsets[3], 7U);
    const bool apart = overlay.offsets[1] + 2 <= overlay.offsets[2] ||
                       overlay.offsets[2] + 4 <= overlay.offsets[1];
    EXPECT_TRUE(apart);
}

TEST(Overlay, FramesAreAligned) {
    const Module module = module_with_calls({{1, 2}, {3}, {}, {}});
    const CallGraph graph(module);
    const std::vector<std::size_t> roots = {0};
    const std::vector<uint32_t> sizes = {3, 1, 5, 2};
    const std::vector<uint32_t> alignments = {2, 1, 4, 8};
    const Overlay overlay = overlay_frames(graph, roots, sizes, 1, alignments);
    EXPECT_EQ(overlay.offsets, (std::vector<uint32_t>{2, 5, 8, 8}));
    EXPECT_EQ(overlay.end, 13U);
}

TEST(Overlay, WhatIsNotReachedTakesNothing) {
    const Module module = module_with_calls({{}, {}});
    const CallGraph graph(module);
    const std::vector<std::size_t> roots = {0};
    const std::vector<uint32_t> sizes = {3, 50};
    EXPECT_EQ(overlay_frames(graph, roots, sizes, 0).end, 3U);
}

// Random graphs without recursion: along every way from the root frames follow one another, and
// each begins where one of its callers' frames ends.
TEST(Overlay, HoldsForRandomGraphs) {
    std::mt19937 random(85);
    for (int round = 0; round < 300; ++round) {
        const std::size_t count = 2 + random() % 12;
        std::vector<std::vector<std::size_t>> calls(count);
        std::vector<uint32_t> sizes;
        for (std::size_t i = 0; i < count; ++i) {
            sizes.push_back(static_cast<uint32_t>(random() % 9));
            for (std::size_t k = i + 1; k < count; ++k) {
                if (random() % 3 == 0) calls[i].push_back(k);
            }
        }
        const Module module = module_with_calls(calls);
        const CallGraph graph(module);
        const std::vector<std::size_t> roots = {0};
        const Overlay overlay = overlay_frames(graph, roots, sizes, 0);
        std::vector<uint32_t> lowest(count, 0);  // by the longest way, found by trying all
        const std::function<void(std::size_t, uint32_t)> walk = [&](std::size_t at, uint32_t base) {
            lowest[at] = std::max(lowest[at], base);
            for (const std::size_t callee : calls[at]) walk(callee, base + sizes[at]);
        };
        walk(0, 0);
        EXPECT_EQ(overlay.offsets, lowest);
    }
}

}  // namespace
