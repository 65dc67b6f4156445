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

TEST(Budget, WhatCannotBeUsedIsNamed) {
    const Tree tree;
    EXPECT_EQ(tree.budget({"--image", "none.hex"}).exit_code, 3);
    EXPECT_EQ(tree.budget({"--against", "none.json"}).exit_code, 3);
    EXPECT_EQ(rover85({"budget", "--budgets", tree.file("none")}).exit_code, 3);
    EXPECT_EQ(tree.budget({"--update", "x.rlog"}).exit_code, 2);
}

}  // namespace
