// observations_test.cpp - trace, profile and coverage of the real i85run; they change no result and
// agree with --count-function. T-states are added up by hand from Intel's table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/assemble.hpp"
#include "tests/tools/i85run/run_program.hpp"

namespace {

using i85run_test::Folder;
using i85run_test::Outcome;
using nlohmann::json;
using testing::HasSubstr;

// main: CALL 18, CALL 18, HLT 5; work: DCR 4, JNZ 7 or 10, RET 10
constexpr const char* kSource = R"(
        MVI  B,2       ; 7 T: until work returns for the second time
        CALL WORK
        MVI  B,1
        CALL WORK
        HLT
WORK:   DCR  B
        JNZ  WORK
        RET
)";
constexpr int kFirstT = 2 * 4 + 10 + 7 + 10, kSecondT = 4 + 7 + 10;
constexpr int kMainT = 7 + 18 + 7 + 18 + 5;

class I85runObservations : public testing::Test {
protected:
    I85runObservations() {
        folder_.write("prog.bin", test_support::assemble(kSource).bytes);
        folder_.write("prog.sym", "0000 000B F main\n000B 0005 F work\n");
    }

    Outcome run(std::vector<std::string> options) {
        options.insert(options.begin(), {"prog.bin", "--load", "0", "--json", "prog.json"});
        const Outcome outcome = folder_.run(options);
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_EQ(json::parse(folder_.read("prog.json"))["t_states"], kMainT + kFirstT + kSecondT);
        return outcome;
    }

    [[nodiscard]] std::ptrdiff_t line_count(const std::string& file) const {
        return std::ranges::count(folder_.read(file), '\n');
    }

    Folder folder_;
};

TEST_F(I85runObservations, ProfileAndCountedFunctionAgree) {
    const Outcome outcome =
        run({"--profile", "--profile-json", "profile.json", "--count-function", "work"});
    const json function = json::parse(folder_.read("prog.json"))["function"];
    EXPECT_EQ(function["t_states"], kFirstT + kSecondT);
    EXPECT_EQ(function["t_states_worst"], kFirstT);
    const json profile = json::parse(folder_.read("profile.json"));
    bool found = false;
    for (const json& line : profile["functions"]) {
        if (line["name"] != "work") continue;
        found = true;
        EXPECT_EQ(line["calls"], function["calls"]);
        EXPECT_EQ(line["inclusive_t"], function["t_states"]);
        EXPECT_EQ(line["worst_t"], function["t_states_worst"]);
    }
    EXPECT_TRUE(found);
    EXPECT_THAT(outcome.out, HasSubstr("exclusive T"));
}

TEST_F(I85runObservations, ATraceIsALineForEachInstruction) {
    run({"--trace", "all.txt"});
    // MVI, CALL, 2 x (DCR, JNZ), RET, MVI, CALL, DCR, JNZ, RET, HLT
    EXPECT_EQ(line_count("all.txt"), 13);
    EXPECT_THAT(folder_.read("all.txt"), HasSubstr("CALL work"));
}

TEST_F(I85runObservations, ATraceMayBeginAndEndAtATState) {
    run({"--trace", "part.txt", "--trace-from", "25", "--trace-to", "29"});
    EXPECT_EQ(line_count("part.txt"), 2) << "DCR begins at T 25, JNZ at 29";
    EXPECT_THAT(folder_.read("part.txt"), HasSubstr("DCR B"));
    EXPECT_THAT(folder_.read("part.txt"), HasSubstr("JNZ work"));
}

TEST_F(I85runObservations, CoverageWithoutSourcesIsThatOfAListing) {
    const Outcome outcome = run({"--coverage", "prog.info"});
    const std::string info = folder_.read("prog.info");
    EXPECT_THAT(info, HasSubstr("SF:prog.lst\n"));
    EXPECT_THAT(info, HasSubstr("LF:8\nLH:8\n")) << "eight instructions, all executed";
    EXPECT_THAT(folder_.read("prog.lst"), HasSubstr("CALL work"));
    EXPECT_THAT(outcome.out, HasSubstr("documented opcodes executed"));
}

TEST_F(I85runObservations, CoverageOfSourcesWhereTheSymbolsNameThem) {
    folder_.write("prog.sym", "0000 000B F main @ main.cpp:3\n000B 0005 F work @ main.cpp:9\n");
    run({"--coverage", "prog.info"});
    const std::string info = folder_.read("prog.info");
    EXPECT_THAT(info, HasSubstr("SF:main.cpp\n"));
    EXPECT_THAT(info, HasSubstr("DA:9,3\n")) << "DCR is executed three times";
    EXPECT_FALSE(std::filesystem::exists(folder_.path("prog.lst")));
}

TEST_F(I85runObservations, AFileThatCannotBeWrittenStopsBeforeTheRun) {
    for (const char* option : {"--trace", "--profile-json", "--coverage"}) {
        const Outcome outcome = folder_.run({"prog.bin", "--load", "0", option, "nowhere/file"});
        EXPECT_EQ(outcome.exit_code, 3) << option;
        EXPECT_EQ(outcome.out, "");
        EXPECT_THAT(outcome.err, HasSubstr("nowhere/file: cannot be opened for writing"));
    }
}

TEST_F(I85runObservations, AFullDiskIsReported) {
    if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
    const Outcome outcome = folder_.run({"prog.bin", "--load", "0", "--json", "/dev/full"});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("/dev/full: cannot be written completely"));
    EXPECT_EQ(folder_.run({"prog.bin", "--load", "0", "--trace", "/dev/full"}).exit_code, 3);
}

}  // namespace
