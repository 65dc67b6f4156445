#include "firmware/core/ring.hpp"

#include <gtest/gtest.h>

#include <deque>

namespace {

TEST(Ring, KeepsTheLastItemsOldestFirst) {
    rover::Ring<int16_t, 8> ring;
    std::deque<int16_t> expected(8, 0);
    for (int16_t value = 1; value <= 50; ++value) {
        ring.push(value);
        expected.pop_front();
        expected.push_back(value);
        for (uint8_t i = 0; i < 8; ++i) ASSERT_EQ(ring.at(i), expected[i]);
    }
}

TEST(Ring, IndicesAreModuloTheSize) {
    rover::Ring<uint8_t, 32> ring;
    for (uint8_t i = 0; i < 32; ++i) ring.at(i) = i;
    for (uint32_t i = 0; i < 256; ++i) ASSERT_EQ(ring.at(static_cast<uint8_t>(i)), i % 32);
    ring.advance(uint8_t{255});  // one step back
    EXPECT_EQ(ring.at(uint8_t{0}), 31);
    ring.advance(uint8_t{33});
    EXPECT_EQ(ring.at(uint8_t{0}), 0);
}

TEST(Ring, Of256ItemsUsesEveryByteIndex) {
    rover::Ring<uint16_t, 256> ring;
    for (uint32_t i = 0; i < 256; ++i) ring.at(static_cast<uint8_t>(i)) = static_cast<uint16_t>(i);
    ring.advance(uint8_t{200});
    for (uint32_t i = 0; i < 256; ++i) {
        ASSERT_EQ(ring.at(static_cast<uint8_t>(i)), (i + 200) % 256);
    }
}

TEST(Ring, LargerThan256HasWideIndices) {
    rover::Ring<uint16_t, 1024> ring;
    for (uint16_t i = 0; i < 1024; ++i) ring.at(i) = i;
    ring.advance(uint16_t{1000});
    EXPECT_EQ(ring.at(uint16_t{65535}), (65535u + 1000u) % 1024u);
    EXPECT_EQ(sizeof(ring), 1024u * 2u + 2u);
}

TEST(Ring, FillSetsEveryItemAndTheOrigin) {
    rover::Ring<uint8_t, 4> ring;
    ring.push(uint8_t{1});
    ring.fill(uint8_t{9});
    for (uint8_t i = 0; i < 4; ++i) EXPECT_EQ(ring.at(i), 9);
    EXPECT_EQ(ring.origin, 0);
    EXPECT_EQ(sizeof(ring), 5u);
}

}  // namespace
