// rlog_test.cpp - the .rlog against docs/spec/log-format.md: golden bytes, round trip, refusals.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "host_sim/log/log_io.hpp"
#include "log_samples.hpp"
#include "rlog_builder.hpp"
#include "rlog_refusals.hpp"

namespace {

using host_sim::encode_rlog;
using host_sim::Log;
using host_sim::LogError;
using host_sim::read_rlog;
using log_test::error_of;
using log_test::from_hex;
using log_test::little;
using log_test::payload_at;
using log_test::plain_head;
using log_test::plain_step;
using log_test::refused_at;
using log_test::RlogBuilder;
using log_test::small_log;

TEST(BitwiseCrc, GivesThePublishedCheckValue) {
    log_test::BitwiseCrc crc;
    crc.add("123456789");
    EXPECT_EQ(crc.value(), 0xCBF43926u);  // the check value in every CRC catalogue
}

/// A log in which every field has a value of its own.
Log tiny_log() {
    Log log;
    log.head.vehicle = "v";
    log.head.calibration.angle[1] = {0x1234, 0x5678, true};
    log.head.calibration.range_offset_q1_mm = -2;
    log.head.image_identity = "id";
    log.head.notes = {{"k", "x"}};
    host_sim::LogStep step;
    step.time_ms = 0x01020304;
    step.inputs.tick_count = 0xABCD;
    for (auto& count : step.inputs.adc_q4_count) count = hal::kAdcAbsent;
    step.inputs.adc_q4_count[0] = 0x7FF8;
    step.inputs.adc_q4_count[13] = 65520;
    step.inputs.tach_present = 0x21;
    step.inputs.tach_count[0] = 0x0102;
    step.inputs.tach_count[1] = 0x5555;  // absent: not recorded
    step.inputs.tach_count[5] = 0x0304;
    step.inputs.range_scan_count = 9;
    step.inputs.range_present = 0x80;
    step.inputs.range_q1_mm[7] = -3;
    step.inputs.detector_bits = 0x42;
    step.inputs.command_size = 2;
    step.inputs.command[0] = 0xDE;
    step.inputs.command[1] = 0xAD;
    step.inputs.command[2] = 0x77;  // beyond the size: not recorded
    step.truth = {1.0, -0.0, 0.5, std::nan("7"), -2.0, 0.25};
    rover::Estimates& e = step.estimates.emplace();
    e.step_count = 0x0101;
    e.tick_count = 0x0202;
    e.available = 3;
    e.events = 4;
    e.faults = 0x0506;
    e.mode = rover::SlipMode::moved;
    e.cycle_count = 0x0708;
    e.position_q4_mm = -2;
    e.odometer_q4_mm = 0x01020304;
    e.position_sigma_q4_mm = 0xFFFE;
    e.advance_q4_mm = -5;
    e.slip_percent = -6;
    e.match_cost_q4 = 7;
    e.sinkage_q4_mm = 8;
    e.pitch_brad = 9;
    e.roll_brad = 10;
    e.rocker_brad = 11;
    e.bogie_brad = 12;
    e.height_middle_q4_mm = 13;
    e.height_front_q4_mm = 14;
    e.height_ahead_q4_mm[0] = 15;
    e.height_ahead_q4_mm[1] = 16;
    hal::Commands& c = step.commands.emplace();
    c.drive_percent[0] = -100;
    c.drive_percent[5] = 100;
    c.steer_brad[0] = 0x0102;
    c.steer_brad[3] = -1;
    c.mast_brad = 0x0304;
    c.laser_bits = 0x1F;
    c.telemetry_size = 1;
    c.telemetry[0] = 0xEE;
    log.steps.push_back(step);
    return log;
}

// Written by hand from the specification's tables, not by the code.
TEST(Rlog, GoldenBytesOfATinyLog) {
    const Log log = tiny_log();
    const std::string head = from_hex(
        "01000000 76"     // vehicle
        "0100"            // calibration version
        "F87F 0040 00"    // bogie left: 32760, 16384, no
        "3412 7856 01"    // bogie right
        "F87F 0040 00"    // differential
        "F87F AB6A 00"    // pitch: 27307 = 6AABh
        "F87F AB6A 00"    // roll
        "1004 D007 4734"  // 1040, 2000, 13383 = 3447h
        "FEFF"            // range offset -2
        "02000000 6964"   // image
        "01000000 01000000 6B 01000000 78");
    const std::string payload = from_hex(
        "04030201 07 CDAB"                                    // time, sections, tick
        "F87F FFFFFFFFFFFFFFFFFFFFFFFF"                       // converter 0 .. 6
        "FFFFFFFFFFFFFFFFFFFFFFFF F0FF"                       // 7 .. 13
        "21 0201 0000 0000 0000 0000 0403"                    // tachometers
        "09 80 0000000000000000000000000000 FDFF"             // ranges
        "42 02 DEAD"                                          // detectors, received bytes
        "000000000000F03F 0000000000000080 000000000000E03F"  // 1, -0, 0.5
        "000000000000F87F 00000000000000C0 000000000000D03F"  // NaN, -2, 0.25
        "0101 0202 03 04 0605 05 0807"
        "FEFFFFFF 04030201 FEFF FBFF FA 0700 0800"
        "0900 0A00 0B00 0C00 0D00 0E00 0F00 1000"
        "9C 00 00 00 00 64 0201 0000 0000 FFFF 0403 1F 01 EE");
    const RlogBuilder golden = RlogBuilder().record(1, head).record(2, payload);
    EXPECT_EQ(golden.bytes.substr(0, 12), from_hex("89524C4F470D0A1A 0100 0000"));
    EXPECT_EQ(encode_rlog(log), golden.bytes);
    EXPECT_TRUE(log_test::same(read_rlog(golden.bytes, "golden"), log));
}

RC_GTEST_PROP(Rlog, RoundTripGivesTheSameLogAndTheSameBytes, (std::uint64_t seed)) {
    Log log = log_test::LogMaker(seed).make(*rc::gen::inRange<std::size_t>(0, 30));
    for (host_sim::LogStep& step : log.steps) {
        step.restart = static_cast<host_sim::Restart>(*rc::gen::inRange<int>(0, 3));
    }
    const std::string bytes = encode_rlog(log);
    const Log again = read_rlog(bytes, "x");
    RC_ASSERT(log_test::same(again, log));
    RC_ASSERT(!again.unverified);
    RC_ASSERT(encode_rlog(again) == bytes);
}

TEST(Rlog, ReadsFromAStream) {
    std::istringstream in(encode_rlog(small_log()));
    EXPECT_TRUE(log_test::same(read_rlog(in, "x"), small_log()));
}

TEST(Rlog, AbsentSlotsReadBackAsZeroWhateverStoodThere) {
    Log log = small_log(1);
    log.steps[0].inputs.tach_present = 0xC0;  // bits of wheels that do not exist
    log.steps[0].inputs.tach_count[2] = 77;
    log.steps[0].inputs.range_present = 0;
    log.steps[0].inputs.adc_q4_count[3] = 65521;  // "anything above" 65520
    const Log again = read_rlog(encode_rlog(log), "x");
    EXPECT_EQ(again.steps[0].inputs.tach_present, 0);
    EXPECT_EQ(again.steps[0].inputs.tach_count[2], 0);
    EXPECT_EQ(again.steps[0].inputs.range_q1_mm[0], 0);
    EXPECT_EQ(again.steps[0].inputs.adc_q4_count[3], hal::kAdcAbsent);
}

TEST(Rlog, EveryTruncationReadsUpToARecordBoundaryOrIsRefusedWithItsOffset) {
    const Log whole = small_log(3);
    const std::string bytes = encode_rlog(whole);
    std::vector<std::size_t> ends;  // of the header, then of each record: sizes of shorter logs
    for (std::size_t steps = 0; steps <= 3; ++steps) {
        ends.push_back(encode_rlog(small_log(steps)).size());
        ASSERT_EQ(bytes.substr(0, ends.back()), encode_rlog(small_log(steps)));
    }
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        const std::string cut = bytes.substr(0, size);
        const auto whole_steps = static_cast<std::size_t>(
            std::upper_bound(ends.begin(), ends.end(), size) - ends.begin());
        if (whole_steps > 0 && ends[whole_steps - 1] == size) {
            EXPECT_TRUE(log_test::same(read_rlog(cut, "x"), small_log(whole_steps - 1))) << size;
        } else if (whole_steps > 0) {
            EXPECT_TRUE(refused_at(cut, ends[whole_steps - 1], "the file ends inside record"))
                << size;
            EXPECT_TRUE(refused_at(cut, ends[whole_steps - 1], "rover85 recover x.rlog")) << size;
        } else if (size >= 16) {
            EXPECT_TRUE(refused_at(cut, 16, "the file ends inside record 0")) << size;
        } else {
            EXPECT_TRUE(
                refused_at(cut, size, size == 0 ? "the file is empty" : "inside its header"));
        }
    }
}

TEST(Rlog, EverySingleBitFlipIsRefusedAndSalvageKeepsOnlyTrueSteps) {
    const Log log = small_log(3);
    const std::string bytes = encode_rlog(log);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
        std::string flipped = bytes;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
        ASSERT_GE(error_of(flipped).byte_offset(), 0) << "bit " << bit;
        host_sim::Recovery recovery;
        std::string_view kept;
        try {
            kept = host_sim::salvage_rlog(flipped, "x", recovery);
        } catch (const LogError&) {
            ASSERT_LT(bit / 8, encode_rlog(small_log(0)).size())
                << "only a bad head stops recovery";
            continue;
        }
        ASSERT_LE(kept.size(), bit / 8) << "the damaged byte is not kept";
        ASSERT_EQ(kept, bytes.substr(0, kept.size())) << "bit " << bit;
        ASSERT_EQ(read_rlog(kept, "x").steps.size(), recovery.steps);
    }
}

/// Damages `bytes` in one of the ways in which files get damaged.
std::string damage(std::string bytes, std::mt19937_64& random) {
    const auto pick = [&random](std::size_t below) {
        return static_cast<std::size_t>(random() % below);
    };
    const std::size_t at = pick(bytes.size());
    const std::size_t size = 1 + pick(std::min<std::size_t>(64, bytes.size() - at));
    switch (pick(6)) {
        case 0:  // a burst of rubbish
            for (std::size_t i = 0; i < size; ++i) bytes[at + i] = static_cast<char>(random());
            break;
        case 1:  // scattered rubbish
            for (std::size_t i = 0; i < size; ++i)
                bytes[pick(bytes.size())] = static_cast<char>(random());
            break;
        case 2:  // zeros up to the end, as after a power cut
            std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), '\0');
            break;
        case 3:
            bytes.erase(at, size);
            break;
        case 4:
            bytes.insert(at, bytes.substr(pick(bytes.size()), size));
            break;
        default:  // rubbish after the end
            for (std::size_t i = 0; i < size; ++i) bytes += static_cast<char>(random());
            break;
    }
    return bytes;
}

TEST(Rlog, RandomDamageIsNeverAcceptedSilently) {
    constexpr std::uint64_t kSeed = 85;
    std::cout << "seed " << kSeed << '\n';
    std::mt19937_64 random(kSeed);
    const std::string bytes = encode_rlog(small_log(4));
    std::size_t refused = 0;
    for (int trial = 0; trial < 50'000; ++trial) {
        const std::string damaged = damage(bytes, random);
        try {
            read_rlog(damaged, "x");
            // Only a file that lost whole records at its end may still read.
            ASSERT_EQ(damaged, bytes.substr(0, damaged.size())) << "trial " << trial;
        } catch (const LogError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 49'000u);
}

TEST(Rlog, RecordsOfAnotherLogAreRefusedEvenAtTheSamePlaceInTheFile) {
    const Log one = small_log(3);
    Log other_head = one;
    other_head.head.notes["seed"] = "8";
    Log other_past = one;  // the same head, but the step before differs
    other_past.steps[0].inputs.detector_bits = 1;
    const std::string bytes = encode_rlog(one);
    const std::size_t second = encode_rlog(small_log(1)).size();
    const std::size_t third = encode_rlog(small_log(2)).size();
    for (const Log& donor : {other_head, other_past}) {
        std::string spliced = bytes;
        spliced.replace(second, third - second, encode_rlog(donor).substr(second, third - second));
        EXPECT_TRUE(refused_at(spliced, second, "damaged or comes from another log"));
    }
}

TEST(Rlog, MissingRepeatedAndSwappedRecordsAreRefused) {
    const std::string bytes = encode_rlog(small_log(3));
    const std::size_t first = encode_rlog(small_log(0)).size();
    const std::size_t size =
        encode_rlog(small_log(1)).size() - first;  // all steps are equally long
    ASSERT_EQ(bytes.size(), first + 3 * size);
    const auto step = [&](std::size_t i) { return bytes.substr(first + i * size, size); };
    const std::string head = bytes.substr(0, first);
    EXPECT_TRUE(
        refused_at(head + step(1) + step(2), first, "record 2 found where record 1 belongs"));
    EXPECT_TRUE(refused_at(head + step(0) + step(0) + step(1), first + size, "repeated"));
    EXPECT_TRUE(refused_at(head + step(1) + step(0) + step(2), first, "out of order"));
}

TEST(Rlog, ForeignAndFutureFilesAreRefused) {
    EXPECT_TRUE(refused_at("time_ms,tick_count\n", 0, "not an .rlog"));
    EXPECT_TRUE(refused_at(RlogBuilder(2, 0).record(1, plain_head()).bytes, 8, "version 2.0"));
    EXPECT_TRUE(refused_at(RlogBuilder().bytes, 16, "ends inside record 0"));
    EXPECT_TRUE(refused_at(RlogBuilder().record(2, plain_step(1)).bytes, 16, "not head"));
    EXPECT_EQ(read_rlog(RlogBuilder(1, 9).record(1, plain_head()).bytes, "x").head.vehicle, "v");
}

TEST(Rlog, UnknownRecordTypesAreSkippedFrom80hAndRefusedBelow) {
    RlogBuilder builder;
    builder.record(1, plain_head()).record(0x80, "").record(2, plain_step(5)).record(0xFF, "later");
    const Log log = read_rlog(builder.bytes, "x");
    ASSERT_EQ(log.steps.size(), 1u);
    EXPECT_EQ(log.steps[0].time_ms, 5u);
    for (const int type : {0x00, 0x01, 0x04, 0x7F}) {
        RlogBuilder refused;
        refused.record(1, plain_head()).record(static_cast<std::uint8_t>(type), plain_head());
        EXPECT_TRUE(
            refused_at(refused.bytes, refused.offsets[1], "type " + std::to_string(type) + ","));
    }
    std::string damaged = builder.bytes;
    damaged.back() = static_cast<char>(damaged.back() ^ 1);
    EXPECT_TRUE(refused_at(damaged, builder.offsets[3], "checksum")) << "skipped, but checked";
}

TEST(Rlog, APayloadSizeBeyondTheLimitIsRefused) {
    RlogBuilder builder;
    builder.record(1, plain_head());
    const std::size_t at = builder.bytes.size();
    const std::string bytes = builder.bytes + little((1u << 24) + 1, 4) + std::string(20, '\0');
    EXPECT_TRUE(refused_at(bytes, at, "impossible payload size 16777217"));
}

/// A log whose checksums are right and whose one step is `payload`.
RlogBuilder with_step(const std::string& payload) {
    return RlogBuilder().record(1, plain_head()).record(2, payload);
}

std::string changed(std::string payload, std::size_t at, const std::string& bytes) {
    return payload.replace(at, bytes.size(), bytes);
}

TEST(Rlog, PlainStepIsAsLongAsTheSpecificationSays) {
    ASSERT_EQ(plain_step(1).size(), log_test::kPlainStepSize);
    EXPECT_EQ(read_rlog(with_step(plain_step(70)).bytes, "x").steps.at(0).inputs.tick_count, 7);
}

TEST(Rlog, WrongContentBehindRightChecksumsIsRefusedWithItsOffset) {
    struct Case {
        std::string payload;
        std::size_t at;
        const char* what;
    };
    const std::string plain = plain_step(100);
    const std::string truth_unit = little(0x3FF0000000000000, 8);
    const std::string truths = truth_unit + truth_unit + truth_unit + truth_unit + truth_unit;
    const std::string with_truth = changed(plain, log_test::kSectionsAt, "\x01");
    const std::string with_estimates = changed(plain, log_test::kSectionsAt, "\x02");
    const std::string with_commands = changed(plain, log_test::kSectionsAt, "\x04");
    const std::size_t end = log_test::kPlainStepSize;
    const std::vector<Case> cases = {
        {changed(plain, log_test::kSectionsAt, "\x08"), log_test::kSectionsAt, "section bits"},
        {changed(plain, log_test::kAdcAt, "\xF1\xFF"), log_test::kAdcAt,
         "bogie_left_q4_count = 65521"},
        {changed(plain, log_test::kAdcAt, "\xFE\xFF"), log_test::kAdcAt, "65534"},
        {changed(plain, log_test::kTachPresentAt, "\x40"), log_test::kTachPresentAt,
         "presence bits"},
        {changed(plain, log_test::kTachAt + 2, "\x01"), log_test::kTachAt + 2,
         "tach_front_right_count"},
        {changed(plain, log_test::kRangeAt + 14, "\x01"), log_test::kRangeAt + 14, "range_8_q1_mm"},
        {changed(plain, log_test::kReceivedAt, "\x11") + std::string(17, 'a'),
         log_test::kReceivedAt, "17 bytes, more than 16"},
        {changed(plain, log_test::kReceivedAt, "\x02") + "a", log_test::kReceivedAt + 1,
         "too short"},
        {plain + "a", end, "longer than its content"},
        {plain.substr(0, end - 1), end - 1, "too short"},
        {with_truth + truths + little(0x7FF0000000000000, 8), end + 40, "truth_slip"},
        {with_truth + truths + little(0xFFF0000000000000, 8), end + 40, "truth_slip"},
        {with_truth + truths + little(0x7FF8000000000001, 8), end + 40, "truth_slip"},
        {with_truth + truths + little(0xFFF8000000000000, 8), end + 40, "truth_slip"},
        {with_estimates + std::string(8, '\0') + "\x06" + std::string(36, '\0'), end + 8,
         "estimate_mode = 6 is out of range [0, 5]"},
        {with_commands + std::string(17, '\0') + "\xA1" + std::string(161, 'a'), end + 17,
         "161 bytes, more than 160"},
    };
    for (const Case& wrong : cases) {
        const RlogBuilder builder = with_step(wrong.payload);
        EXPECT_TRUE(
            refused_at(builder.bytes, payload_at(builder.offsets[1], wrong.at), wrong.what));
    }
}

TEST(Rlog, TimeThatDoesNotIncreaseIsRefused) {
    for (const std::uint32_t time_ms : {100u, 99u, 0u}) {
        RlogBuilder builder;
        builder.record(1, plain_head()).record(2, plain_step(100)).record(2, plain_step(time_ms));
        EXPECT_TRUE(
            refused_at(builder.bytes, payload_at(builder.offsets[2], 0), "time must increase"));
    }
}

TEST(Rlog, WrongHeadsBehindRightChecksumsAreRefused) {
    const std::string plain = plain_head();
    const std::string no_notes = plain.substr(0, plain.size() - 4);
    const auto text = [](const std::string& content) {
        return little(content.size(), 4) + content;
    };
    const std::vector<std::pair<std::string, const char*>> cases = {
        {changed(plain, 4, "\xFF"), "vehicle description is not valid UTF-8"},
        {changed(plain, 4, std::string(1, '\0')), "NUL"},
        {changed(plain, 11, "\x02"), "bogie_left.inverted = 2"},
        {changed(plain, 0, "\xFF\xFF\xFF\xFF"), "too short"},
        {plain + "x", "longer than its content"},
        {no_notes + little(1, 4) + text("a b") + text(""), "not legal"},
        {no_notes + little(1, 4) + text("") + text(""), "not legal"},
        {no_notes + little(2, 4) + text("b") + text("") + text("a") + text(""), "out of order"},
        {no_notes + little(2, 4) + text("b") + text("") + text("b") + text(""), "repeated"},
        {no_notes + little(0xFFFFFFFF, 4), "too short"},
    };
    for (const auto& [payload, what] : cases) {
        const std::string bytes = RlogBuilder().record(1, payload).bytes;
        EXPECT_NE(std::string(error_of(bytes).what()).find(what), std::string::npos)
            << error_of(bytes).what() << " (expected " << what << ")";
    }
}

TEST(Rlog, Utf8IsCheckedAsRfc3629Says) {
    const auto accepted = [](const std::string& text) {
        Log log;
        log.head.vehicle = text;
        try {
            return read_rlog(encode_rlog(log), "x").head.vehicle == text;
        } catch (const LogError&) {
            return false;
        }
    };
    for (const char* good :
         {"", "\x7F", "\xC2\x80", "\xDF\xBF", "\xE0\xA0\x80", "\xED\x9F\xBF", "\xEE\x80\x80",
          "\xEF\xBF\xBF", "\xF0\x90\x80\x80", "\xF4\x8F\xBF\xBF"}) {
        EXPECT_TRUE(accepted(good)) << testing::PrintToString(good);
    }
    for (const char* bad : {"\x80", "\xC0\xAF", "\xC1\xBF", "\xC2", "\xC2x", "\xE0\x9F\xBF",
                            "\xE2\x82", "\xED\xA0\x80", "\xED\xBF\xBF", "\xF0\x8F\xBF\xBF",
                            "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF", "\xF0\x9F\x9A"}) {
        EXPECT_FALSE(accepted(bad)) << testing::PrintToString(bad);
    }
}

TEST(Rlog, TheWriterRefusesWhatTheFormatCannotHold) {
    const auto refused = [](auto change, const std::string& what) {
        Log log = small_log(3);
        change(log);
        for (const auto& encode : {+[](const Log& l) { return encode_rlog(l); },
                                   +[](const Log& l) { return host_sim::encode_csv(l); }}) {
            try {
                encode(log);
                ADD_FAILURE() << "accepted: " << what;
            } catch (const LogError& error) {
                EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
            }
        }
    };
    refused([](Log& l) { l.steps[1].time_ms = l.steps[0].time_ms; }, "time must increase");
    refused([](Log& l) { l.steps[1].truth->slip = -std::numeric_limits<double>::infinity(); },
            "step at 200 ms: truth_slip is infinite");
    refused([](Log& l) { l.steps[1].estimates->mode = rover::SlipMode{6}; }, "does not exist");
    refused([](Log& l) { l.steps[1].inputs.command_size = 17; }, "17 bytes, more than 16");
    refused([](Log& l) { l.steps[1].commands->telemetry_size = 161; }, "more than 160");
    refused([](Log& l) { l.head.vehicle = "\xFF"; }, "UTF-8");
    refused([](Log& l) { l.head.image_identity = std::string(1, '\0'); }, "NUL");
    refused([](Log& l) { l.head.notes["a b"] = ""; }, "note name");
    refused([](Log& l) { l.head.notes[std::string(65, 'a')] = ""; }, "note name");
    refused([](Log& l) { l.head.notes["a"] = "\xFF"; }, "note a is not valid UTF-8");
    refused([](Log& l) { l.head.vehicle.assign(std::size_t{1} << 24, 'a'); }, "16 MiB");
}

}  // namespace
