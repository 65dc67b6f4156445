// faults_test.cpp - every kind on every group of channels.
#include "host_sim/world/faults.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace host_sim {
namespace {

// The true inputs of step i: every channel differs from step to step.
hal::RawInputs inputs_of(int i) {
    hal::RawInputs inputs;
    inputs.tick_count = static_cast<std::uint16_t>(10 * i);
    for (std::size_t k = 0; k < hal::kAdcChannelCount; ++k) {
        inputs.adc_q4_count[k] =
            static_cast<std::uint16_t>(1000 * (k + 1) + static_cast<unsigned>(i));
    }
    for (std::size_t k = 0; k < hal::kWheelCount; ++k) {
        inputs.tach_count[k] = static_cast<std::uint16_t>(65000 + 5 * i + static_cast<int>(k));
    }
    inputs.tach_present = 0x3F;
    inputs.range_scan_count = static_cast<std::uint8_t>(i);
    inputs.range_present = 3;
    inputs.range_q1_mm[0] = static_cast<std::int16_t>(100 + i);
    inputs.range_q1_mm[1] = static_cast<std::int16_t>(200 + i);
    return inputs;
}

// Inputs of step `step` (10 a second) after a plan has seen every step before it.
hal::RawInputs faulty(const char* plan, int step) {
    FaultInjector injector(parse_faults(plan), rocky32(), 1);
    hal::RawInputs inputs;
    for (int i = 0; i <= step; ++i) {
        inputs = inputs_of(i);
        injector.apply(0.1 * i, inputs);
    }
    return inputs;
}

std::string error_of(const char* text) {
    try {
        parse_faults(text);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(ParseFaults, ReadsEveryPartOfAnEntry) {
    const FaultPlan plan = parse_faults(
        " bogie_left:stuck@120-180, tach:dropped=0.25@1.5-, range_7:offset=-3.5@0-1e2 ");
    ASSERT_EQ(plan.size(), 3u);
    EXPECT_EQ(plan[0].channel.group, FaultChannel::Group::angle);
    EXPECT_EQ(plan[0].channel.index, 0);
    EXPECT_EQ(plan[0].kind, FaultKind::stuck);
    EXPECT_EQ(plan[0].from_s, 120);
    EXPECT_EQ(plan[0].to_s, 180);
    EXPECT_EQ(plan[1].channel.group, FaultChannel::Group::tachometer);
    EXPECT_EQ(plan[1].channel.index, kEveryWheel);
    EXPECT_EQ(plan[1].kind, FaultKind::dropped);
    EXPECT_EQ(plan[1].value, 0.25);
    EXPECT_TRUE(std::isinf(plan[1].to_s));
    EXPECT_EQ(plan[2].channel.group, FaultChannel::Group::range_sample);
    EXPECT_EQ(plan[2].channel.index, 7);
    EXPECT_EQ(plan[2].value, -3.5);
    EXPECT_EQ(plan[2].to_s, 100);
    EXPECT_TRUE(parse_faults("").empty());
    EXPECT_TRUE(parse_faults("  ").empty());
    EXPECT_EQ(parse_faults("pitch:dropped@0-1")[0].value, 0.5);
}

TEST(ParseFaults, RefusesWhatItDoesNotUnderstandAndSaysWhy) {
    const char* cases[][2] = {
        {"bogie:stuck@1-2", "'bogie' is no channel"},
        {"battery:stuck@1-2", "'battery' is no channel"},
        {"range_8:stuck@1-2", "'range_8' is no channel"},
        {"pitch:broken@1-2", "'broken' is no kind of fault"},
        {"pitch@1-2", "no ':' followed by '@'"},
        {"pitch:stuck", "no ':' followed by '@'"},
        {"pitch:stuck@", "not followed by a time"},
        {"pitch:stuck@5", "not followed by a time"},
        {"pitch:stuck@-5-6", "begins at no possible time"},
        {"pitch:stuck@6-5", "ends before it begins"},
        {"pitch:stuck@5-5", "ends before it begins"},
        {"pitch:stuck@5-6x", "the end is not a time"},
        {"pitch:stuck@nan-6", "not followed by a time"},
        {"pitch:stuck=1@5-6", "take no value"},
        {"pitch:absent=0@5-6", "take no value"},
        {"pitch:offset@5-6", "an offset needs a value"},
        {"pitch:offset=@5-6", "the value is not a number"},
        {"pitch:offset=inf@5-6", "the value is not a number"},
        {"pitch:offset=1e6@5-6", "beyond 65535"},
        {"pitch:dropped=1.5@5-6", "a chance from 0 to 1"},
        {"pitch:stuck@1-2,", "nothing follows the last comma"},
        {"pitch:stuck@1-2,,roll:stuck@1-2", "no ':' followed by '@'"},
    };
    for (const auto& one : cases) {
        const std::string message = error_of(one[0]);
        EXPECT_NE(message.find(one[1]), std::string::npos) << one[0] << ": " << message;
    }
}

TEST(ParseFaultsToml, ReadsTablesAndRefusesWithTheLine) {
    const FaultPlan plan = parse_faults_toml(
        "[[fault]]\nchannel = \"roll\"\nkind = \"offset\"\nfrom_s = 3\nto_s = 4.5\nvalue = 2\n"
        "[[fault]]\nchannel = \"range\"\nkind = \"absent\"\nfrom_s = 10\n",
        "plan.toml");
    ASSERT_EQ(plan.size(), 2u);
    EXPECT_EQ(plan[0].channel.index, 4);
    EXPECT_EQ(plan[0].value, 2);
    EXPECT_EQ(plan[1].channel.group, FaultChannel::Group::range_module);
    EXPECT_TRUE(std::isinf(plan[1].to_s));
    EXPECT_TRUE(parse_faults_toml("", "plan.toml").empty());
    const char* cases[][2] = {
        {"[[fault]]\nchannel = \"x\"\nkind = \"stuck\"\nfrom_s = 0\n",
         "plan.toml:2: 'fault.channel'"},
        {"[[fault]]\nchannel = \"roll\"\nkind = \"x\"\nfrom_s = 0\n", "plan.toml:3: 'fault.kind'"},
        {"[[fault]]\nchannel = \"roll\"\nkind = \"stuck\"\nfrom_s = -1\n", "plan.toml:4:"},
        {"[[fault]]\nchannel = \"roll\"\nkind = \"stuck\"\n", "'fault.from_s' is missing"},
        {"[[fault]]\nchannel = \"roll\"\nkind = \"stuck\"\nfrom_s = 2\nto_s = 1\n", "ends before"},
        {"[[fault]]\nchannel = \"roll\"\nkind = \"offset\"\nfrom_s = 2\n", "needs a value"},
        {"[[fault]]\nchanel = \"roll\"\n", "plan.toml:2: 'fault.chanel' is not known here"},
        {"fault = 3\n", "must be [[fault]] tables"},
        {"[[faults]]\n", "'faults' is not known here"},
        {"[[fault]\n", "not valid TOML"},
    };
    for (const auto& one : cases) {
        try {
            parse_faults_toml(one[0], "plan.toml");
            ADD_FAILURE() << one[0];
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(one[1]), std::string::npos) << error.what();
        }
    }
}

TEST(FaultInjector, ActsFromTheBeginningUpToTheEndAndOnNothingElse) {
    for (int step = 0; step < 40; ++step) {
        const hal::RawInputs seen = faulty("differential:absent@1.05-2.05", step);
        const bool active = step >= 11 && step <= 20;
        for (std::size_t k = 0; k < hal::kAdcChannelCount; ++k) {
            const std::uint16_t expected =
                active && k == 2 ? hal::kAdcAbsent : inputs_of(step).adc_q4_count[k];
            ASSERT_EQ(seen.adc_q4_count[k], expected) << step << " " << k;
        }
        ASSERT_EQ(seen.tach_count[0], inputs_of(step).tach_count[0]);
        ASSERT_EQ(seen.range_present, 3);
    }
}

TEST(FaultInjector, StuckAngleRepeatsTheLastValueBeforeTheFault) {
    EXPECT_EQ(faulty("pitch:stuck@0.95-2", 15).adc_q4_count[3], inputs_of(9).adc_q4_count[3]);
    EXPECT_EQ(faulty("pitch:stuck@0-2", 15).adc_q4_count[3], inputs_of(0).adc_q4_count[3]);
    EXPECT_EQ(faulty("pitch:stuck@0.95-1.45", 15).adc_q4_count[3], inputs_of(15).adc_q4_count[3]);
}

TEST(FaultInjector, OffsetAngleMovesByDegreesAndHoldsTheRails) {
    // 2 degrees of 90 over 65536 Q4 counts, and of 150 for the inclinometer.
    EXPECT_EQ(faulty("bogie_left:offset=2@0-", 5).adc_q4_count[0], 1005 + 1456);
    EXPECT_EQ(faulty("roll:offset=2@0-", 5).adc_q4_count[4], 5005 + 874);
    EXPECT_EQ(faulty("bogie_left:offset=-45@0-", 5).adc_q4_count[0], 0);
    EXPECT_EQ(faulty("bogie_left:offset=500@0-", 5).adc_q4_count[0], hal::kAdcMaxQ4Count);
    EXPECT_EQ(faulty("bogie_left:absent@0-,bogie_left:offset=2@0-", 5).adc_q4_count[0],
              hal::kAdcAbsent);
}

TEST(FaultInjector, DroppedAngleIsAbsentWithTheStatedChance) {
    FaultInjector injector(parse_faults("bogie_right:dropped=0.3@0-"), rocky32(), 3);
    int lost = 0;
    for (int i = 0; i < 10000; ++i) {
        hal::RawInputs inputs = inputs_of(0);
        injector.apply(0.1 * i, inputs);
        lost += inputs.adc_q4_count[1] == hal::kAdcAbsent ? 1 : 0;
    }
    EXPECT_NEAR(lost, 3000, 5 * std::sqrt(10000 * 0.3 * 0.7));
}

TEST(FaultInjector, TachometerFaultsDoAsTheTableSays) {
    EXPECT_EQ(faulty("tach_rear_left:stuck@0.95-", 15).tach_count[4], inputs_of(9).tach_count[4]);
    EXPECT_EQ(faulty("tach_rear_left:stuck@0.95-1.25", 15).tach_count[4],
              inputs_of(15).tach_count[4]);
    const hal::RawInputs absent = faulty("tach_front_right:absent@0-", 15);
    EXPECT_EQ(absent.tach_present, 0x3F & ~2);
    EXPECT_EQ(absent.tach_count[1], 0);
    EXPECT_EQ(absent.tach_count[0], inputs_of(15).tach_count[0]);
    EXPECT_EQ(faulty("tach:absent@0-", 15).tach_present, 0);
    // 65000 + 5*200 + 7 wraps.
    EXPECT_EQ(faulty("tach_front_left:offset=7@0-", 200).tach_count[0], 65000 + 1000 + 7 - 65536);
    EXPECT_EQ(faulty("tach_front_left:offset=-7@0-", 1).tach_count[0], 65000 + 5 - 7);
}

TEST(FaultInjector, DroppedPulsesAreLostForGood) {
    FaultInjector injector(parse_faults("tach:dropped=0.5@0-100"), rocky32(), 3);
    double forward = 0;
    for (int i = 0; i <= 2000; ++i) {
        hal::RawInputs inputs = inputs_of(i);
        injector.apply(0.1 * i, inputs);
        if (i == 1000 || i == 2000) {
            const int missing = static_cast<std::int16_t>(
                static_cast<std::uint16_t>(inputs_of(i).tach_count[0] - inputs.tach_count[0]));
            // About 5000 pulses passed in the first 100 s, half of them lost; none afterwards.
            EXPECT_NEAR(missing, 2500, 5 * std::sqrt(5000 * 0.25)) << i;
            if (i == 2000) {
                EXPECT_EQ(missing, forward);
            }
            forward = missing;
        }
    }
    // All pulses lost, driving backwards: the counter stands still.
    FaultInjector all(parse_faults("tach:dropped=1@0-"), rocky32(), 3);
    for (int i = 0; i < 50; ++i) {
        hal::RawInputs inputs = inputs_of(-i);
        all.apply(0.1 * i, inputs);
        ASSERT_EQ(inputs.tach_count[2], inputs_of(0).tach_count[2]);
    }
}

TEST(FaultInjector, RangeSampleFaultsDoAsTheTableSays) {
    EXPECT_EQ(faulty("range_0:stuck@0.95-", 15).range_q1_mm[0], 109);
    EXPECT_EQ(faulty("range_0:stuck@0.95-", 15).range_q1_mm[1], 215);
    EXPECT_EQ(faulty("range_0:stuck@0.95-", 15).range_scan_count, 15);
    EXPECT_EQ(faulty("range_1:absent@0-", 15).range_present, 1);
    EXPECT_EQ(faulty("range_1:offset=-10.5@0-", 15).range_q1_mm[1], 215 - 21);
    EXPECT_EQ(faulty("range_1:offset=60000@0-", 15).range_q1_mm[1], 32767);
    EXPECT_EQ(faulty("range_1:dropped=1@0-", 15).range_present, 1);
    EXPECT_EQ(faulty("range_1:dropped=0@0-", 15).range_present, 3);
}

TEST(FaultInjector, RangeModuleFaultsFreezeTheScanCounter) {
    const hal::RawInputs stuck = faulty("range:stuck@0.95-", 15);
    EXPECT_EQ(stuck.range_scan_count, 9);
    EXPECT_EQ(stuck.range_q1_mm[0], 109);
    EXPECT_EQ(stuck.range_present, 3);
    const hal::RawInputs absent = faulty("range:absent@0.95-", 15);
    EXPECT_EQ(absent.range_scan_count, 9);
    EXPECT_EQ(absent.range_present, 0);
    const hal::RawInputs moved = faulty("range:offset=5@0-", 15);
    EXPECT_EQ(moved.range_q1_mm[0], 125);
    EXPECT_EQ(moved.range_q1_mm[1], 225);
    FaultInjector injector(parse_faults("range:dropped=0.5@0-"), rocky32(), 3);
    int stale = 0;
    int last = -1;
    for (int i = 0; i < 200; ++i) {
        hal::RawInputs inputs = inputs_of(i);
        injector.apply(0.1 * i, inputs);
        stale += inputs.range_scan_count == last ? 1 : 0;
        if (inputs.range_scan_count != last) {
            ASSERT_EQ(inputs.range_scan_count, i);
            ASSERT_EQ(inputs.range_q1_mm[0], 100 + i);
        }
        last = inputs.range_scan_count;
    }
    EXPECT_NEAR(stale, 100, 36);
}

}  // namespace
}  // namespace host_sim
