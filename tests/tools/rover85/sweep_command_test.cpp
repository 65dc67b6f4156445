// sweep_command_test.cpp - options in, table or JSON out, exit codes as promised.
#include "tools/rover85/sweep_command.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/rover85/command_line.hpp"

namespace {

using rover85_test::Outcome;

Outcome run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "sweep");
    return rover85_test::run_command(add_sweep_command, std::move(arguments));
}

TEST(SweepCommand, SlipPassesEveryOptionOn) {
    const Outcome outcome =
        run({"slip",    "--estimator",   "map_paper", "--arithmetic", "double", "--terrain",
             "fractal", "--scenario",    "uniform",   "--bin",        "2",      "--prior-mean",
             "5.5",     "--prior-sigma", "0.5",       "--true-mean",  "4.5",    "--seeds",
             "2",       "--seed-base",   "9",         "--threads",    "1",      "--json",
             "-"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto document = nlohmann::json::parse(outcome.out);
    EXPECT_EQ(document["estimator"], "map_paper");
    EXPECT_EQ(document["arithmetic"], "double");
    EXPECT_EQ(document["terrain"], "fractal");
    EXPECT_EQ(document["scenario"], "uniform");
    EXPECT_EQ(document["bin_cm"], 2.0);
    EXPECT_EQ(document["prior_mean_cm"], 5.5);
    EXPECT_EQ(document["prior_sigma_cm"], 0.5);
    EXPECT_EQ(document["true_mean_cm"], 4.5);
    EXPECT_EQ(document["seeds"], 2);
    EXPECT_EQ(document["seed_base"], 9);
    EXPECT_EQ(document["rows"].size(), 6u);
}

TEST(SweepCommand, Table1PrintsTheTableUpToTheLargestBinAsked) {
    const Outcome outcome = run({"table1", "--bin-max", "0.5", "--seeds", "1"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(" 20.87 "), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("bins <= 4 cm"), std::string::npos);
    EXPECT_EQ(outcome.out.find(" 18.94 "), std::string::npos) << "bin 0.75 cm was not asked for";
}

TEST(SweepCommand, UsageErrorsGive2) {
    const std::vector<std::vector<std::string>> wrong = {
        {},
        {"slip", "--estimator", "map_papers"},
        {"slip", "--arithmetic", "float"},
        {"slip", "--terrain", "flat"},
        {"slip", "--scenario", "gauss"},
        {"slip", "--bin", "9"},
        {"slip", "--estimator", "map_paper", "--bin", "2.6", "--seeds", "1"},
        {"slip", "--seeds", "0"},
        {"slip", "--seeds", "-3"},
        {"slip", "--prior-sigma", "0"},
        {"slip", "--true-mean", "nan"},
        {"slip", "--nonsense"},
        {"slip", "--estimator", "map_paper", "--seeds", "1", "--json", "/nonexistent/a.json"},
        {"table1", "--arithmetic", "float"},
        {"table1", "--bin-max", "0"},
    };
    for (const auto& arguments : wrong) {
        EXPECT_EQ(run(arguments).exit_code, 2) << testing::PrintToString(arguments);
    }
}

}  // namespace
