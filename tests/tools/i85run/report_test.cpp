// report_test.cpp - the results as text and JSON, numbers exact.
#include "tools/i85run/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace {

using i85run::End;
using i85run::json_report;
using i85run::Results;
using i85run::text_report;
using nlohmann::json;
using testing::HasSubstr;

Results sample() {
    Results results;
    results.end = End::halt;
    results.pc = 0x0012;
    results.instructions = 300;
    results.t_states = 3072;  // 1 ms at 3.072 MHz
    results.dumps.push_back({"0x8000:3", 0x8000, {0x00, 0xAB, 0x7F}});
    return results;
}

TEST(I85runReport, JsonHasExactlyTheContractsKeysFirst) {
    const auto parsed = nlohmann::ordered_json::parse(json_report(sample()));
    std::vector<std::string> keys;
    for (const auto& item : parsed.items()) keys.push_back(item.key());
    EXPECT_EQ(keys, (std::vector<std::string>{"halted", "pc", "instructions", "t_states",
                                              "function_t_states", "dumps", "end"}));
    EXPECT_EQ(parsed["halted"], true);
    EXPECT_EQ(parsed["pc"], 0x12);
    EXPECT_EQ(parsed["instructions"], 300);
    EXPECT_EQ(parsed["t_states"], 3072);
    EXPECT_TRUE(parsed["function_t_states"].is_null());
    EXPECT_EQ(parsed["dumps"], json({{"0x8000:3", "00ab7f"}}));
    EXPECT_EQ(parsed["end"], "halt");
}

TEST(I85runReport, LargeCountsAreExact) {
    Results results = sample();
    results.t_states = (uint64_t{1} << 53) + 1;  // not a double
    EXPECT_EQ(json::parse(json_report(results))["t_states"], (uint64_t{1} << 53) + 1);
    EXPECT_THAT(text_report(results), HasSubstr("9007199254740993"));
}

TEST(I85runReport, HaltedTellsWhetherTheProgramCameToItsEnd) {
    for (const End end :
         {End::halt, End::returned, End::warm_boot, End::time_limit, End::undefined_instruction,
          End::rom_write, End::return_lost, End::interrupted}) {
        Results results = sample();
        results.end = end;
        const bool halted = end == End::halt || end == End::returned || end == End::warm_boot;
        EXPECT_EQ(json::parse(json_report(results))["halted"], halted);
        EXPECT_EQ(text_report(results).find("did not finish") == std::string::npos, halted);
    }
}

TEST(I85runReport, TimesAreAtBothClocks) {
    EXPECT_THAT(text_report(sample()), HasSubstr("1.000 ms at 3.072 MHz, 1.536 ms at 2.000 MHz"));
    EXPECT_THAT(text_report(sample()), HasSubstr("HLT at 0011h"));
}

TEST(I85runReport, DumpsAreSixteenBytesALine) {
    Results results = sample();
    results.dumps = {{"buffer", 0x80F8, std::vector<uint8_t>(17, 0x5A)}};
    results.dumps[0].bytes[16] = 0x01;
    const std::string text = text_report(results);
    EXPECT_THAT(text, HasSubstr("buffer: 17 bytes at 80F8h"));
    EXPECT_THAT(text, HasSubstr("80F8h       5a 5a 5a 5a 5a 5a 5a 5a 5a 5a 5a 5a 5a 5a 5a 5a\n"));
    EXPECT_THAT(text, HasSubstr("8108h       01\n"));
}

TEST(I85runReport, ACountedFunctionHasItsTotals) {
    Results results = sample();
    i85run::FunctionCount count(0x0100);
    host_sim::StepRecord ret;
    ret.pc = 0x0100;
    ret.sp = 0x4000;
    ret.next_sp = 0x4002;
    ret.accesses[0].value = 0xC9;
    for (const uint64_t t : {10U, 15U}) {
        ret.t_end = t;
        count.observe(ret);
    }
    results.function = {"work", count};
    const json parsed = json::parse(json_report(results));
    EXPECT_EQ(parsed["function_t_states"], 25);
    EXPECT_EQ(parsed["function"], (json{{"name", "work"},
                                        {"calls", 2},
                                        {"t_states", 25},
                                        {"t_states_worst", 15},
                                        {"t_states_mean", 12.5},
                                        {"unfinished", false}}));
    EXPECT_THAT(text_report(results),
                HasSubstr("work: 2 calls, 25 T-states in all, worst 15, mean 12.5\n"));
}

TEST(I85runReport, WritesToRomAreTold) {
    Results results = sample();
    results.rom = {0x0000, 0x7FFF};
    EXPECT_EQ(json::parse(json_report(results))["rom_writes"], (json{{"count", 0}}));
    results.rom_write_count = 3;
    results.first_rom_write = {0x0102, 99, 0x0010, 0xEE};
    EXPECT_EQ(json::parse(json_report(results))["rom_writes"]["first"],
              (json{{"pc", 0x102}, {"t", 99}, {"address", 0x10}, {"value", 0xEE}}));
    EXPECT_THAT(text_report(results),
                HasSubstr("3 to 0000h-7FFFh; the first at PC 0102h, T 99: EEh to 0010h"));
}

TEST(I85runReport, ANameThatIsNotUtf8IsStillJson) {
    Results results = sample();
    results.dumps[0].name = std::string(1, static_cast<char>(0xFF));
    EXPECT_NO_THROW(EXPECT_TRUE(json::accept(json_report(results))));
}

}  // namespace
