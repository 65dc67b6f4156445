#include "host_sim/campaign/slip_sweep.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

#include "host_sim/reference/map_grid_double.hpp"

namespace host_sim {

namespace {

void require(bool holds, const char* message) {
    if (!holds) throw std::invalid_argument(message);
}

constexpr double kDefaultBinCm = 2.5;

double bin_cm(const SweepSlipOptions& options) {
    return options.bin_cm.value_or(kDefaultBinCm);
}

/// map_grid flies with one prior sigma, whatever is asked for.
double prior_sigma_cm(const SweepSlipOptions& options) {
    const double own_cm = default_prior_sigma_cm(options.estimator);
    return options.estimator == EstimatorKind::map_grid ? own_cm
                                                        : options.prior_sigma_cm.value_or(own_cm);
}

void check(const SweepSlipOptions& options) {
    require(options.seeds >= 1 && options.seeds <= kSweepSeedsMax,
            "seeds must lie in [1, 1000000]");
    if (options.estimator == EstimatorKind::map_grid) {
        require(bin_cm(options) == kDefaultBinCm,
                "map_grid has its own bin of 2.5 cm; leave out --bin");
    }
    require(!options.bin_cm || (*options.bin_cm >= 0.25 && *options.bin_cm <= 8),
            "bin must lie in [0.25, 8] cm");
    require(options.prior_mean_cm > 0 && options.prior_mean_cm <= 50,
            "prior mean must lie in (0, 50] cm");
    require(!options.prior_sigma_cm ||
                (*options.prior_sigma_cm >= 0.01 && *options.prior_sigma_cm <= 20),
            "prior sigma must lie in [0.01, 20] cm");
    require(options.true_mean_cm >= 0.1 && options.true_mean_cm <= 50,
            "true mean must lie in [0.1, 50] cm");
    require(options.length_cm >= 100 && options.length_cm <= 1e6,
            "course must be 1 m to 10 km long");
}

PlanarGround unit_ground(const SweepSlipOptions& options, std::uint64_t seed) {
    const PlanarGround finest = make_planar_ground(options.terrain, seed, options.length_cm);
    if (options.estimator == EstimatorKind::map_grid) return finest;
    return finest.resampled(bin_cm(options));
}

SlipEstimatorOptions estimator_options(const SweepSlipOptions& options) {
    return {.kind = options.estimator,
            .arithmetic = options.arithmetic,
            .bin_cm = bin_cm(options),
            .prior_mean_cm = options.prior_mean_cm,
            .prior_sigma_cm = prior_sigma_cm(options)};
}

}  // namespace

double default_prior_sigma_cm(EstimatorKind kind) {
    return kind == EstimatorKind::map_paper ? wilcox_table1::kPriorSigmaCm
                                            : MapGridTuning{}.prior_sigma_cm;
}

std::string_view name_of(TerrainKind kind) {
    return kind == TerrainKind::fractal ? "fractal" : "wilcox1994";
}

SweepSlipResult sweep_slip(const SweepSlipOptions& options, const SlipEstimatorFactory& factory,
                           const Progress& progress) {
    check(options);
    const SlipEstimatorOptions estimator = estimator_options(options);
    const CourseOptions course{.scenario = options.scenario,
                               .true_mean_cm = options.true_mean_cm,
                               .length_cm = options.length_cm,
                               .lock_bin_cm = bin_cm(options)};
    SweepSlipResult result;
    for (auto& runs : result.runs) runs.resize(options.seeds);
    const auto one_seed = [&](std::size_t index) {
        const std::uint64_t seed = options.seed_base + index;
        const PlanarGround unit = unit_ground(options, seed);
        const std::unique_ptr<SlipEstimator> on_board = factory(estimator);
        for (std::size_t i = 0; i < kSweepRoughness.size(); ++i) {
            const PlanarGround ground = unit.scaled(kSweepRoughness[i]);
            result.runs[i][index] = run_course(ground, course, seed, *on_board);
        }
    };
    parallel_for(options.seeds, options.threads, one_seed, progress);
    for (std::size_t i = 0; i < kSweepRoughness.size(); ++i) {
        result.rows[i] = summarize(result.runs[i]);
    }
    return result;
}

std::string sweep_slip_json(const SweepSlipOptions& options, const SweepSlipResult& result) {
    nlohmann::ordered_json document = {
        {"estimator", name_of(options.estimator)},
        {"arithmetic", name_of(options.arithmetic)},
        {"terrain", name_of(options.terrain)},
        {"scenario", name_of(options.scenario)},
        {"bin_cm", bin_cm(options)},
        {"prior_mean_cm", options.prior_mean_cm},
        {"prior_sigma_cm", estimator_options(options).prior_sigma_cm},
        {"true_mean_cm", options.true_mean_cm},
        {"seeds", options.seeds},
        {"seed_base", options.seed_base},
        {"rows", nlohmann::ordered_json::array()}};
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const Summary& row = result.rows[i];
        nlohmann::ordered_json entry = {{"roughness", kSweepRoughness[i]},
                                        {"odometry_error_pct",
                                         {{"mean", row.mean_pct},
                                          {"mean_abs", row.mean_abs_pct},
                                          {"sd", row.sd_pct},
                                          {"worst_abs", row.worst_abs_pct}}},
                                        {"sinkage_rms_cm", row.sinkage_rms_cm},
                                        {"lost_lock_runs", row.lost_lock_runs},
                                        {"sinkage_zero_rms_cm", row.sinkage_zero_rms_cm}};
        if (row.sigma_coverage) entry["sigma_coverage"] = *row.sigma_coverage;
        document["rows"].push_back(entry);
    }
    return document.dump(2) + "\n";
}

void print_sweep_slip(std::ostream& out, const SweepSlipOptions& options,
                      const SweepSlipResult& result) {
    fmt::print(out, "{} ({}) on {}, scenario {}: bin {} cm, prior {} +- {} cm, true mean {} cm\n",
               name_of(options.estimator), name_of(options.arithmetic), name_of(options.terrain),
               name_of(options.scenario), bin_cm(options), options.prior_mean_cm,
               estimator_options(options).prior_sigma_cm, options.true_mean_cm);
    fmt::print(out, "{} runs of {} m a row, seeds {} to {}\n\n", options.seeds,
               options.length_cm / 100, options.seed_base, options.seed_base + options.seeds - 1);
    fmt::print(out,
               "           odometry error, %                  sinkage RMS, cm    lost  within\n");
    fmt::print(out,
               "roughness     mean  mean abs      sd   worst   error   zero is   lock  1 sigma\n");
    for (std::size_t i = 0; i < result.rows.size(); ++i) {
        const Summary& row = result.rows[i];
        const std::string covered =
            row.sigma_coverage ? fmt::format("{:.0f} %", 100 * *row.sigma_coverage) : "-";
        fmt::print(
            out, "{:<9.4f} {:>8.2f} {:>9.2f} {:>7.2f} {:>7.2f} {:>7.3f} {:>9.3f} {:>6} {:>8}\n",
            kSweepRoughness[i], row.mean_pct, row.mean_abs_pct, row.sd_pct, row.worst_abs_pct,
            row.sinkage_rms_cm, row.sinkage_zero_rms_cm, row.lost_lock_runs, covered);
    }
}

void write_text(const std::string& path, const std::string& text, std::ostream& out) {
    if (path == "-") {
        out << text;
        return;
    }
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) {
        throw std::invalid_argument(
            fmt::format("cannot write {}: {}; give another path", path, std::strerror(errno)));
    }
}

int run_sweep_slip(const SweepSlipOptions& options, const SlipEstimatorFactory& factory,
                   std::ostream& out, std::ostream& err, const Progress& progress) {
    try {
        if (options.prior_sigma_cm && *options.prior_sigma_cm != prior_sigma_cm(options)) {
            fmt::print(err,
                       "rover85 sweep slip: map_grid has its own prior sigma of {} cm; "
                       "--prior-sigma is ignored\n",
                       prior_sigma_cm(options));
        }
        const SweepSlipResult result = sweep_slip(options, factory, progress);
        if (options.json_path != "-") print_sweep_slip(out, options, result);
        if (!options.json_path.empty()) {
            write_text(options.json_path, sweep_slip_json(options, result), out);
        }
        return 0;
    } catch (const std::invalid_argument& error) {
        fmt::print(err, "rover85 sweep slip: {}\n", error.what());
        return 2;
    }
}

}  // namespace host_sim
