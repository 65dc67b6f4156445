// slip_sweep.hpp - Monte Carlo of one estimator over the paper's six roughness values.
// Purpose      `rover85 sweep slip`: a table on the terminal, JSON for machines.
// Random       run i uses seed seed_base + i; its ground, advance and noise are the same at every
//              roughness and for every estimator. The result does not depend on `threads`.
// Depends on   planar_course.hpp, parallel.hpp; nlohmann-json for the output.
// Tests        tests/host_sim/campaign/slip_sweep_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/campaign/parallel.hpp"
#include "host_sim/campaign/planar_course.hpp"
#include "host_sim/campaign/wilcox_table1.hpp"

namespace host_sim {

inline constexpr auto& kSweepRoughness = wilcox_table1::kRoughness;
inline constexpr std::uint32_t kSweepSeedsMax = 1'000'000;

struct SweepSlipOptions {
    EstimatorKind estimator = EstimatorKind::map_grid;
    Arithmetic arithmetic = Arithmetic::fixed;
    TerrainKind terrain = TerrainKind::wilcox1994;
    Scenario scenario = Scenario::gaussian;
    /// Of map_paper, and spacing of its ground's samples; nothing: 2.5. map_grid has its own bin
    /// and prior sigma: another bin is refused, another sigma ignored with a note. It drives the
    /// ground as it was made, every 0.25 cm.
    std::optional<double> bin_cm = std::nullopt;
    double prior_mean_cm = 6.0;  ///< map_grid: the learned mean at the start
    std::optional<double> prior_sigma_cm = std::nullopt;  ///< nothing: default_prior_sigma_cm()
    double true_mean_cm = 5.0;
    std::uint32_t seeds = 40;  ///< runs per roughness, [1, kSweepSeedsMax]
    std::uint64_t seed_base = 1;
    unsigned threads = 0;  ///< 0: one per core
    double length_cm = kCourseLengthCm;
    std::string json_path = {};  ///< empty: none; "-": standard output instead of the table
};

/// What the estimator is told unless the user says otherwise: 0.05 cm for map_paper, as in the
/// paper's Table 1; what the vehicle flies for map_grid.
double default_prior_sigma_cm(EstimatorKind kind);

std::string_view name_of(TerrainKind kind);

struct SweepSlipResult {
    std::array<Summary, wilcox_table1::kRoughnessCount> rows;
    /// Every run, by roughness and seed.
    std::array<std::vector<RunResult>, wilcox_table1::kRoughnessCount> runs;
};

/// @errors  std::invalid_argument when an option is out of range or the factory refuses
SweepSlipResult sweep_slip(const SweepSlipOptions& options, const SlipEstimatorFactory& factory,
                           const Progress& progress = {});

/// The options and one row per roughness, with a final line feed.
std::string sweep_slip_json(const SweepSlipOptions& options, const SweepSlipResult& result);
void print_sweep_slip(std::ostream& out, const SweepSlipOptions& options,
                      const SweepSlipResult& result);

/// Runs, prints and writes. @return exit code: 0, or 2 with one line on `err`
int run_sweep_slip(const SweepSlipOptions& options, const SlipEstimatorFactory& factory,
                   std::ostream& out, std::ostream& err, const Progress& progress = {});

/// Writes text to a file, or to `out` if the path is "-".
/// @errors  std::invalid_argument with path and reason
void write_text(const std::string& path, const std::string& text, std::ostream& out);

}  // namespace host_sim
