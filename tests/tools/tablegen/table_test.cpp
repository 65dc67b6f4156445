// table_test.cpp - tables against independent values, and the committed headers against tablegen.
#include "tools/tablegen/table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "tools/tablegen/accuracy.hpp"

namespace {

const std::filesystem::path kRoot{ROVER_SOURCE_DIR};

TEST(FirmwareTables, AreTheCommittedHeadersByteForByte) {
    for (const tablegen::Table& table : tablegen::firmware_tables()) {
        std::ifstream in(kRoot / table.folder / table.file, std::ios::binary);
        ASSERT_TRUE(in) << table.file << " is missing: run `tablegen write`";
        const std::string committed{std::istreambuf_iterator<char>(in), {}};
        EXPECT_EQ(committed, tablegen::render(table))
            << table.file << " differs: run `tablegen write`";
    }
}

TEST(FirmwareTables, AreAllOfTheirFolders) {
    std::set<std::filesystem::path> expected;
    std::set<std::filesystem::path> folders;
    for (const tablegen::Table& table : tablegen::firmware_tables()) {
        folders.insert(kRoot / table.folder);
        expected.insert(kRoot / table.folder / table.file);
    }
    std::set<std::filesystem::path> found;
    for (const auto& folder : folders) {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            found.insert(entry.path());
        }
    }
    EXPECT_EQ(found, expected);
}

// Values from printed tables: sin 30 deg = 1/2, sin 45 deg = 0.70710678, atan 1 = 1/8 turn,
// atan 1/2 = 26.565051 deg.
TEST(SineTable, HoldsTheKnownValues) {
    const auto values = tablegen::sine_table().values;
    ASSERT_EQ(values.size(), 130u);
    EXPECT_EQ(values[0], 0);
    EXPECT_EQ(values[64], 11585);   // 16384 * 0.70710678 = 11585.24
    EXPECT_EQ(values[128], 16383);  // saturated
    EXPECT_EQ(values[129], 16383);
}

TEST(ArctangentTable, HoldsTheKnownValues) {
    const auto values = tablegen::arctangent_table().values;
    ASSERT_EQ(values.size(), 129u);
    EXPECT_EQ(values[0], 0);
    EXPECT_EQ(values[64], 19344);  // 26.565051 / 360 * 262144 = 19344.0
    EXPECT_EQ(values[128], 32768);
}

TEST(SquareTable, RoundsAndSaturates) {
    const auto values = tablegen::square_table("kSquare", 256, 1.5).values;
    ASSERT_EQ(values.size(), 256u);
    EXPECT_EQ(values[1], 2);        // 1.5 away from zero
    EXPECT_EQ(values[2], 6);        // 6.0
    EXPECT_EQ(values[209], 65522);  // 65521.5
    EXPECT_EQ(values[210], 65535);  // 66150 saturates
    EXPECT_EQ(values[255], 65535);
}

// 8 steps are one sigma, whose square is 8; step 128 + n lies between n and n + 1.
TEST(MatchSquareTable, HoldsTheKnownValues) {
    const auto table = tablegen::match_square_table();
    ASSERT_EQ(table.values.size(), 256u);
    EXPECT_EQ(table.values[128], 0);         // 0.03
    EXPECT_EQ(table.values[128 + 7], 7);     // 7.03
    EXPECT_EQ(table.values[128 + 8], 9);     // 9.03
    EXPECT_EQ(table.values[128 - 8], 7);     // -7.5 steps
    EXPECT_EQ(table.values[128 + 44], 248);  // 247.5
    EXPECT_EQ(table.values[128 + 45], 255);  // 258.8 saturates
    EXPECT_EQ(table.values[0], 255);
    EXPECT_NE(tablegen::render(table).find("alignas(256) inline constexpr uint8_t kSquareQ3[256]"),
              std::string::npos);
}

TEST(SquareTable, RefusesImpossibleArguments) {
    EXPECT_THROW(tablegen::square_table("kSquare", 0, 1.0), std::invalid_argument);
    EXPECT_THROW(tablegen::square_table("kSquare", 65537, 1.0), std::invalid_argument);
    EXPECT_THROW(tablegen::square_table("kSquare", 256, -1.0), std::invalid_argument);
    EXPECT_THROW(tablegen::square_table("kSquare", 256, std::nan("")), std::invalid_argument);
}

TEST(InterpolationError, OfAParabolaIsAQuarterOfItsStep) {
    // A chord of x^2 over a unit interval is at most 1/4 above it; table values are exact here.
    EXPECT_NEAR(tablegen::interpolation_error({0, 1, 4, 9}, [](double x) { return x * x; }), 0.25,
                1e-12);
}

TEST(Render, IsAHeaderWithEveryValue) {
    const std::string text = tablegen::render(tablegen::square_table("kSquare", 3, 2.0));
    EXPECT_NE(text.find("// square_table.hpp - "), std::string::npos);
    EXPECT_NE(text.find("inline constexpr uint16_t kSquare[3] = {\n    0, 2, 8,  // 0\n};"),
              std::string::npos)
        << text;
}

TEST(MeasuredAccuracy, IsWithinTheDocumentedBounds) {
    for (const tablegen::Accuracy& row : tablegen::measure_accuracy()) {
        EXPECT_GT(row.count, 65535u) << row.function;
        EXPECT_LE(row.max_error, row.bound + 1e-9) << row.function;
        EXPECT_LE(row.mean_error, row.max_error) << row.function;
    }
}

}  // namespace
