// refusals_test.cpp - exit codes, messages and help of the real program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/system/program.hpp"

namespace {

using system_test::Folder;
using system_test::Outcome;
using system_test::rover85;
using system_test::write_bytes;
using testing::HasSubstr;

void expect_one_line(const std::string& err) {
    EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
    EXPECT_TRUE(err.ends_with('\n')) << err;
}

/// Exit code 3, nothing on standard output, one line that names what, where and what to do.
void expect_refused(const Outcome& run, const std::vector<std::string>& words) {
    EXPECT_EQ(run.exit_code, 3) << run.out << run.err;
    EXPECT_EQ(run.out, "");
    expect_one_line(run.err);
    EXPECT_THAT(run.err, testing::ContainsRegex("; |[.] [A-Z]|: is not ")) << "advice or choices";
    for (const std::string& word : words) EXPECT_THAT(run.err, HasSubstr(word));
}

class RefusedLog : public testing::Test {
protected:
    void SetUp() override {
        const Outcome run = rover85({"simulate", "--length", "0.5", "--out", folder_ / "drive"});
        ASSERT_EQ(run.exit_code, 0) << run.err;
        rlog_ = system_test::read_bytes(folder_ / "drive/traverse.rlog");
        csv_ = system_test::read_bytes(folder_ / "drive/traverse.csv");
    }

    Outcome replay(const std::string& name, const std::string& bytes) {
        write_bytes(folder_ / name, bytes);
        const Outcome run = rover85({"replay", folder_ / name, "--out", folder_ / "out"});
        EXPECT_FALSE(std::filesystem::exists(folder_ / "out")) << name << ": nothing is half-done";
        return run;
    }

    Folder folder_;
    std::string rlog_, csv_;
};

TEST_F(RefusedLog, ATornOrDamagedRlogIsRefusedWithItsOffset) {
    expect_refused(replay("torn.rlog", rlog_.substr(0, rlog_.size() - 7)),
                   {"torn.rlog:byte ", "recover"});
    std::string damaged = rlog_;
    damaged[damaged.size() / 2] ^= 0x10;
    expect_refused(replay("damaged.rlog", damaged), {"damaged.rlog:byte "});
}

TEST_F(RefusedLog, AnEditedOrReorderedCsvIsRefusedWithItsLine) {
    std::string edited = csv_;
    const std::size_t at = edited.find("odometry_only");
    ASSERT_NE(at, std::string::npos);
    edited.replace(at, 13, "odometry_inly");
    expect_refused(replay("edited.csv", edited), {"edited.csv:"});

    const std::size_t end = csv_.rfind("# crc32"), last = csv_.rfind('\n', end - 2) + 1;
    const std::string doubled = csv_.substr(0, end) + csv_.substr(last, end - last);
    const auto line = std::ranges::count(csv_.substr(0, end), '\n') + 1;
    expect_refused(replay("doubled.csv", doubled), {"doubled.csv:" + std::to_string(line) + ":"});
}

TEST_F(RefusedLog, ForeignAndEmptyFilesAreRefused) {
    expect_refused(replay("empty.rlog", ""), {"empty.rlog"});
    expect_refused(replay("notes.txt", "The rover drove well.\n"), {"notes.txt"});
    expect_refused(replay("page.html", system_test::read_bytes(folder_ / "drive/report.html")),
                   {"page.html"});
    expect_refused(rover85({"replay", folder_ / "absent.rlog", "--out", folder_ / "out"}),
                   {"absent.rlog"});
    expect_refused(rover85({"replay", folder_.path().string(), "--out", folder_ / "out"}),
                   {folder_.path().string()});
    expect_refused(rover85({"report", folder_ / "nowhere"}), {"nowhere"});
    write_bytes(folder_ / "foreign.rlog", "GIF89a");
    expect_refused(rover85({"recover", folder_ / "foreign.rlog", "-o", folder_ / "out.rlog"}),
                   {"foreign.rlog"});
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.rlog"));
}

TEST(Refusals, AFolderThatCannotBeMadeIsNamed) {
    const Folder folder;
    write_bytes(folder / "file", "in the way");
    expect_refused(rover85({"simulate", "--length", "0.5", "--out", folder / "file"}),
                   {folder / "file", "choose another --out"});
    expect_refused(rover85({"simulate", "--length", "0.5", "--out", folder / "file/below"}),
                   {folder / "file/below", "choose another --out"});
}

TEST(Refusals, AFileThatCannotBeWrittenIsNamed) {
    const Folder folder;
    for (const std::string file :
         {"traverse.rlog", "traverse.csv", "summary.json", "report.html"}) {
        const std::string out = folder / ("out_" + file);
        std::filesystem::create_directories(out + "/" + file + "/in_the_way");
        expect_refused(rover85({"simulate", "--length", "0.5", "--out", out}), {file});
    }
}

TEST(Refusals, OptionsWithAMalformedValueSayWhatIsAllowed) {
    const Folder folder;
    const std::string out = folder / "out";
    expect_refused(rover85({"simulate", "--faults", "bogie_left:bent@1-2", "--out", out}),
                   {"bogie_left:bent@1-2", "stuck"});
    expect_refused(rover85({"simulate", "--hand-move", "soon", "--out", out}),
                   {"--hand-move soon", "SECONDS:CM"});
    expect_refused(rover85({"simulate", "--terrain", "swamp", "--out", out}), {"swamp", "fractal"});
    expect_refused(
        rover85({"simulate", "--terrain", "profile:" + (folder / "no.csv"), "--out", out}),
        {"no.csv"});
    expect_refused(rover85({"simulate", "--vehicle", folder / "no.toml", "--out", out}),
                   {"no.toml"});
}

TEST(Usage, WrongOptionsGive2AndNameTheWord) {
    const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
        {{}, "subcommand"},
        {{"fly"}, "fly"},
        {{"simulate", "--speed", "3"}, "--speed"},
        {{"simulate", "--roughness", "rough"}, "--roughness"},
        {{"simulate", "--length", "-1"}, "--length"},
        {{"simulate", "--target", "moon"}, "--target"},
        {{"simulate", "--seed", "-1"}, "--seed"},
        {{"replay"}, "LOG"},
        {{"recover", "a.rlog"}, "--output"},
        {{"report"}, "DIR"},
        {{"import"}, "subcommand"},
        {{"import", "omni", "run.csv", "-o", "run.txt"}, "run.txt"},
        {{"sweep"}, "subcommand"},
    };
    for (const auto& [arguments, word] : wrong) {
        const Outcome run = rover85(arguments);
        EXPECT_EQ(run.exit_code, 2) << testing::PrintToString(arguments) << run.out << run.err;
        EXPECT_THAT(run.err, HasSubstr(word)) << testing::PrintToString(arguments);
    }
}

TEST(Help, OfEveryCommandTeachesByExample) {
    const Outcome all = rover85({"--help"});
    EXPECT_EQ(all.exit_code, 0);
    EXPECT_THAT(all.out, HasSubstr("Examples:"));
    const std::vector<std::string> commands = {"simulate",  "replay", "sweep",   "recover",
                                               "calibrate", "import", "report",  "main-job",
                                               "debug",     "flash",  "compare", "budget"};
    for (const std::string& command : commands) {
        EXPECT_THAT(all.out, HasSubstr(command));
        const Outcome run = rover85({command, "--help"});
        EXPECT_EQ(run.exit_code, 0) << command;
        EXPECT_EQ(run.err, "") << command;
        if (command != "import") {
            EXPECT_THAT(run.out, HasSubstr("  rover85 " + command)) << command;
        }
    }
    for (const std::string source : {"borealtc", "omni"}) {
        const Outcome run = rover85({"import", source, "--help"});
        EXPECT_EQ(run.exit_code, 0);
        EXPECT_THAT(run.out, HasSubstr("Example:\n  rover85 import " + source));
    }
}

TEST(Help, VersionNamesTheSourcesOfTheFirmware) {
    const Outcome run = rover85({"--version"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.out,
                testing::MatchesRegex("rover85 [0-9.]+ sources [0-9a-f]{8} host\n(.*\n)?"));
}

}  // namespace
