// csv_test.cpp - the wide CSV against docs/spec/log-format.md: round trip, every refusal with its
// line, what hand-written files may leave out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "host_sim/log/log_io.hpp"
#include "log_samples.hpp"
#include "rlog_builder.hpp"

namespace {

using host_sim::encode_csv;
using host_sim::encode_rlog;
using host_sim::Log;
using host_sim::LogError;
using host_sim::read_csv;
using log_test::small_log;
using testing::HasSubstr;
using testing::StartsWith;

testing::AssertionResult refused_at(const std::string& text, std::uint64_t line,
                                    const std::string& what) {
    try {
        read_csv(text, "x.csv");
        return testing::AssertionFailure()
               << "accepted (expected line " << line << ": " << what << ")";
    } catch (const LogError& error) {
        const std::string message = error.what();
        const std::string place = line == 0 ? "x.csv: " : "x.csv:" + std::to_string(line) + ": ";
        if (error.line() == line && message.starts_with(place) &&
            message.find(what) != std::string::npos && message.find("; ") != std::string::npos &&
            message.find('\n') == std::string::npos) {
            return testing::AssertionSuccess();
        }
        return testing::AssertionFailure()
               << message << " (expected line " << line << ": " << what << ")";
    }
}

/// The checksum line of the specification for `content`, by the independent CRC.
std::string checksum_line(const std::string& content, int rows) {
    log_test::BitwiseCrc crc;
    crc.add(content);
    char line[64];
    std::snprintf(line, sizeof line, "# crc32 %08X rows %d\n", crc.value(), rows);
    return line;
}

RC_GTEST_PROP(Csv, RoundTripGivesTheSameLog, (std::uint64_t seed)) {
    Log log = log_test::LogMaker(seed).make(*rc::gen::inRange<std::size_t>(0, 30));
    for (host_sim::LogStep& step : log.steps) {
        step.restart = static_cast<host_sim::Restart>(*rc::gen::inRange<int>(0, 3));
    }
    const std::string text = encode_csv(log);
    const Log again = read_csv(text, "x");
    RC_ASSERT(log_test::same(again, log));
    RC_ASSERT(!again.unverified);
    RC_ASSERT(encode_csv(again) == text);
}

RC_GTEST_PROP(Csv, ConversionToRlogAndBackIsLossless, (std::uint64_t seed)) {
    Log log = log_test::LogMaker(seed).make(*rc::gen::inRange<std::size_t>(0, 30));
    for (host_sim::LogStep& step : log.steps) {
        step.restart = static_cast<host_sim::Restart>(*rc::gen::inRange<int>(0, 3));
    }
    const std::string bytes = encode_rlog(log);
    const std::string text = encode_csv(host_sim::read_rlog(bytes, "x"));
    RC_ASSERT(encode_rlog(read_csv(text, "x")) == bytes);
    RC_ASSERT(encode_csv(host_sim::read_rlog(encode_rlog(read_csv(text, "x")), "x")) == text);
}

TEST(Csv, TheExampleOfTheSpecificationReadsAsItSays) {
    const std::string content =
        "# rover85-log 1\n"
        "# image = rover85 0.1.0 3f2a9c1d\n"
        "# calibration.bogie_left.zero_q4_count = 32760\n"
        "# note.seed = 7\n"
        "# vehicle: name = \"rocky 3.2\"\n"
        "## free comment\n"
        "time_ms,tick_count,bogie_left_q4_count,tach_front_left_count\n"
        "100,10,32760,53\n"
        "200,20,,106\n";
    ASSERT_EQ(checksum_line(content, 2), "# crc32 FEA7E595 rows 2\n");
    const Log log = read_csv(content + checksum_line(content, 2), "x");
    EXPECT_FALSE(log.unverified);
    EXPECT_EQ(log.head.vehicle, "name = \"rocky 3.2\"");
    EXPECT_EQ(log.head.image_identity, "rover85 0.1.0 3f2a9c1d");
    EXPECT_EQ(log.head.notes, (std::map<std::string, std::string>{{"seed", "7"}}));
    ASSERT_EQ(log.steps.size(), 2u);
    EXPECT_EQ(log.steps[1].time_ms, 200u);
    EXPECT_EQ(log.steps[1].inputs.tick_count, 20);
    EXPECT_EQ(log.steps[0].inputs.adc_q4_count[0], 32760);
    EXPECT_EQ(log.steps[1].inputs.adc_q4_count[0], hal::kAdcAbsent);
    EXPECT_EQ(log.steps[1].inputs.tach_present, 1);
    EXPECT_EQ(log.steps[1].inputs.tach_count[0], 106);
    EXPECT_FALSE(log.steps[0].truth || log.steps[0].estimates || log.steps[0].commands);
}

TEST(Csv, TimeAloneIsALogWithAllSensorsAbsent) {
    const Log log = read_csv("time_ms\n100\n655360\n", "x");
    EXPECT_TRUE(log.unverified);
    ASSERT_EQ(log.steps.size(), 2u);
    for (const std::uint16_t count : log.steps[0].inputs.adc_q4_count) {
        EXPECT_EQ(count, hal::kAdcAbsent);
    }
    EXPECT_EQ(log.steps[0].inputs.tach_present, 0);
    EXPECT_EQ(log.steps[0].inputs.range_present, 0);
    EXPECT_EQ(log.steps[0].inputs.tick_count, 10) << "time / 10";
    EXPECT_EQ(log.steps[1].inputs.tick_count, 0) << "modulo 2^16";
    EXPECT_EQ(log.head.calibration.wheel_radius_q4_mm, 1040) << "nominal";
}

TEST(Csv, ColumnsComeInAnyOrder) {
    const Log log = read_csv("time_ms,roll_q4_count,tick_count\n5,1,2\n", "x");
    EXPECT_EQ(log.steps.at(0).inputs.adc_q4_count[4], 1);
    EXPECT_EQ(log.steps.at(0).inputs.tick_count, 2);
}

TEST(Csv, ByteOrderMarkAndCarriageReturnsAreAcceptedAndKeepTheChecksum) {
    std::string text = encode_csv(small_log());
    std::string converted = "\xEF\xBB\xBF";
    for (const char character : text) {
        if (character == '\n') converted += '\r';
        converted += character;
    }
    const Log log = read_csv(converted, "x");
    EXPECT_TRUE(log_test::same(log, small_log()));
    EXPECT_FALSE(log.unverified);
    std::istringstream in(converted);
    EXPECT_TRUE(log_test::same(read_csv(in, "x"), small_log()));
}

TEST(Csv, ChecksumLineIsWrittenUnlessAskedOtherwise) {
    const std::string with = encode_csv(small_log());
    const std::string without = encode_csv(small_log(), {.checksum = false});
    EXPECT_EQ(with, without + checksum_line(without, 3));
    EXPECT_FALSE(read_csv(with, "x").unverified);
    EXPECT_TRUE(read_csv(without, "x").unverified);
}

TEST(Csv, ColumnsThatSayNothingAreLeftOut) {
    Log log = small_log(2);
    for (auto& step : log.steps) {
        step.truth.reset();
        step.estimates.reset();
        step.commands.reset();
    }
    EXPECT_THAT(encode_csv(log),
                HasSubstr("\ntime_ms,tick_count,bogie_left_q4_count,tach_front_left_count,"
                          "tach_front_right_count,tach_middle_left_count,tach_middle_right_count,"
                          "tach_rear_left_count,tach_rear_right_count,range_scan_count,"
                          "range_1_q1_mm,range_2_q1_mm\n"
                          "100,10,32760,0,0,0,0,0,0,0,-12,0\n"));
}

TEST(Csv, TruthCellsAreUnknownOneByOneAndAbsentTogether) {
    const std::string header = "time_ms,truth_position_mm,truth_slip\n";
    const Log log = read_csv(header + "1,2.5,\n2,,\n3,nan,-1e-3\n4,nan,nan\n", "x");
    EXPECT_EQ(log.steps[0].truth->position_mm, 2.5);
    EXPECT_TRUE(std::isnan(log.steps[0].truth->slip));
    EXPECT_TRUE(std::isnan(log.steps[0].truth->sinkage_mm)) << "column missing";
    EXPECT_FALSE(log.steps[1].truth.has_value());
    EXPECT_EQ(log.steps[2].truth->slip, -0.001);
    EXPECT_TRUE(log.steps[3].truth.has_value());
}

TEST(Csv, RefusesWrongCellsWithLineAndColumn) {
    const auto row = [](const std::string& column, const std::string& cell) {
        return "time_ms," + column + "\n1," + cell + "\n";
    };
    struct Case {
        const char* column;
        const char* cell;
        const char* what;
    };
    for (const Case& wrong : std::initializer_list<Case>{
             {"tick_count", "", "the empty cell must hold a number"},
             {"tick_count", "65536", "\"65536\" is not a whole number in [0, 65535]"},
             {"tick_count", "-1", "[0, 65535]"},
             {"tick_count", "1 ", "\"1 \""},
             {"tick_count", " 1", "\" 1\""},
             {"tick_count", "+1", "\"+1\""},
             {"tick_count", "1.0", "\"1.0\""},
             {"tick_count", "0x10", "\"0x10\""},
             {"tick_count", "99999999999999999999", "not a whole number"},
             {"tick_count", "\"1\"", "not a whole number"},
             {"pitch_q4_count", "65521", "[0, 65520]"},
             {"pitch_q4_count", "nan", "[0, 65520]"},
             {"tach_rear_left_count", "1e3", "[0, 65535]"},
             {"detector_bits", "256", "[0, 255]"},
             {"detector_bits", "", "must hold a number"},
             {"range_scan_count", "", "must hold a number"},
             {"received_hex", "abc", "3 hexadecimal digits"},
             {"received_hex", "0g", "something else than hexadecimal"},
             {"received_hex", "-1", "something else than hexadecimal"},
             {"received_hex", "000102030405060708090a0b0c0d0e0f10", "up to 32"},
             {"truth_position_mm", "inf", "neither a finite number nor nan"},
             {"truth_position_mm", "-nan", "neither"},
             {"truth_position_mm", "nan(1)", "neither"},
             {"truth_position_mm", "1e999", "neither"},
             {"truth_position_mm", "1.5x", "neither"},
             {"truth_position_mm", "1;5", "neither"},
         }) {
        EXPECT_TRUE(refused_at(row(wrong.column, wrong.cell), 2,
                               std::string("column ") + wrong.column + ": "));
        EXPECT_TRUE(refused_at(row(wrong.column, wrong.cell), 2, wrong.what));
    }
    EXPECT_TRUE(
        refused_at("time_ms,range_scan_count,range_8_q1_mm\n1,0,-32769\n", 2,
                   "column range_8_q1_mm: \"-32769\" is not a whole number in [-32768, 32767]"));
}

TEST(Csv, RefusesTimeThatIsNotIncreasingOrNotANumber) {
    EXPECT_TRUE(refused_at("time_ms\n5\n5\n", 3, "column time_ms: \"5\" comes after 5"));
    EXPECT_TRUE(refused_at("time_ms\n5\n6\n4\n", 4, "time must increase"));
    EXPECT_TRUE(refused_at("time_ms\n-1\n", 2, "column time_ms"));
    EXPECT_TRUE(refused_at("time_ms\n4294967296\n", 2, "column time_ms"));
    EXPECT_TRUE(refused_at("time_ms\n1.5\n", 2, "column time_ms"));
    EXPECT_TRUE(refused_at("time_ms,tick_count\n,1\n", 2, "column time_ms: the empty cell"));
    EXPECT_EQ(read_csv("time_ms\n4294967295\n", "x").steps[0].time_ms, 4294967295u);
}

TEST(Csv, RefusesRowsWithAnotherNumberOfCells) {
    EXPECT_TRUE(refused_at("time_ms,tick_count\n1,1\n2\n", 3, "1 cells where the header has 2"));
    EXPECT_TRUE(refused_at("time_ms,tick_count\n1,1,\n", 2, "3 cells where the header has 2"));
    EXPECT_TRUE(refused_at("time_ms,tick_count\n\n", 2, "1 cells where the header has 2"));
    EXPECT_TRUE(refused_at("time_ms\n\n", 2, "time_ms"));
}

TEST(Csv, TheRestartColumnIsWrittenOnlyWhereThereIsOne) {
    Log log = log_test::small_log(3);
    EXPECT_EQ(encode_csv(log).find("restart"), std::string::npos);
    log.steps[1].restart = host_sim::Restart::warm;
    log.steps[2].restart = host_sim::Restart::cold;
    const std::string text = encode_csv(log);
    EXPECT_NE(text.find("\ntime_ms,restart,tick_count,"), std::string::npos);
    EXPECT_TRUE(log_test::same(read_csv(text, "x"), log));
    const Log by_hand =
        read_csv("time_ms,roll_q4_count,restart\n100,1,\n200,2,warm\n300,,cold\n", "x");
    EXPECT_EQ(by_hand.steps[0].restart, host_sim::Restart::none);
    EXPECT_EQ(by_hand.steps[1].restart, host_sim::Restart::warm);
    EXPECT_EQ(by_hand.steps[2].restart, host_sim::Restart::cold);
    EXPECT_TRUE(refused_at("time_ms,restart\n1,hot\n", 2, "column restart: \"hot\" is not warm"));
    EXPECT_TRUE(refused_at("time_ms,restart,restart\n", 1, "column restart appears twice"));
}

TEST(Csv, RefusesWrongHeaderLines) {
    EXPECT_TRUE(refused_at("time_ms,tick\n", 1, "unknown column \"tick\""));
    EXPECT_TRUE(refused_at("time_ms,\n", 1, "unknown column \"\""));
    EXPECT_TRUE(
        refused_at("time_ms,tick_count,tick_count\n", 1, "column tick_count appears twice"));
    EXPECT_TRUE(refused_at("time_ms,time_ms\n", 1, "time_ms appears twice"));
    EXPECT_TRUE(refused_at("tick_count,time_ms\n", 1, "first column is \"tick_count\""));
    EXPECT_TRUE(refused_at("time_ms;tick_count\n", 1, "first column is \"time_ms;tick_count\""));
    EXPECT_TRUE(refused_at("time_ms;tick_count\n", 1, "; separate columns by commas"));
    EXPECT_TRUE(refused_at("time\ttick\n", 1, "; separate columns by commas"));
    EXPECT_TRUE(refused_at("\n", 1, "first column is \"\""));
    EXPECT_TRUE(
        refused_at("## only a comment\n", 1, "header line with the column names is missing"));
    EXPECT_TRUE(refused_at("time_ms,range_3_q1_mm\n", 1, "range_scan_count is missing"));
    EXPECT_TRUE(refused_at("time_ms,estimate_mode\n", 1, "estimate_step_count is missing"));
    EXPECT_TRUE(refused_at("time_ms,command_mast_brad\n", 1,
                           "command_drive_front_left_percent is missing"));
}

TEST(Csv, RefusesFilesThatAreCutOffOrNotText) {
    EXPECT_TRUE(refused_at("", 0, "the file is empty"));
    EXPECT_TRUE(refused_at("time_ms\n1", 2, "cut off"));
    EXPECT_TRUE(refused_at("time_ms", 1, "cut off"));
    EXPECT_TRUE(refused_at(std::string("time_ms\n1\n\0\n", 12), 3, "NUL"));
    EXPECT_TRUE(refused_at(std::string("\xFF\xFE"
                                       "t\0i\0",
                                       6),
                           1, "NUL"));  // UTF-16
    EXPECT_TRUE(
        refused_at("\x7F"
                   "ELF\n",
                   1, "first column"));
    // Every cut of a checksummed file inside a line is refused; at the end of a line the loss of
    // the checksum line shows as "unverified".
    const std::string text = encode_csv(small_log());
    for (std::size_t size = 0; size < text.size(); ++size) {
        try {
            EXPECT_TRUE(read_csv(text.substr(0, size), "x").unverified) << size;
            EXPECT_EQ(text[size - 1], '\n') << size;
        } catch (const LogError&) {
        }
    }
}

TEST(Csv, RefusesWrongMetadata) {
    const auto before = [](const std::string& line) { return "## first\n" + line + "\ntime_ms\n"; };
    EXPECT_TRUE(refused_at("# rover85-log 2\ntime_ms\n", 1, "format version \"2\""));
    EXPECT_TRUE(refused_at(before("# rover85-log 1"), 2, "not the first line"));
    EXPECT_TRUE(refused_at(before("# hello"), 2, "unknown metadata \"# hello\""));
    EXPECT_TRUE(refused_at(before("#note.a = 1"), 2, "unknown metadata"));
    EXPECT_TRUE(refused_at(before("# author = me"), 2, "unknown metadata \"author\""));
    EXPECT_TRUE(refused_at(before("# note.a b = 1"), 2, "unknown metadata"));
    EXPECT_TRUE(refused_at(before("# note.a = \\q"), 2, "unknown escape"));
    EXPECT_TRUE(refused_at(before("# note.a = \\x0"), 2, "unknown escape"));
    EXPECT_TRUE(refused_at(before("# note.a = \\"), 2, "unknown escape"));
    EXPECT_TRUE(refused_at(before("# note.a = \\x00"), 2, "NUL"));
    EXPECT_TRUE(refused_at(before("# vehicle: \xFF"), 2, "UTF-8"));
    EXPECT_TRUE(
        refused_at("# note.a = 1\n# note.a = 1\ntime_ms\n", 2, "\"note.a\" is given twice"));
    EXPECT_TRUE(refused_at("# image = 1\n# image = 2\ntime_ms\n", 2, "twice"));
    EXPECT_TRUE(refused_at(before("# calibration.pitch.gain = 1"), 2, "unknown calibration value"));
    EXPECT_TRUE(refused_at(before("# calibration.pitch.gain_q16 = 65536"), 2, "[0, 65535]"));
    EXPECT_TRUE(refused_at(before("# calibration.pitch.gain_q16 ="), 2, "not a whole number"));
    EXPECT_TRUE(
        refused_at(before("# calibration.pitch.inverted = 1"), 2, "neither true nor false"));
    EXPECT_TRUE(refused_at(before("# crc32 00000000 rows 0"), 2, "before the header line"));
    EXPECT_TRUE(refused_at("time_ms\n1\n# note.a = 1\n", 3, "comment after the header line"));
    EXPECT_TRUE(refused_at("time_ms\n1\n## free\n", 3, "comment after the header line"));
}

TEST(Csv, TextsKeepEveryCharacterAndAreOneLineEach) {
    Log log;
    log.head.vehicle = "\n  a = \"\\n\"  \n\tb\r\n \n\n";
    log.head.notes = {{"empty", ""}, {"odd", " a = b\\\x01\n"}, {"utf8", "\xC3\xA9"}};
    const std::string text = encode_csv(log);
    EXPECT_THAT(text, HasSubstr("# note.empty =\n# note.odd = \\x20a = b\\\\\\x01\\n\n"
                                "# note.utf8 = \xC3\xA9\n"
                                "# vehicle:\n# vehicle:   a = \"\\\\n\" \\x20\n"
                                "# vehicle: \tb\\r\n# vehicle: \\x20\n# vehicle:\n# vehicle:\n"));
    EXPECT_TRUE(log_test::same(read_csv(text, "x"), log));
}

TEST(Csv, CalibrationIsReadByName) {
    const Log log = read_csv(
        "# calibration.roll.inverted = true\n# calibration.range_offset_q1_mm = -7\ntime_ms\n",
        "x");
    EXPECT_TRUE(log.head.calibration.angle[4].inverted);
    EXPECT_EQ(log.head.calibration.range_offset_q1_mm, -7);
}

TEST(Csv, EstimatesAndCommandsAreWholeInARowOrAbsent) {
    Log log = small_log(2);
    log.steps[0].estimates.reset();
    log.steps[1].commands.reset();
    const std::string text = encode_csv(log, {.checksum = false});
    EXPECT_TRUE(log_test::same(read_csv(text, "x"), log));
    std::string broken = text;  // empties the mode of the second step
    const std::size_t mode = broken.rfind("odometry_only");
    broken.erase(mode, 13);
    const auto line = static_cast<std::uint64_t>(std::count(text.begin(), text.end(), '\n'));
    EXPECT_TRUE(refused_at(broken, line, "column estimate_mode: the empty cell has neighbours"));
    broken = text;
    broken.replace(mode, 13, "flying");
    EXPECT_TRUE(refused_at(broken, line, "column estimate_mode: \"flying\" is not a slip mode"));
    broken = text;  // telemetry without a command
    broken.insert(broken.size() - 1, "a5");
    EXPECT_TRUE(
        refused_at(broken, line, "column command_drive_front_left_percent: the empty cell"));
}

TEST(Csv, ChecksumLineIsVerified) {
    const std::string content = "time_ms,tick_count\n1,7\n2,8\n";
    const std::string good = checksum_line(content, 2);
    EXPECT_FALSE(read_csv(content + good, "x").unverified);
    const std::string edited = "time_ms,tick_count\n1,7\n2,9\n";
    EXPECT_TRUE(refused_at(edited + good, 4, "the file was changed after it was written"));
    EXPECT_TRUE(refused_at(edited + good, 4, "delete this line if you edited the file by hand"));
    EXPECT_TRUE(refused_at(content + checksum_line(content, 3), 4, "changed"));
    std::string lower = good;
    for (char& character : lower) {
        character =
            character >= 'A' && character <= 'F' ? static_cast<char>(character | 0x20) : character;
    }
    ASSERT_NE(lower, good) << "this CRC has letters";
    EXPECT_TRUE(refused_at(content + lower, 4, "changed"));
    EXPECT_TRUE(refused_at(content + "# crc32 \n", 4, "changed"));
    EXPECT_TRUE(refused_at(content + good + "3,9\n", 5, "content after the checksum line"));
    EXPECT_TRUE(refused_at(content + good + good, 5, "content after the checksum line"));
}

TEST(Csv, EverySingleBitFlipOfAChecksummedFileIsRefused) {
    const std::string text = encode_csv(small_log());
    for (std::size_t bit = 0; bit < 8 * text.size(); ++bit) {
        std::string flipped = text;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
        EXPECT_THROW(read_csv(flipped, "x"), LogError)
            << "bit " << bit % 8 << " of byte " << bit / 8;
    }
}

TEST(Csv, RandomDamageIsRefusedOrShowsAsUnverified) {
    constexpr std::uint64_t kSeed = 86;
    std::cout << "seed " << kSeed << '\n';
    std::mt19937_64 random(kSeed);
    const std::string text = encode_csv(small_log());
    std::size_t refused = 0;
    for (int trial = 0; trial < 20'000; ++trial) {
        std::string damaged = text;
        for (std::uint64_t i = random() % 8 + 1; i > 0; --i) {
            const auto at = static_cast<std::size_t>(random() % damaged.size());
            if (random() % 3 == 0) {
                damaged.erase(at, random() % 40);
            } else {
                damaged[at] = static_cast<char>(random());
            }
            if (damaged.empty()) break;
        }
        if (damaged == text) continue;
        try {
            EXPECT_TRUE(read_csv(damaged, "x").unverified) << "trial " << trial;
        } catch (const LogError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 15'000u);
}

TEST(LogError, IsOnePrintableLineWithPlaceReasonAndAdvice) {
    EXPECT_STREQ(LogError("a.csv", {12, -1}, "what", "advice").what(), "a.csv:12: what; advice");
    EXPECT_STREQ(LogError("a.rlog", {0, 0}, "what", "advice").what(),
                 "a.rlog:byte 0: what; advice");
    EXPECT_STREQ(LogError("a\nb", {}, "what", "advice").what(), "a?b: what; advice");
    EXPECT_TRUE(refused_at("time_ms,\x1B[31m" + std::string(99, 'a') + "\n", 1, "\"?[31maaaa"));
}

/// The content of a file that is written, at any moment.
std::string file_text(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(EstimatesCsv, EachRowIsThereAtOnceAndCloseAddsTheChecksum) {
    const auto path = std::filesystem::temp_directory_path() / "rover85_estimates.csv";
    host_sim::LogHead head;
    head.image_identity = "an image";
    host_sim::EstimatesCsvWriter writer(path, head);
    EXPECT_EQ(read_csv(file_text(path), "x").steps.size(), 0u);
    host_sim::LogStep step = log_test::LogMaker(3).make(1).steps[0];
    step.estimates.emplace().position_q4_mm = -12345;
    step.inputs.tick_count = 777;
    for (std::uint32_t i = 0; i < 3; ++i) {
        step.time_ms = 100 * i;
        step.restart = i == 1 ? host_sim::Restart::cold : host_sim::Restart::none;
        writer.append(step);
        const Log log = read_csv(file_text(path), "x");
        EXPECT_TRUE(log.unverified);
        ASSERT_EQ(log.steps.size(), i + 1u);
        EXPECT_EQ(log.steps.back().restart, step.restart);
        EXPECT_EQ(log.steps.back().inputs.tick_count, 777);
        EXPECT_EQ(log.steps.back().estimates->position_q4_mm, -12345);
        EXPECT_FALSE(log.steps.back().truth || log.steps.back().commands);
    }
    const std::string open = file_text(path);
    writer.close();
    EXPECT_EQ(file_text(path), open + checksum_line(open, 3));
    EXPECT_FALSE(read_csv(file_text(path), "x").unverified);
    EXPECT_EQ(read_csv(file_text(path), "x").head.image_identity, "an image");
    EXPECT_THROW(writer.append(step), LogError);
    std::filesystem::remove(path);
}

TEST(EstimatesCsv, ARowThatIsRefusedLeavesTheFileWhole) {
    const auto path = std::filesystem::temp_directory_path() / "rover85_estimates_refused.csv";
    {
        host_sim::EstimatesCsvWriter writer(path, {});
        host_sim::LogStep step;
        step.time_ms = 100;
        writer.append(step);
        EXPECT_THROW(writer.append(step), LogError) << "time does not increase";
        step.time_ms = 200;
        writer.append(step);
    }
    const Log log = read_csv(file_text(path), "x");
    EXPECT_FALSE(log.unverified) << "the destructor closes";
    EXPECT_EQ(log.steps.size(), 2u);
    std::filesystem::remove(path);
}

}  // namespace
