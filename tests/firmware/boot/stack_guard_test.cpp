// stack_guard_test.cpp - any byte of the guard that changes is noticed.
#include "firmware/boot/stack_guard.hpp"

#include <gtest/gtest.h>

namespace {

TEST(StackGuard, NoticesEveryChange) {
    std::uint8_t bytes[6] = {1, 2, 3, 4, 5, 6};
    rover::set_stack_guard(bytes + 1);
    EXPECT_EQ(bytes[0], 1);
    EXPECT_EQ(bytes[5], 6);
    EXPECT_TRUE(rover::stack_guard_holds(bytes + 1));
    for (std::size_t i = 1; i <= 4; ++i) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ 1U << bit);
            EXPECT_FALSE(rover::stack_guard_holds(bytes + 1));
            bytes[i] = static_cast<std::uint8_t>(bytes[i] ^ 1U << bit);
        }
    }
}

}  // namespace
