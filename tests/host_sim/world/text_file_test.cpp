// text_file_test.cpp - reading files and CSV rows, every refusal.
#include "host_sim/world/text_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "host_sim/world/input_error.hpp"

namespace host_sim {
namespace {

TEST(InputError, NamesFileAndLine) {
    EXPECT_STREQ(input_error("a.csv", 12, "is wrong").what(), "a.csv:12: is wrong");
}

TEST(ReadTextFile, ReadsEveryByteAndRefusesWhatIsNoFile) {
    const std::string path = ::testing::TempDir() + "rover85_text_file_test.txt";
    const std::string bytes("a\r\n\0\xFF z", 7);
    std::ofstream(path, std::ios::binary) << bytes;
    EXPECT_EQ(read_text_file(path), bytes);
    std::remove(path.c_str());
    EXPECT_THROW(read_text_file(path), InputError);
    EXPECT_THROW(read_text_file("/"), InputError);
}

TEST(ParseNumber, TakesFiniteDecimalNumbersThatFillTheField) {
    double value = 0;
    EXPECT_TRUE(parse_number(" -1.5e2\t", value));
    EXPECT_EQ(value, -150);
    for (const char* bad :
         {"", " ", "1x", "x", "+1", "1 2", "0x10", "nan", "inf", "1e999", "--1"}) {
        EXPECT_FALSE(parse_number(bad, value)) << bad;
    }
}

TEST(CsvRows, SkipsEmptyLinesAndCountsThem) {
    CsvRows rows("\na,b\r\n\n1, 2\n3,4", "t.csv");
    EXPECT_EQ(rows.column("b"), 1u);
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.number(0), 1);
    EXPECT_EQ(rows.number(1), 2);
    EXPECT_STREQ(rows.wrong("x").what(), "t.csv:4: x");
    ASSERT_TRUE(rows.next());
    EXPECT_EQ(rows.text(1), "4");
    EXPECT_STREQ(rows.wrong("x").what(), "t.csv:5: x");
    EXPECT_FALSE(rows.next());
}

TEST(CsvRows, RefusesRowsOfAnotherWidthAndUnknownColumns) {
    CsvRows rows("a,b\n1,2,3\n", "t.csv");
    EXPECT_THROW(static_cast<void>(rows.column("c")), InputError);
    EXPECT_THROW(rows.next(), InputError);
    EXPECT_THROW(CsvRows("\n\n", "t.csv"), InputError);
    CsvRows twice("a,a\n", "t.csv");
    EXPECT_THROW(static_cast<void>(twice.column("a")), InputError);
    CsvRows empty_field("a,b\n1,\n", "t.csv");
    ASSERT_TRUE(empty_field.next());
    EXPECT_THROW(static_cast<void>(empty_field.number(1)), InputError);
}

}  // namespace
}  // namespace host_sim
