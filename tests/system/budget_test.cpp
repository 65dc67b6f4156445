// budget_test.cpp - `rover85 budget` as a user runs it, on the image that the build made.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/system/program.hpp"

namespace {

namespace fs = std::filesystem;
using system_test::Folder;
using system_test::Outcome;
using system_test::read_bytes;
using system_test::rover85;
using system_test::write_bytes;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

const fs::path kSource = ROVER_SOURCE_DIR;

/// A tree with one log, the project's modules and limits, and the numbers of that log.
class Tree {
public:
    Tree() {
        fs::create_directories(folder_ / "tests/golden");
        fs::copy(kSource / "tests/budgets", budgets());
        fs::copy(kSource / "tests/golden/replay/smooth.rlog", folder_ / "tests/golden/smooth.rlog");
        fs::remove(budgets() / "budget.json");
    }
    [[nodiscard]] Outcome budget(std::vector<std::string> more = {}) const {
        std::vector<std::string> arguments = {"budget", "--budgets", budgets().string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return rover85(arguments);
    }
    [[nodiscard]] fs::path budgets() const { return folder_ / "tests/budgets"; }
    [[nodiscard]] std::string file(const char* name) const { return folder_ / name; }

private:
    Folder folder_;
};

TEST(Budget, TheImagesNumbersAreTheReviewedOnes) {
    const Outcome run = rover85({"budget", "--budgets", (kSource / "tests/budgets").string()});
    EXPECT_EQ(run.exit_code, 0) << run.err << run.out;
    EXPECT_THAT(run.out, ContainsRegex("All [0-9]+ numbers are the reviewed ones"));
}

TEST(Budget, WithoutReviewedNumbersItSaysHowToWriteThem) {
    const Tree tree;
    const Outcome run = tree.budget();
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.err, HasSubstr("budget.json: does not exist; write it with `rover85 budget "
                                   "--update`"));
}

TEST(Budget, UpdateWritesWhatThenPassesAndAnyOtherNumberFails) {
    const Tree tree;
    ASSERT_EQ(tree.budget({"--update"}).exit_code, 0);
    EXPECT_EQ(tree.budget().exit_code, 0);
    const fs::path file = tree.budgets() / "budget.json";
    auto document = nlohmann::json::parse(read_bytes(file));
    const auto rom = document["numbers"]["image.rom_bytes"].get<int>();
    for (const int change : {-1, 1}) {
        document["numbers"]["image.rom_bytes"] = rom + change;
        write_bytes(file, document.dump());
        const Outcome run = tree.budget();
        EXPECT_EQ(run.exit_code, 1);
        EXPECT_THAT(run.err, HasSubstr("1 of "));
        EXPECT_THAT(run.out,
                    ContainsRegex("image.rom_bytes +" + std::to_string(rom + change) + " +" +
                                  std::to_string(rom) + " +" + (change < 0 ? "\\+1" : "-1")));
    }
}

TEST(Budget, AFunctionWithoutAModuleFailsByName) {
    const Tree tree;
    const fs::path file = tree.budgets() / "modules.csv";
    std::string modules = read_bytes(file);
    const std::string line = "wait,idle,*::rover_wait*\n";
    ASSERT_NE(modules.find(line), std::string::npos);
    modules.erase(modules.find(line), line.size());
    write_bytes(file, modules);
    const Outcome run = tree.budget({"--update"});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, ContainsRegex("rover_wait\\(\\): belongs to no module"));
    EXPECT_FALSE(fs::exists(tree.budgets() / "budget.json"));
}

TEST(Budget, DocumentsAndTheDifferenceFromAnotherRevision) {
    const Tree tree;
    ASSERT_EQ(tree.budget({"--update"}).exit_code, 0);
    const std::string json = tree.file("a.json");
    ASSERT_EQ(tree.budget({"--json", json, "--html", tree.file("a.html"), "--markdown",
                           tree.file("a.md")})
                  .exit_code,
              0);
    EXPECT_THAT(read_bytes(tree.file("a.html")), HasSubstr("<h1>Budget of the image</h1>"));
    EXPECT_THAT(read_bytes(tree.file("a.md")), HasSubstr("## Modules: T-states a step"));
    auto document = nlohmann::json::parse(read_bytes(json));
    EXPECT_EQ(document["steps"], 288);
    EXPECT_GT(document["rom_bytes"], 0);
    document["numbers"]["image.ram_bytes"] = 1;
    write_bytes(json, document.dump());
    const Outcome run = tree.budget({"--against", json});
    EXPECT_EQ(run.exit_code, 0) << "only the reviewed numbers judge";
    EXPECT_THAT(run.out, ContainsRegex("Differences from .*a.json"));
    EXPECT_THAT(run.out, ContainsRegex("image.ram_bytes +1 +"));
}

TEST(Budget, NamedLogsAreMeasuredAndNotCompared) {
    const Tree tree;
    const Outcome run = tree.budget({(kSource / "tests/golden/replay/rough.rlog").string()});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("rough 288"));
    EXPECT_THAT(run.out, HasSubstr("not compared"));
}

TEST(BudgetBounds, NothingIsAboveItsBoundAndEveryDeadlineHolds) {
    // The stored logs, as they are and with requests in every step, and some random ones.
    const Tree tree;
    const std::string json = tree.file("bounds.json");
    const Outcome run =
        rover85({"budget", "--bounds", "--budgets", (kSource / "tests/budgets").string(),
                 "--random", "10", "--json", json});
    EXPECT_EQ(run.exit_code, 0) << run.err << run.out;
    EXPECT_THAT(run.out, HasSubstr("nothing above its bound"));
    EXPECT_THAT(run.out, ContainsRegex("All [0-9]+ numbers are the reviewed ones"));
    EXPECT_THAT(run.out, Not(HasSubstr("  NO\n")));
    const auto document = nlohmann::json::parse(read_bytes(json));
    const auto& step = document["tasks"][0];
    // The requirement: a bound within 1.6 of the worst that is seen.
    EXPECT_LE(step["bound_t"].get<double>(), 1.6 * step["observed_t"].get<double>());
    EXPECT_EQ(document["deadlines"].size(), 4U);
    for (const auto& deadline : document["deadlines"]) EXPECT_TRUE(deadline["holds"]);
}

/// Replaces a text in a file of the tree's budgets, and flies its one log.
Outcome bounds_with(const char* name, const std::string& text, const std::string& instead) {
    const Tree tree;
    const fs::path file = tree.budgets() / name;
    std::string content = read_bytes(file);
    const std::size_t at = content.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    content.replace(at, text.size(), instead);
    write_bytes(file, content);
    return tree.budget({"--bounds"});
}

TEST(BudgetBounds, ALoopWithoutABoundIsAnErrorWithItsSourceLine) {
    const Outcome run = bounds_with("flow.csv", "turns,*::side_step(*#1 3,", "# ");
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.err, ContainsRegex("firmware/inputs/odometer.hpp:[0-9]+: .*side_step.*loop 1"));
    EXPECT_THAT(run.err, HasSubstr("the loop has no bound"));
}

TEST(BudgetBounds, ABoundThatIsTooLowIsSeen) {
    const Outcome run =
        bounds_with("flow.csv", "turns,*::side_step(*#1 3,", "turns,*::side_step(*#1 2,");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, ContainsRegex("exceeded: .*side_step.*loop 1: more than 2 turns"));
}

TEST(BudgetBounds, AFactThatIsWrongIsSeenWithItsLine) {
    const Outcome run = bounds_with("flow.csv", "fact,*::push_all(*#1 <= 50 *::queue_frame(*",
                                    "fact,*::push_all(*#1 <= 49 *::queue_frame(*");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, ContainsRegex("exceeded: .*flow.csv:[0-9]+: does not hold in a step"));
}

TEST(BudgetBounds, AnotherNumberFails) {
    const Outcome run = bounds_with("bounds.json", "\"bound.stack\": ", "\"bound.stack\": 1");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr("1 of "));
    EXPECT_THAT(run.out, HasSubstr("bound.stack"));
}

TEST(Budget, WhatCannotBeUsedIsNamed) {
    const Tree tree;
    EXPECT_EQ(tree.budget({"--image", "none.hex"}).exit_code, 3);
    EXPECT_EQ(tree.budget({"--against", "none.json"}).exit_code, 3);
    EXPECT_EQ(rover85({"budget", "--budgets", tree.file("none")}).exit_code, 3);
    EXPECT_EQ(tree.budget({"--update", "x.rlog"}).exit_code, 2);
    EXPECT_EQ(tree.budget({"--random", "3"}).exit_code, 2);
    EXPECT_EQ(tree.budget({"--bounds", "--html", "x.html"}).exit_code, 2);
}

}  // namespace
