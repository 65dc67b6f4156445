// table1_sweep.hpp - all 32 x 6 cells of the paper's Table 1, ours beside the print.
// Purpose      `rover85 sweep table1`: mean over seeds of map_paper with the paper's parameters,
// the
//              paper's single run and the difference; then the terrain statistics.
// Random       as slip_sweep.hpp: one ground per seed for all cells, independent of `threads`.
// Depends on   slip_sweep.hpp, wilcox_table1.hpp.
// Tests        tests/host_sim/campaign/table1_sweep_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "host_sim/campaign/slip_sweep.hpp"
#include "host_sim/campaign/wilcox_table1.hpp"

namespace host_sim {

struct SweepTable1Options {
    Arithmetic arithmetic = Arithmetic::fixed;
    TerrainKind terrain = TerrainKind::wilcox1994;
    std::uint32_t seeds = 20;
    std::uint64_t seed_base = 1;
    unsigned threads = 0;
    double length_cm = kCourseLengthCm;
    double bin_max_cm = 8.0;     ///< larger bins are left out
    std::string json_path = {};  ///< as in SweepSlipOptions
};

struct SweepTable1Result {
    /// Rows of the paper's table up to bin_max_cm, in its order.
    std::vector<std::array<Summary, wilcox_table1::kRoughnessCount>> rows;
    /// Entry i is bin 0.25 i cm; root mean square over the seeds; entry 0 is zero.
    std::array<TerrainStatistics, wilcox_table1::kBinCount> terrain{};
    double unit_terrain_rms_cm = 0;
};

/// How far ours lies from the print over the rows in [bin_min_cm, bin_max_cm].
struct Table1Deviation {
    double mean_abs_points = 0;
    double worst_abs_points = 0;
    double mean_signed_points = 0;
    std::size_t cells = 0;
};

/// @errors  std::invalid_argument when an option is out of range or the factory refuses
SweepTable1Result sweep_table1(const SweepTable1Options& options,
                               const SlipEstimatorFactory& factory, const Progress& progress = {});
Table1Deviation table1_deviation(const SweepTable1Result& result, double bin_min_cm,
                                 double bin_max_cm);

std::string sweep_table1_json(const SweepTable1Options& options, const SweepTable1Result& result);
void print_sweep_table1(std::ostream& out, const SweepTable1Options& options,
                        const SweepTable1Result& result);

/// Runs, prints and writes. @return exit code: 0, or 2 with one line on `err`
int run_sweep_table1(const SweepTable1Options& options, const SlipEstimatorFactory& factory,
                     std::ostream& out, std::ostream& err, const Progress& progress = {});

}  // namespace host_sim
