#include "host_sim/calibration/calibration_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>

#include "host_sim/log/log_io.hpp"

namespace {

using namespace host_sim;

void expect_equal(const hal::Calibration& a, const hal::Calibration& b) {
    EXPECT_EQ(a.version, b.version);
    for (std::size_t i = 0; i < hal::kAngleChannelCount; ++i) {
        EXPECT_EQ(a.angle[i].zero_q4_count, b.angle[i].zero_q4_count);
        EXPECT_EQ(a.angle[i].gain_q16, b.angle[i].gain_q16);
        EXPECT_EQ(a.angle[i].inverted, b.angle[i].inverted);
    }
    EXPECT_EQ(a.wheel_radius_q4_mm, b.wheel_radius_q4_mm);
    EXPECT_EQ(a.tach_counts_per_turn, b.tach_counts_per_turn);
    EXPECT_EQ(a.tach_q16_mm_per_count, b.tach_q16_mm_per_count);
    EXPECT_EQ(a.range_offset_q1_mm, b.range_offset_q1_mm);
}

hal::Calibration random_record(std::mt19937_64& random) {
    const auto between = [&](int low, int high) {
        return std::uniform_int_distribution<int>(low, high)(random);
    };
    hal::Calibration record;
    for (hal::AngleCalibration& angle : record.angle) {
        angle = {static_cast<std::uint16_t>(between(0, 65520)),
                 static_cast<std::uint16_t>(between(0, 65535)), between(0, 1) == 1};
    }
    record.wheel_radius_q4_mm = static_cast<std::uint16_t>(between(400, 3000));
    record.tach_counts_per_turn = static_cast<std::uint16_t>(between(1500, 9000));
    record.tach_q16_mm_per_count =
        static_cast<std::uint16_t>(std::lround(2 * std::numbers::pi * record.wheel_radius_q4_mm /
                                               16 / record.tach_counts_per_turn * 65536));
    record.range_offset_q1_mm = static_cast<std::int16_t>(between(-32768, 32767));
    return record;
}

TEST(CalibrationFile, RoundTripsAnyRecord) {
    constexpr std::uint64_t kSeed = 20240607;
    std::mt19937_64 random(kSeed);
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE(testing::Message() << "seed " << kSeed << " record " << i);
        const hal::Calibration record = random_record(random);
        const std::string text = encode_calibration(record, {"made by a test"});
        const hal::Calibration read = parse_calibration(text, "x.toml");
        expect_equal(read, record);
        EXPECT_EQ(encode_calibration(read, {"made by a test"}), text);
    }
}

TEST(CalibrationFile, WritesTheDocumentedText) {
    const std::string text = encode_calibration({}, {"by hand"});
    EXPECT_TRUE(
        text.starts_with("# by hand\nformat = \"rover85-calibration\"\nversion = 1\n\n"
                         "[wheel]\nradius_q4_mm = 1040\ntach_counts_per_turn = 2000\n"
                         "tach_q16_mm_per_count = 13383\n\n[range]\noffset_q1_mm = 0\n\n"
                         "[angle.bogie_left]\nzero_q4_count = 32760\ngain_q16 = 16384\n"
                         "inverted = false\n"))
        << text;
}

TEST(CalibrationFile, TheExampleOfTheSpecificationIsValid) {
    std::ifstream in(std::filesystem::path(ROVER_SOURCE_DIR) / "docs/spec/calibration.md");
    const std::string page{std::istreambuf_iterator<char>(in), {}};
    const std::size_t begin = page.find("```toml\n") + 8;
    ASSERT_LT(begin, page.size());
    const std::string example = page.substr(begin, page.find("```", begin) - begin);
    EXPECT_EQ(parse_calibration(example, "calibration.md").angle[2].gain_q16, 16384);
}

/// Line at which a changed text is refused; 0: accepted; 999: `from` is not in the text.
std::size_t refused_line(const std::string& from, const std::string& to) {
    std::string text = encode_calibration({});
    const std::size_t place = text.find(from);
    if (place == std::string::npos) return 999;
    text.replace(place, from.size(), to);
    try {
        (void)parse_calibration(text, "x.toml");
        return 0;
    } catch (const LogError& error) {
        return error.line() == 0 ? 998 : error.line();
    }
}

TEST(CalibrationFile, RefusesWithTheLine) {
    EXPECT_EQ(refused_line("rover85-calibration", "other"), 1U);
    EXPECT_EQ(refused_line("version = 1", "version = 2"), 2U);
    EXPECT_EQ(refused_line("version = 1", "version = 1.0"), 2U);
    EXPECT_EQ(refused_line("radius_q4_mm = 1040", "radius_q4_mm = 0"), 5U);
    EXPECT_EQ(refused_line("radius_q4_mm = 1040", "radius_q4_mm = 65536"), 5U);
    EXPECT_EQ(refused_line("radius_q4_mm = 1040", "radius_q4_mm = \"1040\""), 5U);
    EXPECT_EQ(refused_line("radius_q4_mm = 1040", "radius_q4_mm = 1060"), 4U) << "contradiction";
    EXPECT_EQ(refused_line("radius_q4_mm = 1040", "radius_q4_mm = 1045"), 0U) << "within 1 %";
    EXPECT_EQ(refused_line("offset_q1_mm = 0", "offset_q1_mm = 32768"), 10U);
    EXPECT_EQ(refused_line("zero_q4_count = 32760", "zero_q4_count = 65521"), 13U);
    EXPECT_EQ(refused_line("zero_q4_count = 32760", "zero_q4_count = -1"), 13U);
    EXPECT_EQ(refused_line("gain_q16 = 16384", "gain_q16 = 65536"), 14U);
    EXPECT_EQ(refused_line("inverted = false", "inverted = 0"), 15U);
    EXPECT_EQ(refused_line("inverted = false", "inverted = false\nspare = 1"), 16U);
    EXPECT_EQ(refused_line("[angle.roll]", "[angle.yaw]"), 998U - 998U + 12U);
    EXPECT_EQ(refused_line("gain_q16 = 16384\n", ""), 12U) << "missing key: its table's line";
    EXPECT_EQ(refused_line("inverted = false", "inverted = false\ninverted = true"), 16U);
    EXPECT_EQ(refused_line("[wheel]", "[wheel"), 4U);
}

// Cut anywhere, the text is refused, but for a cut in its last line end.
TEST(CalibrationFile, RefusesEveryTornFile) {
    const std::string text = encode_calibration({});
    for (std::size_t size = 0; size + 1 < text.size(); ++size) {
        EXPECT_THROW((void)parse_calibration(text.substr(0, size), "x.toml"), LogError) << size;
    }
}

TEST(CalibrationFile, RefusesToWriteAContradiction) {
    hal::Calibration record;
    record.tach_counts_per_turn = 1000;
    EXPECT_THROW((void)encode_calibration(record), LogError);
}

TEST(CalibrationFile, SavesAndLoadsAndNamesTheFileInErrors) {
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / "calibration_file_test.toml";
    hal::Calibration record;
    record.angle[1].gain_q16 = 16000;
    save_calibration(path, record, {"a", "b"});
    save_calibration(path, record, {"a", "b"});  // replaces
    expect_equal(load_calibration(path), record);
    std::filesystem::remove(path);
    EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
    try {
        (void)load_calibration(path);
        FAIL();
    } catch (const LogError& error) {
        EXPECT_EQ(error.file(), path.string());
    }
    EXPECT_THROW(save_calibration("/nonexistent/x.toml", record), LogError);
}

}  // namespace
