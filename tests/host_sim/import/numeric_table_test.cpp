// The strict table reader: what it accepts and, with the line, what it refuses.
#include "host_sim/import/numeric_table.hpp"

#include <gtest/gtest.h>

#include "host_sim/log/log_io.hpp"

namespace {

using host_sim::LogError;
using host_sim::NumericTable;
using host_sim::parse_numeric_table;

constexpr std::string_view kHeader = "t,a";

/// Line at which a text is refused; 0: accepted.
std::size_t refused_line(std::string_view text) {
    try {
        (void)parse_numeric_table(text, "x.csv", kHeader);
        return 0;
    } catch (const LogError& error) {
        EXPECT_EQ(error.file(), "x.csv");
        return error.line();
    }
}

TEST(NumericTable, ReadsValuesByRowAndColumn) {
    const NumericTable table = parse_numeric_table("t,a\n0,-1.5\n1,2.5e-3\n", "x.csv", kHeader);
    ASSERT_EQ(table.row_count(), 2U);
    EXPECT_EQ(table.at(0, 1), -1.5);
    EXPECT_EQ(table.at(1, 0), 1.0);
    EXPECT_EQ(table.at(1, 1), 0.0025);
    EXPECT_EQ(NumericTable::line(1), 3U);
}

TEST(NumericTable, AcceptsCarriageReturns) {
    EXPECT_EQ(parse_numeric_table("t,a\r\n0,1\r\n", "x.csv", kHeader).at(0, 1), 1.0);
}

TEST(NumericTable, RefusesAnotherHeader) {
    EXPECT_EQ(refused_line("t,b\n0,1\n"), 1U);
    EXPECT_EQ(refused_line("t\n0\n"), 1U);
    EXPECT_EQ(refused_line("a,t\n0,1\n"), 1U);
    EXPECT_EQ(refused_line(""), 1U);
}

TEST(NumericTable, RefusesMissingAndExtraFields) {
    EXPECT_EQ(refused_line("t,a\n0,1\n1\n"), 3U);
    EXPECT_EQ(refused_line("t,a\n0,1,2\n"), 2U);
    EXPECT_EQ(refused_line("t,a\n0,1,\n"), 2U);
    EXPECT_EQ(refused_line("t,a\n0,1,2,3\n"), 2U);
    EXPECT_EQ(refused_line("t,a\n0,1\n\n"), 3U) << "empty line";
}

TEST(NumericTable, RefusesWhatIsNotAFiniteNumber) {
    for (const std::string_view field : {"", "nan", "inf", "-inf", "1e999", "0x1", "1 ", " 1", "+1",
                                         "1.0.0", "one", "1\xC3\xA9"}) {
        EXPECT_EQ(refused_line("t,a\n0,1\n1," + std::string(field) + "\n"), 3U) << field;
    }
}

TEST(NumericTable, RefusesALastLineWithoutEnd) {
    EXPECT_EQ(refused_line("t,a\n0,1\n1,2"), 3U);
}

TEST(NumericTable, RefusesATableWithoutRows) {
    EXPECT_EQ(refused_line("t,a\n"), 2U);
}

TEST(NumericTable, RefusesAFileThatIsNotThere) {
    EXPECT_THROW((void)host_sim::read_numeric_table("/nonexistent/x.csv", kHeader), LogError);
}

// A file that is cut anywhere is refused, unless the cut falls between two rows.
TEST(NumericTable, RefusesEveryTornFile) {
    const std::string text = "t,a\n0,1.25\n1,2.5\n2,3.75\n";
    for (std::size_t size = 0; size < text.size(); ++size) {
        const bool between_rows = size > 4 && text[size - 1] == '\n';
        EXPECT_EQ(refused_line(text.substr(0, size)) == 0, between_rows) << size;
    }
}

TEST(TimeColumn, RefusesLateStartRepeatsStepsBackAndGaps) {
    const auto check = [](std::string_view rows) -> std::size_t {
        const NumericTable table =
            parse_numeric_table("t,a\n" + std::string(rows), "x.csv", kHeader);
        try {
            host_sim::check_time_column(table, 0, 0.5, 2, "s");
            return 0;
        } catch (const LogError& error) {
            return error.line();
        }
    };
    EXPECT_EQ(check("0,0\n1,0\n3,0\n"), 0U);
    EXPECT_EQ(check("0.6,0\n1,0\n"), 2U);
    EXPECT_EQ(check("-0.1,0\n1,0\n"), 2U);
    EXPECT_EQ(check("0,0\n1,0\n1,0\n"), 4U);
    EXPECT_EQ(check("0,0\n1,0\n0.9,0\n"), 4U);
    EXPECT_EQ(check("0,0\n2.1,0\n"), 3U);
}

TEST(MagnitudeColumn, RefusesBeyondTheLimitOfEitherSign) {
    const NumericTable table = parse_numeric_table("t,a\n0,5\n1,-5.1\n", "x.csv", kHeader);
    EXPECT_NO_THROW(host_sim::check_magnitude(table, 1, 5.1, "a"));
    EXPECT_THROW(host_sim::check_magnitude(table, 1, 5, "a"), LogError);
}

}  // namespace
