#include "tools/report/summary.hpp"

#include <algorithm>
#include <cmath>

#include "tools/report/columns.hpp"
#include "tools/report/names.hpp"

namespace report {
namespace {

using host_sim::Log;
using host_sim::LogStep;

constexpr double kDistanceMinM = 0.1;

/// Mean and greatest value of what is added.
class Mean {
public:
    void add(double value) {
        sum_ += value;
        greatest_ = count_ == 0 ? value : std::max(greatest_, value);
        ++count_;
    }
    Figure mean() const { return count_ == 0 ? Figure{} : sum_ / static_cast<double>(count_); }
    Figure greatest() const { return count_ == 0 ? Figure{} : greatest_; }

private:
    double sum_ = 0;
    double greatest_ = 0;
    std::size_t count_ = 0;
};

bool knows_position(const LogStep& step) {
    return step.truth && std::isfinite(step.truth->position_mm);
}

bool available(const LogStep& step, rover::Available bit) {
    return step.estimates && (step.estimates->available & bit) != 0;
}

/// The `name = "..."` line of a vehicle description: the only thing the report needs to know of it.
std::string vehicle_name(const std::string& toml) {
    for (std::size_t at = toml.find("name"); at != std::string::npos;
         at = toml.find("name", at + 1)) {
        if (at != 0 && toml[at - 1] != '\n') continue;
        const std::size_t equals = toml.find_first_not_of(" \t", at + 4);
        if (equals == std::string::npos || toml[equals] != '=') continue;
        const std::size_t open = toml.find_first_not_of(" \t", equals + 1);
        if (open == std::string::npos || toml[open] != '"') continue;
        const std::size_t close = toml.find('"', open + 1);
        if (close != std::string::npos) return toml.substr(open + 1, close - open - 1);
    }
    return {};
}

void set_distances(const Log& log, Summary& summary) {
    const LogStep* first_true = nullptr;
    const LogStep* last_true = nullptr;
    const LogStep* first = nullptr;
    const LogStep* last = nullptr;
    for (const LogStep& step : log.steps) {
        if (knows_position(step)) {
            if (first_true == nullptr) first_true = &step;
            last_true = &step;
        }
        if (step.estimates) {
            if (first == nullptr) first = &step;
            last = &step;
        }
    }
    summary.has_truth = first_true != last_true;
    summary.has_estimates = first != nullptr;
    if (summary.has_truth) {
        summary.true_distance_m =
            (last_true->truth->position_mm - first_true->truth->position_mm) / 1000.0;
    }
    if (first != last) {
        summary.firmware_distance_m = (mm_of_q4(last->estimates->position_q4_mm) -
                                       mm_of_q4(first->estimates->position_q4_mm)) /
                                      1000.0;
        summary.wheel_distance_m = (mm_of_q4(last->estimates->odometer_q4_mm) -
                                    mm_of_q4(first->estimates->odometer_q4_mm)) /
                                   1000.0;
        if (available(*last, rover::kAvailableSlip)) {
            summary.position_sigma_m = mm_of_q4(last->estimates->position_sigma_q4_mm) / 1000.0;
        }
    } else {
        const double travel_mm = wheel_travel_mm(log).back();
        if (std::isfinite(travel_mm)) summary.wheel_distance_m = travel_mm / 1000.0;
    }
    const bool turned = summary.wheel_distance_m && *summary.wheel_distance_m >= kDistanceMinM;
    if (turned && summary.true_distance_m) {
        summary.slip_overall_percent =
            100.0 * (1.0 - *summary.true_distance_m / *summary.wheel_distance_m);
    }
}

/// Errors against the truth, from the first step that has estimates and truth to the last.
void set_errors(const Log& log, Summary& summary) {
    const LogStep* first = nullptr;
    const LogStep* last = nullptr;
    std::size_t inside = 0;
    std::size_t compared = 0;
    for (const LogStep& step : log.steps) {
        if (!step.estimates || !knows_position(step)) continue;
        if (first == nullptr) first = &step;
        last = &step;
        if (!available(step, rover::kAvailableSlip)) continue;
        const double error_mm = mm_of_q4(step.estimates->position_q4_mm) -
                                mm_of_q4(first->estimates->position_q4_mm) -
                                (step.truth->position_mm - first->truth->position_mm);
        ++compared;
        if (std::abs(error_mm) <= mm_of_q4(step.estimates->position_sigma_q4_mm)) ++inside;
    }
    if (compared != 0) {
        summary.within_sigma_share = static_cast<double>(inside) / static_cast<double>(compared);
    }
    if (first == last) return;
    const double true_m = (last->truth->position_mm - first->truth->position_mm) / 1000.0;
    const auto travel_m = [&](std::int32_t rover::Estimates::* field) {
        return (mm_of_q4((*last->estimates).*field) - mm_of_q4((*first->estimates).*field)) /
               1000.0;
    };
    summary.firmware_error_m = travel_m(&rover::Estimates::position_q4_mm) - true_m;
    summary.wheel_error_m = travel_m(&rover::Estimates::odometer_q4_mm) - true_m;
    if (true_m >= kDistanceMinM) {
        summary.firmware_error_percent = 100.0 * *summary.firmware_error_m / true_m;
        summary.wheel_error_percent = 100.0 * *summary.wheel_error_m / true_m;
    }
}

struct QuantitySums {
    Mean estimated, truth, squared_error;

    void add(double estimate, double true_value) {
        if (std::isfinite(estimate)) estimated.add(estimate);
        if (std::isfinite(true_value)) truth.add(true_value);
        const double error = estimate - true_value;
        if (std::isfinite(error)) squared_error.add(error * error);
    }
    QuantityFigures figures() const {
        Figure rms = squared_error.mean();
        if (rms) rms = std::sqrt(*rms);
        return {estimated.mean(), estimated.greatest(), truth.mean(), truth.greatest(), rms};
    }
};

void set_quantities(const Log& log, Summary& summary) {
    QuantitySums sinkage_mm, slip_percent;
    for (const LogStep& step : log.steps) {
        const bool has_sinkage = available(step, rover::kAvailableSinkage);
        const bool has_slip = available(step, rover::kAvailableSlip);
        sinkage_mm.add(has_sinkage ? mm_of_q4(step.estimates->sinkage_q4_mm) : kNotKnown,
                       step.truth ? step.truth->sinkage_mm : kNotKnown);
        slip_percent.add(has_slip ? step.estimates->slip_percent : kNotKnown,
                         step.truth ? 100.0 * step.truth->slip : kNotKnown);
    }
    summary.sinkage_mm = sinkage_mm.figures();
    summary.slip_percent = slip_percent.figures();
}

AlarmFigures alarm(const Log& log, const Track& track, rover::Event bit) {
    AlarmFigures figures;
    bool was_up = false;
    std::size_t raised = 0;
    std::size_t steps = 0;
    for (std::size_t row = 0; row < log.steps.size(); ++row) {
        const LogStep& step = log.steps[row];
        if (!step.estimates) continue;
        const bool up = (step.estimates->events & bit) != 0;
        ++steps;
        if (up) ++raised;
        if (up && !was_up && ++figures.count == 1) {
            figures.first_time_s = track.time_s[row];
            if (track.source != PlaceSource::none) figures.first_place_m = track.place_m[row];
        }
        was_up = up;
    }
    if (steps != 0) figures.raised_share = static_cast<double>(raised) / static_cast<double>(steps);
    return figures;
}

/// Counts what Estimates say step by step; shares are of the steps with estimates.
void set_events(const Log& log, Summary& summary) {
    std::size_t steps = 0;
    std::array<std::size_t, kEstimateNames.size()> available_steps{};
    std::array<std::size_t, kFaultNames.size()> fault_steps{};
    std::array<std::size_t, kModeCount> mode_steps{};
    const rover::Estimates* before = nullptr;
    for (const LogStep& step : log.steps) {
        if (!step.estimates) continue;
        const rover::Estimates& now = *step.estimates;
        ++steps;
        if (before != nullptr) {  // modulo 2^16
            summary.cycle_count +=
                static_cast<std::uint16_t>(now.cycle_count - before->cycle_count);
        }
        before = &now;
        if ((now.events & rover::kEventLostLock) != 0) ++summary.lost_lock_count;
        if ((now.events & rover::kEventTickGap) != 0) ++summary.tick_gap_count;
        if ((now.events & rover::kEventOverspeed) != 0) ++summary.overspeed_count;
        for (std::size_t index = 0; index < available_steps.size(); ++index) {
            if ((now.available & kEstimateNames[index].bit) != 0) ++available_steps[index];
        }
        for (std::size_t index = 0; index < fault_steps.size(); ++index) {
            if ((now.faults & kFaultNames[index].bit) != 0) ++fault_steps[index];
        }
        const auto mode = static_cast<std::size_t>(now.mode);
        if (mode < kModeCount) ++mode_steps[mode];
    }
    if (steps == 0) return;
    const auto share = [&](std::size_t count) {
        return static_cast<double>(count) / static_cast<double>(steps);
    };
    for (std::size_t mode = 0; mode < kModeCount; ++mode) {
        summary.mode_share[kModeKeys[mode]] = share(mode_steps[mode]);
    }
    for (std::size_t index = 0; index < fault_steps.size(); ++index) {
        if (fault_steps[index] != 0)
            summary.fault_steps[kFaultNames[index].key] = fault_steps[index];
    }
    for (std::size_t index = 0; index < available_steps.size(); ++index) {
        const EstimateName& name = kEstimateNames[index];
        summary.available_share[name.key] = share(available_steps[index]);
        if (available_steps[index] == 0) summary.not_available.emplace_back(name.text);
    }
}

void set_sensors(const Log& log, Summary& summary) {
    const std::vector<Sensor>& all = sensors();
    std::vector<std::size_t> present_steps(all.size(), 0);
    for (const LogStep& step : log.steps) {
        for (std::size_t index = 0; index < all.size(); ++index) {
            if (all[index].present(step.inputs, all[index].index)) ++present_steps[index];
        }
    }
    for (std::size_t index = 0; index < all.size(); ++index) {
        const std::size_t count = present_steps[index];
        summary.sensor_present_share[all[index].key] =
            static_cast<double>(count) / static_cast<double>(log.steps.size());
        if (count == 0) {
            summary.sensors_missing.push_back(all[index].text);
        } else if (count < log.steps.size()) {
            summary.sensors_intermittent.push_back(all[index].text);
        }
    }
}

}  // namespace

Summary summarize(const Log& log) {
    Summary summary;
    summary.step_count = log.steps.size();
    summary.vehicle = vehicle_name(log.head.vehicle);
    summary.image_identity = log.head.image_identity;
    summary.notes = log.head.notes;
    if (log.steps.empty()) return summary;
    summary.duration_s = (log.steps.back().time_ms - log.steps.front().time_ms) / 1000.0;
    const Track track = track_of(log);
    set_distances(log, summary);
    set_errors(log, summary);
    set_quantities(log, summary);
    summary.slip_alarm = alarm(log, track, rover::kEventSlipAlarm);
    summary.sinkage_alarm = alarm(log, track, rover::kEventSinkageAlarm);
    set_events(log, summary);
    set_sensors(log, summary);
    return summary;
}

}  // namespace report
