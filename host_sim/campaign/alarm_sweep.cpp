#include "host_sim/campaign/alarm_sweep.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>
#include <stdexcept>

#include "host_sim/reference/map_grid_double.hpp"

namespace host_sim {

namespace {

constexpr double kOnsetFromCm = 1000, kOnsetToCm = 2000;
constexpr double kRampCm = 20;
constexpr std::size_t kRoughnessCount = wilcox_table1::kRoughnessCount;

struct SlipCase {
    const char* name;
    double mean_cm, sigma_cm;
};
constexpr SlipCase kSlipCases[] = {{"advance falls from 5 to 1 cm", 1, 0.5},
                                   {"wheels spin in place", 0, 0}};
constexpr double kSinkageStepsCm[] = {2, 4, 6};
constexpr std::size_t kSlipCaseCount = std::size(kSlipCases);
constexpr std::size_t kCaseCount = kSlipCaseCount + std::size(kSinkageStepsCm);

/// Every run of one seed and roughness.
struct Traces {
    AlarmTrace normal;
    std::array<AlarmTrace, kCaseCount> onset;
};

PlanarGround giving_way(const PlanarGround& ground, double step_cm, double at_cm) {
    const Terrain& curve = ground.ground();
    std::vector<double> depth_cm(curve.sample_count());
    for (std::size_t i = 0; i < depth_cm.size(); ++i) {
        const double x_cm = curve.sample_x_cm(i);
        const double share = std::clamp((x_cm - at_cm) / kRampCm, 0.0, 1.0);
        depth_cm[i] = ground.sinkage_cm(x_cm) + step_cm * share;
    }
    const Terrain depth(curve.begin_cm(), curve.spacing_cm(), std::move(depth_cm));
    return {ground.ground(), SinkageField(depth)};
}

void record(AlarmTrace& trace, const SlipEstimator& estimator, const PlanarCourse& course) {
    const SlipLevels levels = estimator.slip_levels().value_or(SlipLevels{});
    // The running cost restarts when lock is lost; it was above the re-acquire threshold then.
    const double cost = levels.lost_lock ? MapGridTuning{}.reacquire_cost : levels.match_cost;
    const double values[] = {cost, levels.slip_percent, levels.slip_alarm ? 1.0 : 0.0,
                             estimator.sinkage_cm()};
    for (std::size_t i = 0; i < kAlarmLevelCount; ++i) trace.level[i].push_back(values[i]);
    trace.true_sinkage_cm.push_back(course.sinkage_cm());
}

/// Drives to the end, or until the onset has been watched long enough.
/// @param onset_cm  place of the rear wheel; nothing: no onset
AlarmTrace drive(const PlanarGround& ground, const CourseOptions& options, std::uint64_t seed,
                 std::optional<double> onset_cm, SlipEstimator& estimator) {
    AlarmTrace trace;
    PlanarCourse course(ground, options, seed);
    estimator.reset(ground);
    bool begun = false;
    while (!course.finished()) {
        if (onset_cm && !begun && course.position_cm() >= *onset_cm) {
            begun = true;
            trace.onset = trace.true_sinkage_cm.size();
        }
        (void)estimator.step(course.next());
        record(trace, estimator, course);
        if (begun && trace.true_sinkage_cm.size() >= trace.onset + kWatchedCycles) break;
    }
    if (!begun) trace.onset = trace.true_sinkage_cm.size();
    trace.travelled_cm = course.position_cm();
    return trace;
}

Traces drive_all(const PlanarGround& ground, std::uint64_t seed, SlipEstimator& estimator) {
    Traces traces;
    traces.normal = drive(ground, {}, seed, std::nullopt, estimator);
    const double at_cm = stream(seed, "onset").uniform(kOnsetFromCm, kOnsetToCm);
    for (std::size_t i = 0; i < kSlipCaseCount; ++i) {
        CourseOptions course;
        course.onset = SlipOnset{at_cm, kSlipCases[i].mean_cm, kSlipCases[i].sigma_cm};
        traces.onset[i] = drive(ground, course, seed, at_cm, estimator);
    }
    for (std::size_t i = 0; i < std::size(kSinkageStepsCm); ++i) {
        const PlanarGround soft = giving_way(ground, kSinkageStepsCm[i], at_cm);
        traces.onset[kSlipCaseCount + i] = drive(soft, {}, seed, at_cm - kFrontWheelCm, estimator);
    }
    return traces;
}

AlarmCurve empty_curve(AlarmLevel level) {
    AlarmCurve curve{.level = level, .thresholds = {}, .false_per_100_m = {}, .cases = {}};
    switch (level) {
        case AlarmLevel::match_cost:
            curve.thresholds = {1, 1.5, 2, 2.5, 3, 3.25, 3.5, 3.625, 3.75, 3.875};
            break;
        case AlarmLevel::slip_percent:
            curve.thresholds = {20, 22, 24, 26, 28, 30, 32, 35, 40, 50, 60, 70};
            break;
        case AlarmLevel::slip_alarm:
            curve.thresholds = {0.5};
            break;
        case AlarmLevel::sinkage_cm:
            curve.thresholds = {0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 5};
            break;
    }
    return curve;
}

using AllTraces = std::array<std::vector<Traces>, kRoughnessCount>;

AlarmCurve evaluate(AlarmLevel level, const AllTraces& traces) {
    AlarmCurve curve = empty_curve(level);
    const auto l = static_cast<std::size_t>(level);
    const bool sinkage = level == AlarmLevel::sinkage_cm;
    const std::size_t first = sinkage ? kSlipCaseCount : 0;
    const std::size_t last = sinkage ? kCaseCount : kSlipCaseCount;
    for (std::size_t i = first; i < last; ++i) {
        curve.cases.push_back(
            {sinkage ? fmt::format("sinkage grows by {} cm", kSinkageStepsCm[i - first])
                     : std::string(kSlipCases[i].name),
             {}});
    }
    for (const double threshold : curve.thresholds) {
        auto& alarms = curve.false_per_100_m.emplace_back();
        for (auto& one : curve.cases) one.rows.emplace_back();
        for (std::size_t r = 0; r < kRoughnessCount; ++r) {
            double count = 0;
            double travelled_cm = 0;
            std::vector<std::vector<Detection>> detections(curve.cases.size());
            for (const Traces& run : traces[r]) {
                const std::vector<double> none;
                count += static_cast<double>(count_false_alarms(
                    run.normal.level[l], sinkage ? run.normal.true_sinkage_cm : none, threshold));
                travelled_cm += run.normal.travelled_cm;
                for (std::size_t i = first; i < last; ++i) {
                    const AlarmTrace& trace = run.onset[i];
                    detections[i - first].push_back(detect(trace.level[l], trace.onset, threshold));
                }
            }
            alarms[r] = 1e4 * count / travelled_cm;
            for (std::size_t i = 0; i < curve.cases.size(); ++i) {
                curve.cases[i].rows.back()[r] = summarize_detections(detections[i]);
            }
        }
    }
    return curve;
}

std::string delay_text(const DetectionSummary& one) {
    const auto cycles = [](std::optional<std::size_t> value) {
        return value ? fmt::format("{}", *value) : std::string("-");
    };
    return fmt::format("{} {} {:.0f}%", cycles(one.median), cycles(one.percent90),
                       100 * one.missed_share);
}

void print_head(std::ostream& out, const std::string& title) {
    fmt::print(out, "\n{}\nthreshold", title);
    for (const double roughness : kSweepRoughness) fmt::print(out, " {:>12.4f}", roughness);
    fmt::print(out, "\n");
}

}  // namespace

std::string_view name_of(AlarmLevel level) {
    switch (level) {
        case AlarmLevel::match_cost:
            return "match_cost";
        case AlarmLevel::slip_percent:
            return "slip_percent";
        case AlarmLevel::slip_alarm:
            return "slip_alarm";
        case AlarmLevel::sinkage_cm:
            return "sinkage_cm";
    }
    return "unknown";
}

std::size_t count_false_alarms(const std::vector<double>& level, const std::vector<double>& truth,
                               double threshold) {
    std::size_t count = 0;
    bool up = false;
    std::size_t true_until = 0;  // first cycle that a true level no longer excuses
    for (std::size_t i = 0; i < level.size(); ++i) {
        if (!truth.empty() && truth[i] > threshold) true_until = i + kLagCycles;
        const bool now = level[i] > threshold;
        if (now && !up && i >= true_until) ++count;
        up = now;
    }
    return count;
}

Detection detect(const std::vector<double>& level, std::size_t onset, double threshold) {
    if (onset > 0 && onset <= level.size() && level[onset - 1] > threshold) {
        return {DetectionKind::up_before, 0};
    }
    for (std::size_t i = onset; i < level.size() && i < onset + kWatchedCycles; ++i) {
        if (level[i] > threshold) return {DetectionKind::detected, i - onset + 1};
    }
    return {DetectionKind::missed, 0};
}

DetectionSummary summarize_detections(std::vector<Detection> detections) {
    std::erase_if(detections,
                  [](const Detection& one) { return one.kind == DetectionKind::up_before; });
    DetectionSummary summary;
    summary.runs = detections.size();
    if (detections.empty()) return summary;
    std::vector<std::size_t> cycles;
    for (const Detection& one : detections) {
        if (one.kind == DetectionKind::detected) cycles.push_back(one.cycles);
    }
    std::sort(cycles.begin(), cycles.end());
    const auto count = static_cast<double>(detections.size());
    summary.missed_share = (count - static_cast<double>(cycles.size())) / count;
    // The smallest delay that at least this share of all runs, missed ones included, does not pass.
    const auto quantile = [&](double share) -> std::optional<std::size_t> {
        const auto rank = static_cast<std::size_t>(std::ceil(share * count));
        if (rank > cycles.size()) return std::nullopt;
        return cycles[rank - 1];
    };
    summary.median = quantile(0.5);
    summary.percent90 = quantile(0.9);
    return summary;
}

SweepAlarmResult sweep_alarm(const SweepAlarmOptions& options, const SlipEstimatorFactory& factory,
                             const Progress& progress) {
    if (options.seeds < 1 || options.seeds > 10000) {
        throw std::invalid_argument("seeds must lie in [1, 10000]");
    }
    AllTraces traces;
    for (auto& runs : traces) runs.resize(options.seeds);
    const auto one_seed = [&](std::size_t index) {
        const std::uint64_t seed = options.seed_base + index;
        const PlanarGround unit = make_planar_ground(options.terrain, seed, kCourseLengthCm);
        const std::unique_ptr<SlipEstimator> on_board =
            factory({.kind = EstimatorKind::map_grid,
                     .arithmetic = options.arithmetic,
                     .prior_sigma_cm = default_prior_sigma_cm(EstimatorKind::map_grid)});
        for (std::size_t r = 0; r < kRoughnessCount; ++r) {
            traces[r][index] = drive_all(unit.scaled(kSweepRoughness[r]), seed, *on_board);
        }
    };
    parallel_for(options.seeds, options.threads, one_seed, progress);
    SweepAlarmResult result;
    for (const AlarmLevel level : {AlarmLevel::match_cost, AlarmLevel::slip_percent,
                                   AlarmLevel::slip_alarm, AlarmLevel::sinkage_cm}) {
        result.curves.push_back(evaluate(level, traces));
    }
    return result;
}

std::string sweep_alarm_json(const SweepAlarmOptions& options, const SweepAlarmResult& result) {
    nlohmann::ordered_json document = {{"estimator", "map_grid"},
                                       {"arithmetic", name_of(options.arithmetic)},
                                       {"terrain", name_of(options.terrain)},
                                       {"seeds", options.seeds},
                                       {"seed_base", options.seed_base},
                                       {"false_alarms", nlohmann::ordered_json::array()},
                                       {"detections", nlohmann::ordered_json::array()}};
    const auto cycles = [](std::optional<std::size_t> value) {
        return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
    };
    for (const AlarmCurve& curve : result.curves) {
        for (std::size_t t = 0; t < curve.thresholds.size(); ++t) {
            for (std::size_t r = 0; r < kRoughnessCount; ++r) {
                document["false_alarms"].push_back({{"level", name_of(curve.level)},
                                                    {"threshold", curve.thresholds[t]},
                                                    {"roughness", kSweepRoughness[r]},
                                                    {"per_100_m", curve.false_per_100_m[t][r]}});
                for (const AlarmCurve::Case& one : curve.cases) {
                    const DetectionSummary& row = one.rows[t][r];
                    document["detections"].push_back({{"level", name_of(curve.level)},
                                                      {"case", one.name},
                                                      {"threshold", curve.thresholds[t]},
                                                      {"roughness", kSweepRoughness[r]},
                                                      {"runs", row.runs},
                                                      {"median_cycles", cycles(row.median)},
                                                      {"percent90_cycles", cycles(row.percent90)},
                                                      {"missed_share", row.missed_share}});
                }
            }
        }
    }
    return document.dump(2) + "\n";
}

void print_sweep_alarm(std::ostream& out, const SweepAlarmOptions& options,
                       const SweepAlarmResult& result) {
    const MapGridTuning tuning;
    fmt::print(out, "Alarms of map_grid ({}) on {}: {} runs, seeds {} to {}, by roughness\n",
               name_of(options.arithmetic), name_of(options.terrain), options.seeds,
               options.seed_base, options.seed_base + options.seeds - 1);
    fmt::print(out, "In flight: cost above {}, slip above {} %, sinkage above {} cm\n",
               tuning.slip_alarm_cost, tuning.slip_alarm_percent, tuning.sinkage_alarm_cm);
    for (const AlarmCurve& curve : result.curves) {
        print_head(out, fmt::format("{}: false alarms per 100 m", name_of(curve.level)));
        for (std::size_t t = 0; t < curve.thresholds.size(); ++t) {
            fmt::print(out, "{:<9}", curve.thresholds[t]);
            for (const double rate : curve.false_per_100_m[t]) fmt::print(out, " {:>12.2f}", rate);
            fmt::print(out, "\n");
        }
        for (const AlarmCurve::Case& one : curve.cases) {
            print_head(out, fmt::format("{}, {}: cycles until the alarm (median, 90 %), missed",
                                        name_of(curve.level), one.name));
            for (std::size_t t = 0; t < curve.thresholds.size(); ++t) {
                fmt::print(out, "{:<9}", curve.thresholds[t]);
                for (const DetectionSummary& row : one.rows[t]) {
                    fmt::print(out, " {:>12}", delay_text(row));
                }
                fmt::print(out, "\n");
            }
        }
    }
}

int run_sweep_alarm(const SweepAlarmOptions& options, const SlipEstimatorFactory& factory,
                    std::ostream& out, std::ostream& err, const Progress& progress) {
    try {
        const SweepAlarmResult result = sweep_alarm(options, factory, progress);
        if (options.json_path != "-") print_sweep_alarm(out, options, result);
        if (!options.json_path.empty()) {
            write_text(options.json_path, sweep_alarm_json(options, result), out);
        }
        return 0;
    } catch (const std::invalid_argument& error) {
        fmt::print(err, "rover85 sweep alarm: {}\n", error.what());
        return 2;
    }
}

}  // namespace host_sim
