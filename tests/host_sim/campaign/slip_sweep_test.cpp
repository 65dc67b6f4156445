// slip_sweep_test.cpp - same result on any number of threads; the JSON that scripts rely on.
#include "host_sim/campaign/slip_sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>

#include "host_sim/bind/slip_estimators.hpp"

namespace {

using namespace host_sim;

SweepSlipOptions short_sweep() {
    return {.estimator = EstimatorKind::map_paper, .seeds = 6, .length_cm = 1000};
}

TEST(SweepSlip, ResultDoesNotDependOnTheNumberOfThreads) {
    for (const Scenario scenario : kScenarios) {
        SweepSlipOptions options = short_sweep();
        options.scenario = scenario;
        options.threads = 1;
        const std::string one = sweep_slip_json(options, sweep_slip(options, make_slip_estimator));
        for (const unsigned threads : {2u, 5u}) {
            options.threads = threads;
            EXPECT_EQ(sweep_slip_json(options, sweep_slip(options, make_slip_estimator)), one)
                << name_of(scenario);
        }
    }
}

TEST(SweepSlip, RunIUsesSeedBasePlusI) {
    SweepSlipOptions options = short_sweep();
    const SweepSlipResult six = sweep_slip(options, make_slip_estimator);
    options.seed_base += 4;
    options.seeds = 2;
    const SweepSlipResult last_two = sweep_slip(options, make_slip_estimator);
    for (std::size_t i = 0; i < six.rows.size(); ++i) {
        EXPECT_EQ(six.runs[i][4], last_two.runs[i][0]);
        EXPECT_EQ(six.runs[i][5], last_two.runs[i][1]);
    }
}

TEST(SweepSlip, JsonHasTheKeysAndValuesThatScriptsRelyOn) {
    SweepSlipOptions options = short_sweep();
    options.arithmetic = Arithmetic::floating;
    options.terrain = TerrainKind::fractal;
    options.scenario = Scenario::noise_corr;
    options.seed_base = 77;
    const SweepSlipResult result = sweep_slip(options, make_slip_estimator);
    const auto document = nlohmann::json::parse(sweep_slip_json(options, result));
    EXPECT_EQ(document["estimator"], "map_paper");
    EXPECT_EQ(document["arithmetic"], "double");
    EXPECT_EQ(document["terrain"], "fractal");
    EXPECT_EQ(document["scenario"], "noise_corr");
    EXPECT_EQ(document["bin_cm"], 2.5);
    EXPECT_EQ(document["prior_mean_cm"], 6.0);
    EXPECT_EQ(document["prior_sigma_cm"], 0.05);
    EXPECT_EQ(document["true_mean_cm"], 5.0);
    EXPECT_EQ(document["seeds"], 6);
    EXPECT_EQ(document["seed_base"], 77);
    ASSERT_EQ(document["rows"].size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
        const auto& row = document["rows"][i];
        EXPECT_EQ(row["roughness"], kSweepRoughness[i]);
        EXPECT_EQ(row["odometry_error_pct"]["mean"], result.rows[i].mean_pct);
        EXPECT_EQ(row["odometry_error_pct"]["mean_abs"], result.rows[i].mean_abs_pct);
        EXPECT_EQ(row["odometry_error_pct"]["sd"], result.rows[i].sd_pct);
        EXPECT_EQ(row["odometry_error_pct"]["worst_abs"], result.rows[i].worst_abs_pct);
        EXPECT_EQ(row["sinkage_rms_cm"], result.rows[i].sinkage_rms_cm);
        EXPECT_EQ(row["lost_lock_runs"], result.rows[i].lost_lock_runs);
    }
}

TEST(SweepSlip, PriorSigmaDefaultsToTheEstimatorsOwnAndCanBeSet) {
    SweepSlipOptions options = short_sweep();
    options.prior_sigma_cm = 0.5;
    const auto document =
        nlohmann::json::parse(sweep_slip_json(options, sweep_slip(options, make_slip_estimator)));
    EXPECT_EQ(document["prior_sigma_cm"], 0.5);
    EXPECT_EQ(default_prior_sigma_cm(EstimatorKind::map_paper), 0.05);
}

int run(const SweepSlipOptions& options, std::string& out, std::string& err) {
    std::ostringstream out_stream;
    std::ostringstream err_stream;
    const int code = run_sweep_slip(options, make_slip_estimator, out_stream, err_stream);
    out = out_stream.str();
    err = err_stream.str();
    return code;
}

TEST(RunSweepSlip, PrintsATableAndWritesTheSameJsonAsItPrints) {
    std::string out;
    std::string err;
    SweepSlipOptions options = short_sweep();
    options.json_path = "-";
    EXPECT_EQ(run(options, out, err), 0);
    const std::string printed = out;
    EXPECT_TRUE(nlohmann::json::accept(printed)) << printed;
    options.json_path = ::testing::TempDir() + "slip_sweep_test.json";
    EXPECT_EQ(run(options, out, err), 0);
    std::ostringstream written;
    written << std::ifstream(options.json_path).rdbuf();
    EXPECT_EQ(written.str(), printed);
    for (const char* word : {"map_paper (fixed) on wilcox1994", "0.0025", "0.0800", "lost"}) {
        EXPECT_NE(out.find(word), std::string::npos) << word;
    }
    EXPECT_EQ(err, "");
}

TEST(RunSweepSlip, RefusesBadOptionsWithOneLineAndCode2) {
    std::string out;
    std::string err;
    const auto refused = [&](const SweepSlipOptions& options, const char* word) {
        EXPECT_EQ(run(options, out, err), 2) << word;
        EXPECT_NE(err.find(word), std::string::npos) << err;
        EXPECT_EQ(err.find('\n'), err.size() - 1) << err;
        EXPECT_EQ(out, "");
    };
    SweepSlipOptions options = short_sweep();
    options.bin_cm = 2.6;
    refused(options, "0.25, 0.5, ... 8 cm");
    options.bin_cm = std::nan("");
    refused(options, "bin");
    options = short_sweep();
    options.seeds = 0;
    refused(options, "seeds");
    options = short_sweep();
    options.true_mean_cm = 0;
    refused(options, "true mean");
    options = short_sweep();
    options.prior_mean_cm = -1;
    refused(options, "prior mean");
    options = short_sweep();
    options.prior_sigma_cm = 0;
    refused(options, "prior sigma");
}

TEST(RunSweepSlip, RefusesAnotherBinForMapGridAndIgnoresAnotherPriorSigmaWithANote) {
    std::string out;
    std::string err;
    SweepSlipOptions options{.estimator = EstimatorKind::map_grid, .seeds = 1, .length_cm = 200};
    EXPECT_EQ(run(options, out, err), 0);
    const std::string as_it_flies = out;
    options.bin_cm = 2.0;
    EXPECT_EQ(run(options, out, err), 2);
    EXPECT_NE(err.find("--bin"), std::string::npos) << err;
    options.bin_cm = 2.5;
    EXPECT_EQ(run(options, out, err), 0);
    EXPECT_EQ(out, as_it_flies);
    EXPECT_EQ(err, "");
    options.prior_sigma_cm = 0.05;
    EXPECT_EQ(run(options, out, err), 0);
    EXPECT_EQ(out, as_it_flies);
    EXPECT_NE(err.find("--prior-sigma is ignored"), std::string::npos) << err;
    options.prior_sigma_cm.reset();
    options.prior_mean_cm = 6.5;
    EXPECT_EQ(run(options, out, err), 2);
    EXPECT_NE(err.find("[1, 6] cm"), std::string::npos) << err;
}

TEST(RunSweepSlip, SaysWhichFileItCannotWrite) {
    std::string out;
    std::string err;
    SweepSlipOptions options = short_sweep();
    options.json_path = "/nonexistent/sweep.json";
    EXPECT_EQ(run(options, out, err), 2);
    EXPECT_NE(err.find("/nonexistent/sweep.json: No such file"), std::string::npos) << err;
}

TEST(ScenarioNames, AreDistinct) {
    std::set<std::string_view> names;
    for (const Scenario scenario : kScenarios) names.insert(name_of(scenario));
    EXPECT_EQ(names.size(), std::size(kScenarios));
    EXPECT_FALSE(names.contains("unknown"));
}

}  // namespace
