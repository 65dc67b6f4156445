// observers_test.cpp - trace, profile, coverage and signals through the console.
#include "tools/debug/observers.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/tools/debug/bench.hpp"

namespace debug_console {
namespace {

using debug_test::Bench;
using testing::HasSubstr;
using testing::StartsWith;

class ObserversTest : public testing::Test {
protected:
    ObserversTest() {
        std::string name =
            (std::filesystem::temp_directory_path() / "debug_observers_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
        folder_ = name;
    }
    ~ObserversTest() override { std::filesystem::remove_all(folder_); }
    std::string path(const char* name) const { return (folder_ / name).string(); }
    std::string read(const char* name) const {
        std::ifstream in(folder_ / name);
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }
    std::filesystem::path folder_;
};

TEST_F(ObserversTest, TheTraceHasALineAStep) {
    Bench bench;
    EXPECT_EQ(bench("trace on " + path("t.txt")), "");
    EXPECT_TRUE(bench.session.observer != nullptr);
    bench("until 37");
    EXPECT_EQ(bench("trace off"), "");
    EXPECT_TRUE(bench.session.observer == nullptr) << "full speed again";
    bench("step");
    std::istringstream lines(read("t.txt"));
    std::vector<std::string> all;
    for (std::string line; std::getline(lines, line);) all.push_back(line);
    ASSERT_EQ(all.size(), 4u) << "JMP, LXI, MVI, OUT";
    EXPECT_THAT(all[3], HasSubstr("OUT 13H"));
    EXPECT_EQ(bench("trace on " + path("no/t.txt")),
              "refused: " + path("no/t.txt") +
                  ": cannot be written: No such file or directory; choose another file");
    EXPECT_EQ(bench("trace"), "refused: on FILE or off is missing");
    EXPECT_EQ(bench("trace off"), "") << "silent when it is off";
}

// print takes at least MOV, ORA and RZ of 182 T; everything before is main's.
TEST_F(ObserversTest, TheProfileAddsUpByFunction) {
    Bench bench;
    EXPECT_EQ(bench("profile show"), "refused: the profile is off; `profile on` begins one");
    bench("profile on");
    bench("tbreak print");
    bench("c");
    const host_sim::ProfileReport report = bench.console.observers.profile();
    EXPECT_EQ(report.total_t, 182u);
    uint64_t main_t = 0;
    for (const auto& function : report.functions) {
        if (function.name == "main") main_t = function.exclusive_t;
    }
    EXPECT_EQ(main_t, 172u) << "all but the JMP at 0";
    EXPECT_THAT(bench("profile show"), HasSubstr("main"));
    EXPECT_THAT(bench("profile json"), HasSubstr("\"total_t\": 182"));
    bench("profile off");
    EXPECT_THAT(bench("profile show"), StartsWith("refused: "));
}

TEST_F(ObserversTest, CoverageIsShownAndWritten) {
    Bench bench;
    EXPECT_THAT(bench("coverage " + path("c.info")), StartsWith("refused: coverage is off"));
    bench.console.observers.image.put(0, 0xC3);
    bench("coverage on");
    bench("step 4");
    EXPECT_THAT(bench("coverage show"), StartsWith("4 of 246 documented opcodes executed"));
    EXPECT_EQ(bench("coverage " + path("c.info")),
              "wrote " + path("c.info") + "\nwrote " + path("c.info.lst") + "\n");
    EXPECT_THAT(read("c.info"), HasSubstr("SF:" + path("c.info.lst")));
    EXPECT_FALSE(read("c.info.lst").empty());
    bench("coverage off");
    EXPECT_TRUE(bench.session.observer == nullptr);
}

TEST_F(ObserversTest, SignalsAndVariablesGoToAVcd) {
    Bench bench;
    EXPECT_EQ(bench("vcd on " + path("s.vcd") + " count text:2"), "");
    bench("snapshot");
    bench("until 11ms");
    EXPECT_EQ(bench("restore"),
              "refused: a VCD file cannot go back in time; `vcd off` ends it first");
    bench("vcd off");
    EXPECT_THAT(bench("restore"), StartsWith("T 0 "));
    const std::string vcd = read("s.vcd");
    EXPECT_THAT(vcd, HasSubstr("$timescale"));
    EXPECT_THAT(vcd, HasSubstr("count"));
    EXPECT_THAT(vcd, HasSubstr("text"));
    EXPECT_EQ(bench("vcd on " + path("s.vcd") + " count:5"),
              "refused: count:5: a variable has 1 to 4 bytes, as in name:2");
    EXPECT_THAT(bench("vcd on " + path("no/s.vcd")), StartsWith("refused: "));
    EXPECT_THAT(bench("vcd on " + path("s.vcd") + " nowhere"), StartsWith("refused: "));
    EXPECT_FALSE(bench.console.observers.vcd_on());
}

TEST_F(ObserversTest, ClosingCompletesTheFiles) {
    {
        Bench bench;
        bench("trace on " + path("t.txt"));
        bench("step 2");
        bench.console.observers.close();
        EXPECT_TRUE(bench.session.observer == nullptr);
        bench("vcd on " + path("s.vcd"));
        bench("step 2");
    }
    EXPECT_THAT(read("t.txt"), HasSubstr("LXI SP"));
    EXPECT_THAT(read("s.vcd"), HasSubstr("$enddefinitions"));
}

}  // namespace
}  // namespace debug_console
