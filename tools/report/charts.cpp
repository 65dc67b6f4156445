#include "tools/report/charts.hpp"

#include <algorithm>
#include <cmath>

namespace report {
namespace {

using host_sim::Log;
using host_sim::LogStep;
using rover::Estimates;

bool has_value(const Column& column) {
    return std::any_of(column.begin(), column.end(), [](double v) { return std::isfinite(v); });
}

/// A column by a function of the step; NaN where the function says so.
template <typename Value>
Column column_of(const Log& log, Value value) {
    Column column;
    column.reserve(log.steps.size());
    for (const LogStep& step : log.steps) column.push_back(value(step));
    return column;
}

/// A column of the estimates, where `bit` says that they are available; 0 asks for any estimate.
template <typename Value>
Column estimate_column(const Log& log, unsigned bit, Value value) {
    return column_of(log, [&](const LogStep& step) {
        const bool has = step.estimates && (bit == 0 || (step.estimates->available & bit) != 0);
        return has ? static_cast<double>(value(*step.estimates)) : kNotKnown;
    });
}

Column truth_column(const Log& log, double host_sim::Truth::* field, double scale) {
    return column_of(log, [&](const LogStep& step) {
        return step.truth ? scale * (*step.truth).*field : kNotKnown;
    });
}

void add_chart(Chart chart, std::vector<Chart>& charts) {
    std::erase_if(chart.series, [](const Series& series) { return !has_value(series.values); });
    if (!chart.series.empty()) charts.push_back(std::move(chart));
}

/// Values met `ahead_m` further on, moved to the place where they were met; linear between steps.
Column moved_ahead(const Column& values, const Column& place_m, double ahead_m) {
    Column moved(values.size(), kNotKnown);
    std::size_t from = 0;
    for (std::size_t row = 0; row < values.size(); ++row) {
        const double wanted_m = place_m[row] - ahead_m;
        if (wanted_m < place_m.front()) continue;
        while (from + 1 < values.size() && place_m[from + 1] <= wanted_m) ++from;
        const double left_m = place_m[from];
        const double right_m = from + 1 < values.size() ? place_m[from + 1] : left_m;
        const double part = right_m > left_m ? (wanted_m - left_m) / (right_m - left_m) : 0.0;
        const double right = part > 0 ? values[from + 1] : values[from];
        moved[row] = values[from] + part * (right - values[from]);
    }
    return moved;
}

void add_ground(const Log& log, const Track& track, const ReportOptions& options,
                std::vector<Chart>& charts) {
    using host_sim::Truth;
    const bool moves =
        options.front_wheel_ahead_mm && track.source == PlaceSource::truth && !track.reverses;
    Chart chart{"ground",
                "Ground and wheel tracks",
                "m",
                moves ? "True heights: the ground as it was, and the firmer surface that carries "
                        "the wheels. The gap between the two is the sinkage."
                      : "True heights under the front wheel and, half a vehicle behind it, under "
                        "the rear wheel, both drawn at the rear wheel's place.",
                3,
                {},
                {}};
    chart.series = {
        {"Undisturbed ground", "ground", truth_column(log, &Truth::ground_front_mm, 1e-3), {}},
        {"Front wheel track (load-bearing surface)",
         "front",
         truth_column(log, &Truth::surface_front_mm, 1e-3),
         {}},
        {"Rear wheel track", "rear", truth_column(log, &Truth::surface_rear_mm, 1e-3), {}},
    };
    if (moves) {
        for (std::size_t index = 0; index < 2; ++index) {
            Series& series = chart.series[index];
            series.values_by_place =
                moved_ahead(series.values, track.place_m, *options.front_wheel_ahead_mm / 1000.0);
        }
    }
    add_chart(std::move(chart), charts);
}

/// Travel by the estimates minus true travel, in `scale` per millimetre, since the first step that
/// has both.
Column error_column(const Log& log, std::int32_t Estimates::* field, double scale) {
    const LogStep* first = nullptr;
    return column_of(log, [&](const LogStep& step) {
        if (!step.estimates || !step.truth || !std::isfinite(step.truth->position_mm)) {
            return kNotKnown;
        }
        if (first == nullptr) first = &step;
        const double travel_mm =
            mm_of_q4((*step.estimates).*field) - mm_of_q4((*first->estimates).*field);
        return scale * (travel_mm - (step.truth->position_mm - first->truth->position_mm));
    });
}

void add_position(const Log& log, std::vector<Chart>& charts) {
    const bool has_slip = has_value(
        estimate_column(log, rover::kAvailableSlip, [](const Estimates& e) { return e.mode; }));
    Chart both{
        "error", "Position error",
        "m",     "Estimated minus true position: the firmware's beside plain wheel odometry.",
        3,       {},
        {}};
    both.series = {
        {"Wheel odometry", "wheels", error_column(log, &Estimates::odometer_q4_mm, 1e-3), {}}};
    const Column error_cm = error_column(log, &Estimates::position_q4_mm, 0.1);
    if (has_slip) {
        both.series.insert(
            both.series.begin(),
            {"Firmware", "firmware", error_column(log, &Estimates::position_q4_mm, 1e-3), {}});
    }
    add_chart(std::move(both), charts);
    const Column sigma_cm = estimate_column(log, rover::kAvailableSlip, [](const Estimates& e) {
        return 0.1 * mm_of_q4(e.position_sigma_q4_mm);
    });
    if (has_slip && has_value(error_cm)) {
        add_chart({"error_firmware",
                   "Firmware position error, close up",
                   "cm",
                   "The band is the firmware's own one-sigma uncertainty: it should hold the zero "
                   "line most of the time.",
                   2,
                   {{"Firmware", "firmware", error_cm, {}}},
                   sigma_cm},
                  charts);
    } else if (has_slip) {
        const auto ahead_m = [](const Estimates& e) {
            return mm_of_q4(e.odometer_q4_mm - static_cast<double>(e.position_q4_mm)) / 1000.0;
        };
        add_chart({"difference",
                   "Wheel odometry ahead of the firmware's position",
                   "m",
                   "Without a true position this is the slip that the firmware has taken out, not "
                   "an error.",
                   3,
                   {{"Difference", "firmware", estimate_column(log, 0, ahead_m), {}}},
                   {}},
                  charts);
    }
}

void add_slip_and_sinkage(const Log& log, std::vector<Chart>& charts) {
    const auto sinkage_mm = [](const Estimates& e) { return mm_of_q4(e.sinkage_q4_mm); };
    const auto slip_percent = [](const Estimates& e) { return e.slip_percent; };
    add_chart(
        {"sinkage",
         "Sinkage",
         "mm",
         "Depth of the front wheel below the undisturbed ground.",
         1,
         {{"Estimated", "firmware", estimate_column(log, rover::kAvailableSinkage, sinkage_mm), {}},
          {"True", "truth", truth_column(log, &host_sim::Truth::sinkage_mm, 1.0), {}}},
         {}},
        charts);
    add_chart(
        {"slip",
         "Slip",
         "%",
         "100 % means that the wheels turn and the rover stands still.",
         1,
         {{"Estimated", "firmware", estimate_column(log, rover::kAvailableSlip, slip_percent), {}},
          {"True", "truth", truth_column(log, &host_sim::Truth::slip, 100.0), {}}},
         {}},
        charts);
}

void add_attitude(const Log& log, std::vector<Chart>& charts) {
    Chart chart{"attitude", "Attitude and linkage", "\u00b0", "", 2, {}, {}};
    const auto add = [&](const char* name, const char* style, rover::Available bit,
                         std::int16_t Estimates::* field) {
        const auto angle_deg = [field](const Estimates& e) { return deg_of_brad(e.*field); };
        chart.series.push_back({name, style, estimate_column(log, bit, angle_deg), {}});
    };
    add("Pitch (nose up)", "pitch", rover::kAvailableAttitude, &Estimates::pitch_brad);
    add("Roll (right side down)", "roll", rover::kAvailableAttitude, &Estimates::roll_brad);
    add("Left rocker", "rocker", rover::kAvailableLinkage, &Estimates::rocker_brad);
    add("Left bogie", "bogie", rover::kAvailableLinkage, &Estimates::bogie_brad);
    chart.caption = "As the firmware sees them, against the horizon.";
    const bool any = std::any_of(chart.series.begin(), chart.series.end(),
                                 [](const Series& series) { return has_value(series.values); });
    if (!any) {  // straight from the sensors, by the calibration record
        static constexpr const char* kNames[] = {"Left bogie potentiometer",
                                                 "Right bogie potentiometer",
                                                 "Differential potentiometer", "Pitch", "Roll"};
        static constexpr const char* kStyles[] = {"bogie", "bogie_right", "rocker", "pitch",
                                                  "roll"};
        chart.caption = "Sensor counts turned into angles by the calibration record.";
        chart.series.clear();
        for (unsigned index = 0; index < hal::kAngleChannelCount; ++index) {
            const hal::AngleCalibration& calibration = log.head.calibration.angle[index];
            chart.series.push_back({kNames[index],
                                    kStyles[index],
                                    column_of(log,
                                              [&](const LogStep& step) {
                                                  return calibrated_deg(
                                                      calibration, step.inputs.adc_q4_count[index]);
                                              }),
                                    {}});
        }
    }
    add_chart(std::move(chart), charts);
}

void add_heights(const Log& log, std::vector<Chart>& charts) {
    const auto height = [&](const char* name, const char* style, unsigned bit, auto value) {
        return Series{name, style, estimate_column(log, bit, value), {}};
    };
    add_chart({"heights",
               "Heights above the rear wheel",
               "cm",
               "What the suspension and the look-ahead samples tell the slip estimator.",
               2,
               {height("Middle wheel", "middle", rover::kAvailableLinkage,
                       [](const Estimates& e) { return 0.1 * mm_of_q4(e.height_middle_q4_mm); }),
                height("Front wheel", "front", rover::kAvailableLinkage,
                       [](const Estimates& e) { return 0.1 * mm_of_q4(e.height_front_q4_mm); }),
                height("Look-ahead, near", "ahead", rover::kAvailableLookAhead,
                       [](const Estimates& e) { return 0.1 * mm_of_q4(e.height_ahead_q4_mm[0]); }),
                height("Look-ahead, far", "ahead_far", rover::kAvailableLookAhead,
                       [](const Estimates& e) { return 0.1 * mm_of_q4(e.height_ahead_q4_mm[1]); })},
               {}},
              charts);
}

void add_wheels(const Log& log, std::vector<Chart>& charts) {
    Column travel_m = wheel_travel_mm(log);
    for (double& value : travel_m) value /= 1000.0;
    add_chart({"wheels",
               "Wheel travel",
               "m",
               "Mean over the wheels, from the tachometer counts.",
               3,
               {{"Wheel travel", "wheels", std::move(travel_m), {}}},
               {}},
              charts);
}

void add_machine(const Log& log, const Machine& machine, std::vector<Chart>& charts) {
    const auto column = [](const std::vector<std::uint32_t>& t_states) {
        return Column(t_states.begin(), t_states.end());
    };
    if (machine.main_line_t.size() != log.steps.size() ||
        machine.interrupts_t.size() != log.steps.size()) {
        return;
    }
    add_chart({"t_states",
               "T-states a step",
               "T",
               "Work of the processor in each control step; 0.1 s are 307,200 T-states.",
               0,
               {{"Main line", "firmware", column(machine.main_line_t), {}},
                {"Interrupts", "wheels", column(machine.interrupts_t), {}}},
               {}},
              charts);
}

}  // namespace

std::vector<Chart> charts_of(const Log& log, const Track& track, const ReportOptions& options) {
    std::vector<Chart> charts;
    add_ground(log, track, options, charts);
    add_position(log, charts);
    add_slip_and_sinkage(log, charts);
    add_attitude(log, charts);
    add_heights(log, charts);
    if (track.source != PlaceSource::truth) add_wheels(log, charts);
    if (options.machine) add_machine(log, *options.machine, charts);
    return charts;
}

}  // namespace report
