// free_space_test.cpp - gaps by hand.
#include "toolchain/asm/free_space.hpp"

#include <gtest/gtest.h>

namespace {

using namespace toolchain::assembly;

TEST(FreeSpace, TakesTheLowestGapThatFits) {
    FreeSpace space({0x0000, 0x00FF});
    space.remove({0x24, 3});
    space.remove({0x2C, 3});
    EXPECT_EQ(space.free(), 250u);
    EXPECT_EQ(space.take(6), 0x00u);
    EXPECT_EQ(space.take(31), 0x2Fu);  // 30 are left in front of 24H, 5 behind 27H
    EXPECT_EQ(space.take(5), 0x06u);
    EXPECT_EQ(space.take(26), 0x4Eu);
    EXPECT_EQ(space.take(25), 0x0Bu);
    EXPECT_EQ(space.take(5), 0x27u);
    EXPECT_EQ(space.take(300), std::nullopt);
}

TEST(FreeSpace, AlignsAndUsesTheGapInFront) {
    FreeSpace space({0x0001, 0x02FF});
    EXPECT_EQ(space.take(16, 256), 0x100u);
    EXPECT_EQ(space.take(255), 0x001u);
    EXPECT_EQ(space.take(1), 0x110u);
    EXPECT_EQ(space.largest_gap(), 0x1EFu);
}

TEST(FreeSpace, TakesFromTheTopAndUpToTheEndOfMemory) {
    FreeSpace space({0xFF00, 0xFFFF});
    EXPECT_EQ(space.take_top(0x10), 0xFFF0u);
    EXPECT_EQ(space.take(0xF0), 0xFF00u);
    EXPECT_EQ(space.free(), 0u);
    EXPECT_EQ(space.take_top(1), std::nullopt);
}

TEST(FreeSpace, RemovingWhatLiesOutsideChangesNothing) {
    FreeSpace space({0x100, 0x1FF});
    space.remove({0x000, 0x100});
    space.remove({0x200, 5});
    EXPECT_EQ(space.free(), 256u);
    space.remove({0x0F0, 0x20});
    EXPECT_EQ(space.take(1), 0x110u);
}

}  // namespace
