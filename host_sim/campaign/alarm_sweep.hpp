// alarm_sweep.hpp - what the slip and sinkage alarms are worth, over their thresholds.
// Purpose      `rover85 sweep alarm`: false alarms on a normal course, and how many cycles after
// the
//              onset of high slip or of sinkage the alarm is up.
// Model        the paper's planar course, advance N(5, 1) cm. Slip: from a random place between 10
//              and 20 m on the advance is N(1, 0.5) cm, or 0 (wheels spinning in place). Sinkage:
//              from such a place on the ground gives way by 2, 4 or 6 cm more, over 20 cm.
// Delay        in cycles from the onset under the rear wheel (slip) or under the front wheel
//              (sinkage); runs whose alarm is up already are left out, and an alarm that does not
//              come within kWatchedCycles is missed.
// False        alarms: the level rises above the threshold on a course without onset. For sinkage
//              only where the true sinkage stayed below it for the last kLagCycles cycles.
// Random       run i uses seed seed_base + i; the result does not depend on `threads`.
// Tests        tests/host_sim/campaign/alarm_sweep_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/campaign/parallel.hpp"
#include "host_sim/campaign/slip_sweep.hpp"

namespace host_sim {

struct SweepAlarmOptions {
    Arithmetic arithmetic = Arithmetic::fixed;
    TerrainKind terrain = TerrainKind::wilcox1994;
    std::uint32_t seeds = 40;
    std::uint64_t seed_base = 1;
    unsigned threads = 0;
    std::string json_path = {};  ///< as in SweepSlipOptions
};

/// What a threshold is compared with. `slip_alarm` is the alarm that flies (0 or 1): either slip
/// level above its default, or lock just lost.
enum class AlarmLevel { match_cost, slip_percent, slip_alarm, sinkage_cm };
inline constexpr std::size_t kAlarmLevelCount = 4;
std::string_view name_of(AlarmLevel level);

/// One level after every cycle of a run, and what it should have been.
struct AlarmTrace {
    std::array<std::vector<double>, kAlarmLevelCount> level;
    std::vector<double> true_sinkage_cm;
    double travelled_cm = 0;
    std::size_t onset = 0;  ///< first cycle after the onset; the number of cycles if there is none
};

inline constexpr std::size_t kWatchedCycles = 40;
inline constexpr std::size_t kLagCycles = 5;

/// Number of times that `level` rises above `threshold`; a true level above it within the last
/// kLagCycles cycles excuses it. An empty `truth` excuses nothing.
std::size_t count_false_alarms(const std::vector<double>& level, const std::vector<double>& truth,
                               double threshold);

/// Cycles from the onset until `level` is above `threshold`, at least 1.
enum class DetectionKind { detected, missed, up_before };
struct Detection {
    DetectionKind kind = DetectionKind::missed;
    std::size_t cycles = 0;
};
Detection detect(const std::vector<double>& level, std::size_t onset, double threshold);

/// Many runs at one roughness and threshold.
struct DetectionSummary {
    std::size_t runs = 0;               ///< without those whose alarm was up before
    std::optional<std::size_t> median;  ///< nothing: that many runs were missed
    std::optional<std::size_t> percent90;
    double missed_share = 0;
};
DetectionSummary summarize_detections(std::vector<Detection> detections);

struct AlarmCurve {
    AlarmLevel level;
    std::vector<double> thresholds;
    using PerRoughness = std::array<double, wilcox_table1::kRoughnessCount>;
    std::vector<PerRoughness> false_per_100_m;  ///< by threshold
    struct Case {
        std::string name;
        std::vector<std::array<DetectionSummary, wilcox_table1::kRoughnessCount>> rows;
    };
    std::vector<Case> cases;
};

struct SweepAlarmResult {
    std::vector<AlarmCurve> curves;
};

/// @errors  std::invalid_argument when an option is out of range
SweepAlarmResult sweep_alarm(const SweepAlarmOptions& options, const SlipEstimatorFactory& factory,
                             const Progress& progress = {});
std::string sweep_alarm_json(const SweepAlarmOptions& options, const SweepAlarmResult& result);
void print_sweep_alarm(std::ostream& out, const SweepAlarmOptions& options,
                       const SweepAlarmResult& result);

/// Runs, prints and writes. @return exit code: 0, or 2 with one line on `err`
int run_sweep_alarm(const SweepAlarmOptions& options, const SlipEstimatorFactory& factory,
                    std::ostream& out, std::ostream& err, const Progress& progress = {});

}  // namespace host_sim
