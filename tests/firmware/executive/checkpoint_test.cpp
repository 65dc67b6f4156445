// checkpoint_test.cpp - the newest valid checkpoint, and never none or a mixture.
#include "firmware/executive/checkpoint.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>

namespace {

struct Cut {};

/// A cell of memory that loses its supply after so many stores.
struct Cell {
    static inline int stores_left = 1 << 30;
    std::uint8_t value = 0;

    Cell& operator=(std::uint8_t stored) {
        if (stores_left-- == 0) throw Cut{};
        value = stored;
        return *this;
    }
    operator std::uint8_t() const { return value; }  // NOLINT: as a byte of memory
};
using Area = std::array<Cell, 256>;

rover::PoseRecord record_of(std::int32_t n) {
    rover::PoseRecord record;
    record.travelled_q6_bin = n;
    record.odometer_q4_mm = n * 1'000'003;
    record.variance_q12 = static_cast<std::uint32_t>(n) * 77'777U;
    record.since_cycle_q4_mm = static_cast<std::int16_t>(n * 19);
    return record;
}
bool same(const rover::PoseRecord& a, const rover::PoseRecord& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

bool find(const Area& area, rover::CheckpointPlace& place, rover::PoseRecord& record) {
    if (!rover::find_checkpoint(area.data(), place)) return false;
    std::uint8_t bytes[sizeof record];
    for (std::size_t i = 0; i < sizeof record; ++i) bytes[i] = area[place.slot + 2 + i].value;
    std::memcpy(&record, bytes, sizeof record);
    return true;
}

TEST(Checkpoint, TheNewestOfManyIsFound) {
    Area area;
    rover::CheckpointPlace place;
    rover::PoseRecord found;
    EXPECT_FALSE(find(area, place, found));
    for (int n = 1; n < 1000; ++n) {  // the sequence number wraps three times
        rover::save_checkpoint(area.data(), place, record_of(n));
        rover::CheckpointPlace after_reset;
        ASSERT_TRUE(find(area, after_reset, found)) << n;
        ASSERT_TRUE(same(found, record_of(n))) << n;
        ASSERT_EQ(after_reset.slot, place.slot) << n;
        ASSERT_EQ(after_reset.sequence, place.sequence) << n;
        if (n % 7 == 0) place = after_reset;
    }
}

TEST(Checkpoint, BehindEveryStoreItIsTheOldOrTheNewOne) {
    for (int before = 1; before <= 520; ++before) {
        Area area;
        rover::CheckpointPlace place;
        ASSERT_FALSE(rover::find_checkpoint(area.data(), place));
        for (int n = 1; n <= before; ++n) {
            if (n + 3 > before) rover::save_checkpoint(area.data(), place, record_of(n));
        }
        bool done = false;
        for (int stores = 0; !done; ++stores) {
            ASSERT_LT(stores, 100);
            Area cut = area;
            rover::CheckpointPlace writer = place;
            Cell::stores_left = stores;
            try {
                rover::save_checkpoint(cut.data(), writer, record_of(before + 1));
                done = true;
            } catch (const Cut&) {
            }
            Cell::stores_left = 1 << 30;
            rover::PoseRecord found;
            rover::CheckpointPlace after_reset;
            ASSERT_TRUE(find(cut, after_reset, found));
            ASSERT_TRUE(same(found, record_of(done ? before + 1 : before))) << stores;
            // The next write must not touch the one that is valid now.
            Cell::stores_left = 5;
            EXPECT_THROW(rover::save_checkpoint(cut.data(), after_reset, record_of(9)), Cut);
            Cell::stores_left = 1 << 30;
            rover::PoseRecord again;
            ASSERT_TRUE(find(cut, after_reset, again));
            ASSERT_TRUE(same(again, found)) << stores;
        }
    }
}

TEST(Checkpoint, ADamagedOneGivesWayToTheOneBefore) {
    Area area;
    rover::CheckpointPlace place;
    ASSERT_FALSE(rover::find_checkpoint(area.data(), place));
    for (int n = 1; n <= 5; ++n) rover::save_checkpoint(area.data(), place, record_of(n));
    area[place.slot + 9U].value ^= 0x10;
    rover::PoseRecord found;
    ASSERT_TRUE(find(area, place, found));
    EXPECT_TRUE(same(found, record_of(4)));
}

TEST(Checkpoint, AnotherFormatIsNotTaken) {
    Area area;
    rover::CheckpointPlace place;
    ASSERT_FALSE(rover::find_checkpoint(area.data(), place));
    rover::PoseRecord record = record_of(1);
    record.format = 2;
    rover::save_checkpoint(area.data(), place, record);
    rover::PoseRecord found;
    EXPECT_FALSE(find(area, place, found));
}

TEST(Checkpoint, DroppedOnesAreGone) {
    Area area;
    rover::CheckpointPlace place;
    ASSERT_FALSE(rover::find_checkpoint(area.data(), place));
    for (int n = 1; n <= 2; ++n) rover::save_checkpoint(area.data(), place, record_of(n));
    rover::drop_checkpoints(area.data());
    rover::PoseRecord found;
    EXPECT_FALSE(find(area, place, found));
    rover::save_checkpoint(area.data(), place, record_of(3));
    EXPECT_TRUE(find(area, place, found));
    EXPECT_TRUE(same(found, record_of(3)));
}

}  // namespace
