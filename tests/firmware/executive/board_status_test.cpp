// board_status_test.cpp - the status frame's layout and the fault bits are those of
// docs/spec/link.md.
#include "firmware/executive/board_status.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "tests/support/page_table.hpp"

namespace {

using test_support::Row;

std::vector<Row> table_of(const std::string& heading) {
    return test_support::table_of("docs/spec/link.md", heading);
}

struct Field {
    std::size_t offset;
    std::string type;
    std::string name;
};

TEST(BoardStatus, HasTheLayoutOfThePage) {
    using S = rover::BoardStatus;
    const std::vector<Field> fields = {
        {offsetof(S, faults), "u16", "faults"},
        {offsetof(S, last_faults), "u16", "last_faults"},
        {offsetof(S, reset_count), "u16", "reset_count"},
        {offsetof(S, late_steps), "u16", "late_steps"},
        {offsetof(S, missed_steps), "u16", "missed_steps"},
        {offsetof(S, received), "u16", "received"},
        {offsetof(S, receive_dropped), "u16", "receive_dropped"},
        {offsetof(S, receive_errors), "u16", "receive_errors"},
        {offsetof(S, frames_dropped), "u16", "frames_dropped"},
        {offsetof(S, frames_refused), "u8", "frames_refused"},
        {offsetof(S, trap_count), "u8", "trap_count"},
        {offsetof(S, reset_cause), "u8", "reset_cause"},
        {offsetof(S, warm), "u8", "warm"},
    };
    const auto rows = table_of("### status");
    ASSERT_EQ(rows.size(), fields.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i][0], std::to_string(fields[i].offset));
        EXPECT_EQ(rows[i][1], fields[i].type);
        EXPECT_EQ(rows[i][2], fields[i].name);
    }
}

TEST(BoardStatus, HasTheFaultBitsOfThePage) {
    const std::vector<std::pair<std::string, unsigned>> bits = {
        {"kFaultRom", rover::kFaultRom},
        {"kFaultRam", rover::kFaultRam},
        {"kFaultStack", rover::kFaultStack},
        {"kFaultStepLate", rover::kFaultStepLate},
        {"kFaultLinkLost", rover::kFaultLinkLost},
        {"kFaultConverter", rover::kFaultConverter},
        {"kFaultNoRecord", rover::kFaultNoRecord},
        {"kFaultNoCheckpoint", rover::kFaultNoCheckpoint},
        {"kTrapUndervoltage", rover::kTrapUndervoltage * 256U},
        {"kTrapBumper", rover::kTrapBumper * 256U},
    };
    const auto rows = table_of("### faults");
    ASSERT_EQ(rows.size(), bits.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i][1], bits[i].first);
        EXPECT_EQ(1U << std::stoul(rows[i][0]), bits[i].second);
        const bool stops = i >= 8 || (rover::kFaultsThatStop & 1U << i) != 0;
        EXPECT_EQ(rows[i][3], stops ? "off" : "");
    }
}

}  // namespace
