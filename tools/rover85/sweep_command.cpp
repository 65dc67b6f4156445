#include "tools/rover85/sweep_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <map>
#include <memory>
#include <string>

#include "host_sim/bind/slip_estimators.hpp"
#include "host_sim/campaign/alarm_sweep.hpp"
#include "host_sim/campaign/slip_sweep.hpp"
#include "host_sim/campaign/table1_sweep.hpp"

namespace {

using host_sim::Arithmetic;
using host_sim::EstimatorKind;
using host_sim::Scenario;
using host_sim::TerrainKind;

const std::map<std::string, EstimatorKind> kEstimatorNames = {
    {"map_paper", EstimatorKind::map_paper}, {"map_grid", EstimatorKind::map_grid}};
const std::map<std::string, Arithmetic> kArithmeticNames = {{"fixed", Arithmetic::fixed},
                                                            {"double", Arithmetic::floating}};
const std::map<std::string, TerrainKind> kTerrainNames = {{"fractal", TerrainKind::fractal},
                                                          {"wilcox1994", TerrainKind::wilcox1994}};

std::map<std::string, Scenario> scenario_names() {
    std::map<std::string, Scenario> names;
    for (const Scenario scenario : host_sim::kScenarios) {
        names.emplace(host_sim::name_of(scenario), scenario);
    }
    return names;
}

template <class T>
std::string join_names(const std::map<std::string, T>& names) {
    std::string joined;
    for (const auto& [name, value] : names) joined += (joined.empty() ? "" : "|") + name;
    return joined;
}

/// An option whose value is one of `names`; the help lists them, an error too.
template <class T>
CLI::Option* add_choice(CLI::App& app, const std::string& option, T& value,
                        const std::map<std::string, T>& names, const std::string& help) {
    std::string fallback;
    for (const auto& [name, meaning] : names) {
        if (meaning == value) fallback = name;
    }
    const auto parse = [&value, names](const std::string& word) {
        const auto found = names.find(word);
        if (found == names.end()) {
            throw CLI::ValidationError(fmt::format("{} is not one of {}", word, join_names(names)));
        }
        value = found->second;
    };
    return app.add_option_function<std::string>(option, parse, help)
        ->type_name(join_names(names))
        ->default_str(fallback);
}

/// A bar on standard error, and nothing at all when that is not a terminal.
host_sim::Progress progress_bar() {
    if (isatty(STDERR_FILENO) == 0) return {};
    return [](std::size_t done, std::size_t total) {
        constexpr std::size_t kWidth = 40;
        const std::size_t filled = kWidth * done / total;
        std::cerr << fmt::format("\r[{:<{}}] {}/{} seeds", std::string(filled, '='), kWidth, done,
                                 total);
        if (done == total) std::cerr << "\r\033[K";
        std::cerr.flush();
    };
}

template <class Options>
void add_run_options(CLI::App& app, Options& options,
                     std::uint32_t seeds_max = host_sim::kSweepSeedsMax) {
    app.add_option("--seeds", options.seeds, "Runs for every figure")
        ->type_name("N")
        ->check(CLI::Range(1u, seeds_max))
        ->capture_default_str();
    app.add_option("--seed-base", options.seed_base, "First seed; run i uses seed-base + i")
        ->type_name("S")
        ->capture_default_str();
    app.add_option("--threads", options.threads, "0: one per core. The result is the same for all")
        ->type_name("N")
        ->check(CLI::Range(0u, 1024u))
        ->capture_default_str();
    app.add_option("--json", options.json_path, "Also write JSON to FILE; - prints it instead")
        ->type_name("FILE");
}

void add_slip(CLI::App& sweep, int& exit_code) {
    auto options = std::make_shared<host_sim::SweepSlipOptions>();
    CLI::App& slip = *sweep.add_subcommand(
        "slip", "Odometry and sinkage error of an estimator, by roughness of the ground");
    add_choice(slip, "--estimator", options->estimator, kEstimatorNames, "Which estimator");
    add_choice(slip, "--arithmetic", options->arithmetic, kArithmeticNames,
               "The integers that fly, or their double-precision model");
    add_choice(slip, "--terrain", options->terrain, kTerrainNames,
               "Random amplitudes, or those of the paper's own ground");
    add_choice(slip, "--scenario", options->scenario, scenario_names(),
               "How the vehicle advances and what its sensors add");
    const auto number = [&](const char* name, double& value, double low, double high,
                            const char* help) {
        slip.add_option(name, value, help)
            ->type_name("CM")
            ->check(CLI::Range(low, high))
            ->capture_default_str();
    };
    slip.add_option_function<double>(
            "--bin", [options](double bin) { options->bin_cm = bin; },
            "Bin size of map_paper, and spacing of its ground's samples (2.5 unless given; "
            "map_grid has its own)")
        ->type_name("CM")
        ->check(CLI::Range(0.25, 8.0));
    number("--prior-mean", options->prior_mean_cm, 0.1, 50.0, "Advance that the estimator expects");
    number("--true-mean", options->true_mean_cm, 0.1, 50.0, "Mean advance of a cycle in truth");
    slip.add_option_function<double>(
            "--prior-sigma", [options](double sigma) { options->prior_sigma_cm = sigma; },
            fmt::format("Spread that map_paper expects ({} unless given; map_grid has its own)",
                        host_sim::default_prior_sigma_cm(EstimatorKind::map_paper)))
        ->type_name("CM")
        ->check(CLI::Range(0.01, 20.0));
    add_run_options(slip, *options);
    slip.footer(
        "Examples:\n"
        "  rover85 sweep slip --estimator map_grid --terrain fractal --seeds 40\n"
        "  rover85 sweep slip --estimator map_paper --bin 2.5 --prior-sigma 0.5\n"
        "  rover85 sweep slip --scenario slope_sinkage --seeds 100 --seed-base 5000 --json "
        "out.json");
    slip.callback([options, &exit_code] {
        exit_code = host_sim::run_sweep_slip(*options, host_sim::make_slip_estimator, std::cout,
                                             std::cerr, progress_bar());
    });
}

void add_table1(CLI::App& sweep, int& exit_code) {
    auto options = std::make_shared<host_sim::SweepTable1Options>();
    CLI::App& table1 = *sweep.add_subcommand(
        "table1", "All 32 x 6 cells of the 1994 paper's Table 1, ours beside the print");
    add_choice(table1, "--arithmetic", options->arithmetic, kArithmeticNames,
               "map_paper in integers, or its double-precision model");
    add_choice(table1, "--terrain", options->terrain, kTerrainNames,
               "Random amplitudes, or those of the paper's own ground");
    table1.add_option("--bin-max", options->bin_max_cm, "Leave out larger bins")
        ->type_name("CM")
        ->check(CLI::Range(0.25, 8.0))
        ->capture_default_str();
    add_run_options(table1, *options);
    table1.footer(
        "Examples:\n"
        "  rover85 sweep table1\n"
        "  rover85 sweep table1 --arithmetic double --seeds 40 --json table1.json");
    table1.callback([options, &exit_code] {
        exit_code = host_sim::run_sweep_table1(*options, host_sim::make_slip_estimator, std::cout,
                                               std::cerr, progress_bar());
    });
}

void add_alarm(CLI::App& sweep, int& exit_code) {
    auto options = std::make_shared<host_sim::SweepAlarmOptions>();
    CLI::App& alarm = *sweep.add_subcommand(
        "alarm", "False alarms and detection delay of the slip and sinkage alarms, by threshold");
    add_choice(alarm, "--arithmetic", options->arithmetic, kArithmeticNames,
               "map_grid in the integers that fly, or its double-precision model");
    add_choice(alarm, "--terrain", options->terrain, kTerrainNames,
               "Random amplitudes, or those of the paper's own ground");
    add_run_options(alarm, *options, 10000);
    alarm.footer(
        "Examples:\n"
        "  rover85 sweep alarm --seeds 40\n"
        "  rover85 sweep alarm --terrain fractal --seeds 100 --json alarm.json");
    alarm.callback([options, &exit_code] {
        exit_code = host_sim::run_sweep_alarm(*options, host_sim::make_slip_estimator, std::cout,
                                              std::cerr, progress_bar());
    });
}

}  // namespace

void add_sweep_command(CLI::App& app, int& exit_code) {
    CLI::App& sweep =
        *app.add_subcommand("sweep", "Monte Carlo: how good the estimators are on random ground");
    sweep.require_subcommand(1);
    sweep.footer(
        "Example:\n  rover85 sweep slip --estimator map_grid --terrain fractal --seeds 40");
    add_slip(sweep, exit_code);
    add_table1(sweep, exit_code);
    add_alarm(sweep, exit_code);
}
