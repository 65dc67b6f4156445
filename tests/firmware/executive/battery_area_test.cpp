// battery_area_test.cpp - a record is the old one, invalid, or the new one, behind every store.
#include "firmware/executive/battery_area.hpp"

#include <gtest/gtest.h>

#include <array>

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

using Content = std::array<std::uint8_t, 24>;
using Area = std::array<Cell, 28>;

Content content_of(unsigned first) {
    Content content;
    for (std::size_t i = 0; i < content.size(); ++i) {
        content[i] = static_cast<std::uint8_t>(first + 37 * i);
    }
    return content;
}

bool read(const Area& area, Content& content) {
    if (!rover::record_is_valid(area.data(), 24)) return false;
    for (std::size_t i = 0; i < 24; ++i) content[i] = area[i + 2].value;
    return true;
}

TEST(BatteryRecord, ComesBackAndEveryWrongBitIsNoticed) {
    Area area;
    const Content written = content_of(5);
    rover::write_record(area.data(), 77, written.data(), 24);
    EXPECT_EQ(area[0].value, 0xA5);
    EXPECT_EQ(area[1].value, 77);
    Content seen;
    ASSERT_TRUE(read(area, seen));
    EXPECT_EQ(seen, written);
    for (std::size_t bit = 0; bit < 28 * 8; ++bit) {
        Area bad = area;
        bad[bit / 8].value = static_cast<std::uint8_t>(bad[bit / 8].value ^ 1U << bit % 8);
        EXPECT_FALSE(read(bad, seen)) << "bit " << bit;
    }
}

TEST(BatteryRecord, BehindEveryStoreItIsOldInvalidOrNew) {
    const Content old_content = content_of(1);
    const Content new_content = content_of(2);
    Area before;
    rover::write_record(before.data(), 1, old_content.data(), 24);
    int invalid = 0;
    bool done = false;
    for (int stores = 0; !done; ++stores) {
        ASSERT_LT(stores, 100);
        Area area = before;
        Cell::stores_left = stores;
        try {
            rover::write_record(area.data(), 2, new_content.data(), 24);
            done = true;
        } catch (const Cut&) {
        }
        Cell::stores_left = 1 << 30;
        Content seen;
        if (!read(area, seen)) {
            ++invalid;
            EXPECT_EQ(area[0].value, 0) << "not by the check alone";
        } else {
            EXPECT_EQ(seen, done ? new_content : old_content) << stores;
            EXPECT_TRUE(done || stores == 0);
        }
    }
    EXPECT_EQ(invalid, 28);  // 29 stores: behind the first and before the last it is invalid
}

TEST(BatteryRecord, ErasedMemoryIsNoRecord) {
    for (const unsigned value : {0x00U, 0xFFU, 0xA5U}) {
        Area area;
        for (Cell& cell : area) cell.value = static_cast<std::uint8_t>(value);
        Content seen;
        EXPECT_FALSE(read(area, seen)) << value;
    }
}

}  // namespace
