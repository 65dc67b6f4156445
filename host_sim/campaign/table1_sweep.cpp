#include "host_sim/campaign/table1_sweep.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

namespace host_sim {

namespace {

namespace paper = wilcox_table1;

using RowRuns = std::array<std::vector<RunResult>, paper::kRoughnessCount>;

std::size_t row_count(const SweepTable1Options& options) {
    const auto printed = [&](const paper::Row& row) { return row.bin_cm <= options.bin_max_cm; };
    return static_cast<std::size_t>(
        std::count_if(paper::kRows.begin(), paper::kRows.end(), printed));
}

void check(const SweepTable1Options& options) {
    if (options.seeds < 1 || options.seeds > kSweepSeedsMax) {
        throw std::invalid_argument("seeds must lie in [1, 1000000]");
    }
    if (!(options.length_cm >= 100 && options.length_cm <= 1e6)) {
        throw std::invalid_argument("course must be 1 m to 10 km long");
    }
    if (!(options.bin_max_cm >= 0.25)) throw std::invalid_argument("no bin is that small");
}

/// One seed's terrain statistics, squared, so that they can be averaged over seeds.
struct TerrainSquares {
    std::array<TerrainStatistics, paper::kBinCount> bins{};
    double height_cm2 = 0;
};

TerrainSquares terrain_squares(const Terrain& terrain, double length_cm) {
    TerrainSquares squares;
    for (std::size_t i = 1; i < paper::kBinCount; ++i) {
        const double bin_cm = 0.25 * static_cast<double>(i);
        const TerrainStatistics one = terrain_statistics(terrain, bin_cm, 0.0, length_cm);
        squares.bins[i] = {one.rms_step_cm * one.rms_step_cm,
                           one.rms_projection_cm * one.rms_projection_cm};
    }
    const double rms_cm = rms_height_cm(terrain, 0.0, length_cm);
    squares.height_cm2 = rms_cm * rms_cm;
    return squares;
}

void average_terrain(const std::vector<TerrainSquares>& squares, SweepTable1Result& result) {
    const auto count = static_cast<double>(squares.size());
    double height_cm2 = 0;
    for (const TerrainSquares& one : squares) {
        height_cm2 += one.height_cm2 / count;
        for (std::size_t i = 1; i < paper::kBinCount; ++i) {
            result.terrain[i].rms_step_cm += one.bins[i].rms_step_cm / count;
            result.terrain[i].rms_projection_cm += one.bins[i].rms_projection_cm / count;
        }
    }
    for (TerrainStatistics& bin : result.terrain) {
        bin = {std::sqrt(bin.rms_step_cm), std::sqrt(bin.rms_projection_cm)};
    }
    result.unit_terrain_rms_cm = std::sqrt(height_cm2);
}

/// All cells of one seed, on one ground.
void run_seed(const SweepTable1Options& options, const SlipEstimatorFactory& factory,
              std::size_t index, std::vector<RowRuns>& runs, TerrainSquares& squares) {
    const std::uint64_t seed = options.seed_base + index;
    const PlanarGround finest = make_planar_ground(options.terrain, seed, options.length_cm);
    squares = terrain_squares(finest.ground(), options.length_cm);
    for (std::size_t row = 0; row < runs.size(); ++row) {
        const double bin_cm = paper::kRows[row].bin_cm;
        const CourseOptions course{.true_mean_cm = paper::kTrueMeanCm,
                                   .length_cm = options.length_cm,
                                   .lock_bin_cm = bin_cm};
        const PlanarGround unit = finest.resampled(bin_cm);
        const std::unique_ptr<SlipEstimator> on_board =
            factory({.kind = EstimatorKind::map_paper,
                     .arithmetic = options.arithmetic,
                     .bin_cm = bin_cm,
                     .prior_mean_cm = paper::kPriorMeanCm,
                     .prior_sigma_cm = paper::kPriorSigmaCm});
        for (std::size_t i = 0; i < paper::kRoughnessCount; ++i) {
            const PlanarGround ground = unit.scaled(paper::kRoughness[i]);
            runs[row][i][index] = run_course(ground, course, seed, *on_board);
        }
    }
}

void print_cells(std::ostream& out, const SweepTable1Result& result) {
    fmt::print(out, "Odometry error, %: ours, paper, ours - paper\n  bin");
    for (const double roughness : paper::kRoughness) fmt::print(out, " |{:^21.4f}", roughness);
    for (std::size_t row = 0; row < result.rows.size(); ++row) {
        fmt::print(out, "\n{:5.2f}", paper::kRows[row].bin_cm);
        for (std::size_t i = 0; i < paper::kRoughnessCount; ++i) {
            const double ours = result.rows[row][i].mean_pct;
            const double printed = paper::kRows[row].cells[i].odometry_error_pct;
            fmt::print(out, " |{:6.2f} {:6.2f} {:+7.2f}", ours, printed, ours - printed);
        }
    }
    fmt::print(out, "\n\nSinkage RMS, cm: ours, paper (given to 0.1); seeds that lost lock\n  bin");
    for (const double roughness : paper::kRoughness) fmt::print(out, " |{:^14.4f}", roughness);
    for (std::size_t row = 0; row < result.rows.size(); ++row) {
        fmt::print(out, "\n{:5.2f}", paper::kRows[row].bin_cm);
        for (std::size_t i = 0; i < paper::kRoughnessCount; ++i) {
            fmt::print(out, " |{:5.2f} {:4.1f} {:3}", result.rows[row][i].sinkage_rms_cm,
                       paper::kRows[row].cells[i].sinkage_rms_cm,
                       result.rows[row][i].lost_lock_runs);
        }
    }
    fmt::print(out, "\n\n");
}

void print_terrain(std::ostream& out, const SweepTable1Result& result) {
    fmt::print(out, "Ground at unit roughness: RMS height {:.1f} cm, paper {:.1f} cm\n",
               result.unit_terrain_rms_cm, paper::kUnitTerrainRmsCm);
    fmt::print(out, "  bin | RMS bin-to-bin step, cm | RMS projection error, cm\n");
    fmt::print(out, "      |   ours  paper     diff  |   ours  paper     diff\n");
    for (std::size_t i = 1; i < paper::kBinCount; ++i) {
        const TerrainStatistics& ours = result.terrain[i];
        const paper::TerrainCell& printed = paper::kTerrain[i];
        const double step_pct = 100 * (ours.rms_step_cm / printed.rms_step_cm - 1);
        const double projection_pct =
            100 * (ours.rms_projection_cm / printed.rms_projection_cm - 1);
        fmt::print(out, "{:5.2f} | {:6.2f} {:6.2f} {:+7.2f} % | {:6.2f} {:6.2f} {:+7.2f} %\n",
                   0.25 * static_cast<double>(i), ours.rms_step_cm, printed.rms_step_cm, step_pct,
                   ours.rms_projection_cm, printed.rms_projection_cm, projection_pct);
    }
}

struct Band {
    const char* name;
    double from_cm, to_cm;
};
constexpr Band kBands[] = {
    {"bin 2.5 cm", 2.5, 2.5}, {"bins <= 4 cm", 0.25, 4.0}, {"bins > 4 cm", 4.25, 8.0}};

}  // namespace

SweepTable1Result sweep_table1(const SweepTable1Options& options,
                               const SlipEstimatorFactory& factory, const Progress& progress) {
    check(options);
    std::vector<RowRuns> runs(row_count(options));
    for (RowRuns& row : runs) {
        for (auto& cell : row) cell.resize(options.seeds);
    }
    std::vector<TerrainSquares> squares(options.seeds);
    parallel_for(
        options.seeds, options.threads,
        [&](std::size_t index) { run_seed(options, factory, index, runs, squares[index]); },
        progress);
    SweepTable1Result result;
    result.rows.resize(runs.size());
    for (std::size_t row = 0; row < runs.size(); ++row) {
        for (std::size_t i = 0; i < paper::kRoughnessCount; ++i) {
            result.rows[row][i] = summarize(runs[row][i]);
        }
    }
    average_terrain(squares, result);
    return result;
}

Table1Deviation table1_deviation(const SweepTable1Result& result, double bin_min_cm,
                                 double bin_max_cm) {
    Table1Deviation deviation;
    for (std::size_t row = 0; row < result.rows.size(); ++row) {
        const double bin_cm = paper::kRows[row].bin_cm;
        if (bin_cm < bin_min_cm || bin_cm > bin_max_cm) continue;
        for (std::size_t i = 0; i < paper::kRoughnessCount; ++i) {
            const double off =
                result.rows[row][i].mean_pct - paper::kRows[row].cells[i].odometry_error_pct;
            deviation.mean_signed_points += off;
            deviation.mean_abs_points += std::abs(off);
            deviation.worst_abs_points = std::max(deviation.worst_abs_points, std::abs(off));
            ++deviation.cells;
        }
    }
    if (deviation.cells == 0) return deviation;
    deviation.mean_signed_points /= static_cast<double>(deviation.cells);
    deviation.mean_abs_points /= static_cast<double>(deviation.cells);
    return deviation;
}

std::string sweep_table1_json(const SweepTable1Options& options, const SweepTable1Result& result) {
    nlohmann::ordered_json document = {{"estimator", "map_paper"},
                                       {"arithmetic", name_of(options.arithmetic)},
                                       {"terrain", name_of(options.terrain)},
                                       {"seeds", options.seeds},
                                       {"seed_base", options.seed_base},
                                       {"unit_terrain_rms_cm", result.unit_terrain_rms_cm}};
    for (std::size_t row = 0; row < result.rows.size(); ++row) {
        for (std::size_t i = 0; i < paper::kRoughnessCount; ++i) {
            const paper::Cell& printed = paper::kRows[row].cells[i];
            const Summary& ours = result.rows[row][i];
            document["cells"].push_back({{"bin_cm", paper::kRows[row].bin_cm},
                                         {"roughness", paper::kRoughness[i]},
                                         {"odometry_error_pct", ours.mean_pct},
                                         {"paper_odometry_error_pct", printed.odometry_error_pct},
                                         {"sinkage_rms_cm", ours.sinkage_rms_cm},
                                         {"paper_sinkage_rms_cm", printed.sinkage_rms_cm},
                                         {"lost_lock_runs", ours.lost_lock_runs}});
        }
    }
    for (std::size_t i = 1; i < paper::kBinCount; ++i) {
        document["terrain_statistics"].push_back(
            {{"bin_cm", 0.25 * static_cast<double>(i)},
             {"rms_step_cm", result.terrain[i].rms_step_cm},
             {"paper_rms_step_cm", paper::kTerrain[i].rms_step_cm},
             {"rms_projection_cm", result.terrain[i].rms_projection_cm},
             {"paper_rms_projection_cm", paper::kTerrain[i].rms_projection_cm}});
    }
    return document.dump(2) + "\n";
}

void print_sweep_table1(std::ostream& out, const SweepTable1Options& options,
                        const SweepTable1Result& result) {
    fmt::print(out, "map_paper ({}) on {}: true advance {} +- {} cm, prior {} +- {} cm\n",
               name_of(options.arithmetic), name_of(options.terrain), paper::kTrueMeanCm,
               paper::kTrueSigmaCm, paper::kPriorMeanCm, paper::kPriorSigmaCm);
    fmt::print(out, "mean of {} runs of {} m a cell, seeds {} to {}; the paper printed one run\n\n",
               options.seeds, options.length_cm / 100, options.seed_base,
               options.seed_base + options.seeds - 1);
    print_cells(out, result);
    fmt::print(out, "Difference from the paper, points of odometry error: mean abs, mean, worst\n");
    for (const Band& band : kBands) {
        const Table1Deviation off = table1_deviation(result, band.from_cm, band.to_cm);
        if (off.cells == 0) continue;
        fmt::print(out, "{:<13} {:6.2f} {:+6.2f} {:6.2f}  ({} cells)\n", band.name,
                   off.mean_abs_points, off.mean_signed_points, off.worst_abs_points, off.cells);
    }
    fmt::print(out, "\n");
    print_terrain(out, result);
}

int run_sweep_table1(const SweepTable1Options& options, const SlipEstimatorFactory& factory,
                     std::ostream& out, std::ostream& err, const Progress& progress) {
    try {
        const SweepTable1Result result = sweep_table1(options, factory, progress);
        if (options.json_path != "-") print_sweep_table1(out, options, result);
        if (!options.json_path.empty()) {
            write_text(options.json_path, sweep_table1_json(options, result), out);
        }
        return 0;
    } catch (const std::invalid_argument& error) {
        fmt::print(err, "rover85 sweep table1: {}\n", error.what());
        return 2;
    }
}

}  // namespace host_sim
