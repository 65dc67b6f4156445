// spec_test.cpp - docs/spec/loader.md says what the code does.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "firmware/executive/battery_area.hpp"
#include "firmware/loader/protocol.hpp"
#include "tests/support/page_table.hpp"

namespace {

using namespace rover::loader;
using test_support::Row;

std::vector<Row> table(const std::string& heading) {
    return test_support::table_of("docs/spec/loader.md", heading);
}

int hexadecimal(const std::string& text) {
    return std::stoi(text, nullptr, 16);
}

TEST(LoaderPage, HasTheMemory) {
    const auto rows = table("## EEPROM");
    ASSERT_EQ(rows.size(), 4u);
    const auto range = [](int first, int last) {
        char text[10];
        std::snprintf(text, sizeof text, "%04X-%04X", first, last);
        return std::string(text);
    };
    EXPECT_EQ(rows[0][0], range(0, kStartLast));
    EXPECT_EQ(rows[1][0], range(kStoredProgramFirst, kLoaderLast));
    EXPECT_EQ(rows[2][0], range(kApplicationFirst, kApplicationLast));
    EXPECT_EQ(rows[3][0], range(kRecordPage, kRecordPage + kPageSize - 1));
}

TEST(LoaderPage, HasTheBootRecord) {
    const auto rows = table("## Boot record");
    const std::vector<std::size_t> offsets = {
        offsetof(BootRecord, magic), offsetof(BootRecord, image_size),
        offsetof(BootRecord, image_crc), offsetof(BootRecord, identity_at),
        offsetof(BootRecord, crc)};
    ASSERT_EQ(rows.size(), offsets.size());
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i][0], std::to_string(offsets[i]));
    EXPECT_EQ(rows[0][2], std::string(kRecordMagic, kRecordMagic + 4));
    EXPECT_EQ(kBootRecordChecked, offsets.back());
}

TEST(LoaderPage, HasEveryRequest) {
    const std::vector<std::pair<Request, std::string>> requests = {
        {Request::hello, "hello"}, {Request::open, "open"}, {Request::write, "write"},
        {Request::check, "check"}, {Request::read, "read"}, {Request::close, "close"},
        {Request::start, "start"}};
    const auto rows = table("## Frames");
    ASSERT_EQ(rows.size(), requests.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(hexadecimal(rows[i][0]), static_cast<int>(requests[i].first));
        EXPECT_EQ(rows[i][1], requests[i].second);
    }
    EXPECT_NE(rows[3][2].find(std::to_string(kChecksMax)), std::string::npos);
    EXPECT_NE(rows[4][2].find(std::to_string(kPageSize)), std::string::npos);
}

TEST(LoaderPage, HasEveryResult) {
    const std::vector<std::string> names = {
        "done",    "unknown_type", "wrong_size",       "wrong_address", "not_open",    "no_end",
        "differs", "no_identity",  "wrong_image_size", "wrong_crc",     "not_bootable"};
    EXPECT_EQ(static_cast<int>(Result::done), 0);
    EXPECT_EQ(static_cast<int>(Result::wrong_address), 3);
    EXPECT_EQ(static_cast<int>(Result::no_end), 5);
    EXPECT_EQ(static_cast<int>(Result::wrong_crc), 9);
    EXPECT_EQ(static_cast<int>(Result::not_bootable), 10);
    const auto rows = test_support::table_of("docs/spec/loader.md", "### report");
    ASSERT_EQ(rows.size(), 4u);  // the report's fields; the results' table follows them
    EXPECT_EQ(rows[1][0], std::to_string(offsetof(Report, address)));
    EXPECT_EQ(rows[2][0], std::to_string(offsetof(Report, expected)));
    EXPECT_EQ(rows[3][0], std::to_string(offsetof(Report, found)));
    const auto results = table("### Results");
    ASSERT_EQ(results.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_EQ(results[i][0], std::to_string(i));
        EXPECT_EQ(results[i][1], names[i]);
    }
}

TEST(LoaderPage, HasTheHello) {
    const auto rows = table("### hello");
    const std::vector<std::size_t> offsets = {
        offsetof(Hello, protocol_version),  offsetof(Hello, loader_version),
        offsetof(Hello, application_first), offsetof(Hello, application_end),
        offsetof(Hello, page_size),         offsetof(Hello, entry),
        offsetof(Hello, is_open),           offsetof(Hello, bootable),
        offsetof(Hello, identity)};
    ASSERT_EQ(rows.size(), offsets.size());
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i][0], std::to_string(offsets[i]));
}

TEST(LoaderPage, HasTheTimesAndTheMark) {
    EXPECT_EQ(kListenMs, 60);
    EXPECT_EQ(kPatienceMs, 3000);
    EXPECT_EQ(static_cast<int>(rover::RunMark::loader), 0x4C);
    EXPECT_EQ(static_cast<int>(rover::RunMark::warm_restart), 0x57);
}

}  // namespace
