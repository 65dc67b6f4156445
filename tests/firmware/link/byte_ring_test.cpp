// byte_ring_test.cpp - the ring loses nothing but what it counts, at every size and phase.
#include "firmware/link/byte_ring.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <vector>

namespace {

using rover::ByteRing;

template <class Ring>
class ByteRingTest : public testing::Test {};
using Sizes = testing::Types<ByteRing<2>, ByteRing<16>, ByteRing<64>, ByteRing<128>, ByteRing<256>>;
TYPED_TEST_SUITE(ByteRingTest, Sizes);

TYPED_TEST(ByteRingTest, HoldsItsCapacityAndCountsWhatItRefuses) {
    TypeParam ring;
    const unsigned size = sizeof(ring.bytes);
    const unsigned capacity = size == 256 ? 255 : size;
    EXPECT_TRUE(ring.empty());
    for (unsigned i = 0; i < capacity; ++i) {
        EXPECT_EQ(ring.room(), capacity - i);
        ring.push(static_cast<std::uint8_t>(i ^ 0x5A));
    }
    EXPECT_EQ(ring.room(), 0);
    EXPECT_EQ(ring.count(), capacity);
    EXPECT_EQ(ring.dropped, 0);
    for (unsigned i = 0; i < 3; ++i) ring.push(0xEE);
    EXPECT_EQ(ring.dropped, 3);
    for (unsigned i = 0; i < capacity; ++i) EXPECT_EQ(ring.pop(), i ^ 0x5A);
    EXPECT_TRUE(ring.empty());
}

TYPED_TEST(ByteRingTest, IsAQueueUnderRandomUse) {
    for (unsigned seed = 1; seed <= 10; ++seed) {
        std::mt19937 random(seed);
        TypeParam ring;
        const std::size_t capacity = sizeof(ring.bytes) == 256 ? 255 : sizeof(ring.bytes);
        std::deque<std::uint8_t> model;
        unsigned dropped = 0;
        for (int i = 0; i < 20'000; ++i) {
            const auto byte = static_cast<std::uint8_t>(random());
            if (random() % 2 == 0) {
                ring.push(byte);
                if (model.size() < capacity) {
                    model.push_back(byte);
                } else {
                    ++dropped;
                }
            } else if (!ring.empty()) {
                ASSERT_EQ(ring.pop(), model.front()) << "seed " << seed;
                model.pop_front();
            }
            ASSERT_EQ(ring.count(), model.size()) << "seed " << seed;
            ASSERT_EQ(ring.empty(), model.empty()) << "seed " << seed;
        }
        ASSERT_EQ(ring.dropped, dropped % 65536) << "seed " << seed;
    }
}

TEST(PageRing, IsAQueueOf255BytesAtEveryPhase) {
    alignas(256) static rover::PageRing ring;
    ring.begin();
    std::mt19937 random(2);
    std::deque<std::uint8_t> model;
    for (int i = 0; i < 200'000; ++i) {
        ASSERT_EQ(ring.room(), 255 - model.size());
        ASSERT_EQ(ring.empty(), model.empty());
        const bool fill = random() % 512 < 256 + (i / 2000 % 2 == 0 ? 60U : -60U);
        if (fill && ring.room() != 0) {
            const auto byte = static_cast<std::uint8_t>(random());
            ring.push(byte);
            model.push_back(byte);
        } else if (!fill && !ring.empty()) {
            std::uint8_t byte = 0;
            const bool was_last = ring.pop([&byte](std::uint8_t oldest) { byte = oldest; });
            ASSERT_EQ(byte, model.front());
            model.pop_front();
            ASSERT_EQ(was_last, model.empty());
        }
    }
}

TEST(PageRing, ManyBytesAreAsManySingleOnes) {
    alignas(256) static rover::PageRing ring;
    ring.begin();
    std::uint8_t next_in = 0;
    std::uint8_t next_out = 0;
    for (unsigned count = 0; count <= 255; ++count) {  // at ever other places of the page
        std::vector<std::uint8_t> bytes(count);
        for (std::uint8_t& byte : bytes) byte = next_in++;
        ring.push_all(bytes.data(), static_cast<std::uint8_t>(count));
        ASSERT_EQ(ring.room(), 255 - count);
        for (unsigned left = count; left != 0; --left) {
            std::uint8_t byte = 0;
            const bool was_last = ring.pop([&byte](std::uint8_t oldest) { byte = oldest; });
            ASSERT_EQ(byte, next_out++);
            ASSERT_EQ(was_last, left == 1);
        }
        ASSERT_TRUE(ring.empty());
    }
}

// An interrupt between any two steps of the other side: every byte that push() accepted comes out,
// in order. The consumer's steps are its single accesses, spelled out.
TEST(ByteRing, AProducerMayInterruptTheConsumerAnywhere) {
    for (unsigned phase = 0; phase < 300; ++phase) {
        for (int interrupt_at = 0; interrupt_at < 3; ++interrupt_at) {
            ByteRing<16> ring;
            for (unsigned i = 0; i < phase; ++i) {
                ring.push(0);
                ring.pop();
            }
            ring.push(1);
            const std::uint8_t place = ring.taken;
            if (interrupt_at == 0) ring.push(2);
            const std::uint8_t byte = ring.bytes[place & ByteRing<16>::kMask];
            if (interrupt_at == 1) ring.push(2);
            ring.taken = static_cast<std::uint8_t>(place + 1);
            if (interrupt_at == 2) ring.push(2);
            ASSERT_EQ(byte, 1);
            ASSERT_EQ(ring.count(), 1);
            ASSERT_EQ(ring.pop(), 2);
        }
    }
}

}  // namespace
