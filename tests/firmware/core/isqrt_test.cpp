#include "firmware/core/isqrt.hpp"

#include <gtest/gtest.h>

namespace {

/// True when root = floor(sqrt(value)), by the definition: root^2 <= value < (root + 1)^2.
bool is_floor_root(uint64_t value, uint64_t root) {
    return root * root <= value && value < (root + 1) * (root + 1);
}

TEST(Isqrt, OfU16IsTheExactFloor) {
    for (uint32_t value = 0; value <= 0xFFFF; ++value) {
        ASSERT_TRUE(is_floor_root(value, rover::isqrt(static_cast<uint16_t>(value)))) << value;
    }
}

TEST(Isqrt, OfU32IsTheExactFloorAroundEverySquare) {
    for (uint64_t root = 0; root <= 0xFFFF; ++root) {
        for (const uint64_t value : {root * root, root * root + root, root * root + 2 * root}) {
            ASSERT_TRUE(is_floor_root(value, rover::isqrt(static_cast<uint32_t>(value)))) << value;
        }
    }
    EXPECT_EQ(rover::isqrt(0xFFFF'FFFFu), 65535);
}

TEST(Isqrt, OfU32IsTheExactFloorOfEvery4099thValue) {
    for (uint64_t value = 0; value <= 0xFFFF'FFFF; value += 4099) {
        if (!is_floor_root(value, rover::isqrt(static_cast<uint32_t>(value)))) FAIL() << value;
    }
}

}  // namespace
