// identity_test.cpp - identity block, battery-backed area and checkpoint lie as
// docs/spec/memory-map.md says.
#include "firmware/app/identity.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "tests/support/page_table.hpp"

#include "firmware/boot/stack_guard.hpp"
#include "firmware/config/memory_layout.hpp"
#include "firmware/executive/checkpoint.hpp"
#include "firmware/link/calibration_frame.hpp"

namespace {

using test_support::Row;

std::vector<Row> table_of(const std::string& heading) {
    return test_support::table_of("docs/spec/memory-map.md", heading);
}

/// Offset and size columns.
std::map<std::size_t, std::size_t> places(const std::vector<Row>& rows, int base) {
    std::map<std::size_t, std::size_t> found;
    for (const Row& row : rows) {
        if (row[0] == "others") continue;
        found[std::stoul(row[0], nullptr, base)] = std::stoul(row[1]);
    }
    return found;
}

TEST(MemoryMapPage, IdentityBlock) {
    using I = rover::Identity;
    const std::map<std::size_t, std::size_t> expected = {
        {offsetof(I, magic), 8},         {offsetof(I, format), 1},
        {offsetof(I, version_major), 3}, {offsetof(I, source_hash), 4},
        {offsetof(I, image_size), 2},    {offsetof(I, image_crc), 2},
        {offsetof(I, vehicle), 8}};
    EXPECT_EQ(places(table_of("### Identity block"), 10), expected);
    EXPECT_EQ(std::string(rover::kIdentity.magic, rover::kIdentity.magic + 8),
              std::string("ROVER85\0", 8));
    EXPECT_EQ(rover::kIdentity.format, 1);
    EXPECT_EQ(rover::kIdentityPayloadSize, 20);
}

TEST(MemoryMapPage, BatteryBackedArea) {
    const std::size_t slot = sizeof(rover::PoseRecord) + rover::kRecordOverhead;
    const std::map<std::size_t, std::size_t> expected = {
        {rover::battery::kResetCount, 2},
        {rover::battery::kMark, 1},
        {rover::battery::kQuietTicks, 1},
        {rover::battery::kFaults, 2},
        {rover::battery::kSlotA, slot},
        {rover::battery::kSlotB, slot},
        {rover::battery::kCalibration, rover::kCalibrationBytes + rover::kRecordOverhead}};
    const auto page = places(table_of("## Battery-backed area, FF00-FFFF"), 16);
    EXPECT_EQ(page, expected);
    std::size_t end = 0;
    for (const auto& [offset, size] : page) {
        EXPECT_GE(offset, end);
        end = offset + size;
    }
    EXPECT_LE(end, 256u);
}

TEST(MemoryMapPage, Checkpoint) {
    using P = rover::PoseRecord;
    const std::vector<std::pair<std::string, std::size_t>> expected = {
        {"travelled_q6_bin", offsetof(P, travelled_q6_bin)},
        {"odometer_q4_mm", offsetof(P, odometer_q4_mm)},
        {"variance_q12", offsetof(P, variance_q12)},
        {"drift_q12_bin", offsetof(P, drift_q12_bin)},
        {"since_cycle_q4_mm", offsetof(P, since_cycle_q4_mm)},
        {"turn_q4_mm", offsetof(P, turn_q4_mm)},
        {"mean_q12_bin", offsetof(P, mean_q12_bin)},
        {"learned", offsetof(P, learned)},
        {"format", offsetof(P, format)}};
    const auto rows = table_of("### Checkpoint");
    ASSERT_EQ(rows.size(), expected.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i][2], expected[i].first);
        EXPECT_EQ(std::stoul(rows[i][0]), expected[i].second);
    }
}

TEST(MemoryMapPage, Ram) {
    EXPECT_EQ(rover::kRamInUseLast, 0x87FF);
    EXPECT_EQ(rover::kStackGuardFirst, 0xFDFC);
    EXPECT_EQ(rover::kStackGuardFirst + rover::kStackGuardSize, rover::kStackFirst);
    EXPECT_EQ(rover::kStackFirst, 0xFE00);
    EXPECT_EQ(rover::kStackLast, 0xFEFF);
    EXPECT_EQ(rover::kStackGuardByte, 0xB7);
    EXPECT_EQ(table_of("## RAM, 8000-FEFF").size(), 5u);
}

}  // namespace
