#include "tools/report/columns.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace report {
namespace {

constexpr double kBackwardsMm = 100.0;
constexpr double kTrackMinMm = 100.0;

/// Mean pulses between two steps over the wheels that both have; NaN when there is none.
double mean_pulses(const hal::RawInputs& before, const hal::RawInputs& now) {
    const unsigned both = before.tach_present & now.tach_present;
    double sum = 0;
    int wheels = 0;
    for (unsigned wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        if (((both >> wheel) & 1u) == 0) continue;
        const auto delta = static_cast<std::uint16_t>(now.tach_count[wheel] -
                                                      before.tach_count[wheel]);  // modulo 2^16
        sum += std::bit_cast<std::int16_t>(delta);
        ++wheels;
    }
    return wheels == 0 ? kNotKnown : sum / wheels;
}

/// Non-decreasing place in metres from positions in millimetres with gaps.
void set_place(const Column& position_mm, Track& track) {
    const auto known = std::find_if(position_mm.begin(), position_mm.end(),
                                    [](double value) { return std::isfinite(value); });
    double last = *known;
    double greatest = last;
    for (const double value : position_mm) {
        if (!std::isfinite(value)) continue;
        if (value < greatest - kBackwardsMm) track.reverses = true;
        greatest = std::max(greatest, value);
    }
    double place = track.reverses ? 0.0 : last;
    track.place_m.reserve(position_mm.size());
    for (const double value : position_mm) {
        if (std::isfinite(value)) {
            place = track.reverses ? place + std::abs(value - last) : std::max(place, value);
            last = value;
        }
        track.place_m.push_back(place / 1000.0);
    }
}

bool enough(const Column& position_mm, double share) {
    const auto known = std::count_if(position_mm.begin(), position_mm.end(),
                                     [](double value) { return std::isfinite(value); });
    return known > 0 &&
           static_cast<double>(known) >= share * static_cast<double>(position_mm.size());
}

}  // namespace

double calibrated_deg(const hal::AngleCalibration& calibration, std::uint16_t adc_q4_count) {
    if (adc_q4_count > hal::kAdcMaxQ4Count || calibration.gain_q16 == 0) return kNotKnown;
    const double counts = static_cast<double>(adc_q4_count) - calibration.zero_q4_count;
    const double angle_deg = deg_of_brad(counts * calibration.gain_q16 / 65536.0);
    return calibration.inverted ? -angle_deg : angle_deg;
}

Column wheel_travel_mm(const host_sim::Log& log) {
    const double mm_per_pulse = log.head.calibration.tach_q16_mm_per_count / 65536.0;
    Column travel_mm(log.steps.size(), 0.0);
    bool any = false;
    for (std::size_t row = 1; row < log.steps.size(); ++row) {
        const double pulses = mean_pulses(log.steps[row - 1].inputs, log.steps[row].inputs);
        any = any || std::isfinite(pulses);
        travel_mm[row] = travel_mm[row - 1] + (std::isfinite(pulses) ? pulses * mm_per_pulse : 0.0);
    }
    if (!any) std::fill(travel_mm.begin(), travel_mm.end(), kNotKnown);
    return travel_mm;
}

Track track_of(const host_sim::Log& log) {
    Track track;
    Column truth_mm, firmware_mm;
    for (const host_sim::LogStep& step : log.steps) {
        track.time_s.push_back(step.time_ms / 1000.0);
        truth_mm.push_back(step.truth ? step.truth->position_mm : kNotKnown);
        firmware_mm.push_back(step.estimates ? mm_of_q4(step.estimates->position_q4_mm)
                                             : kNotKnown);
    }
    const Column wheels_mm = wheel_travel_mm(log);
    if (enough(truth_mm, 0.9)) {
        track.source = PlaceSource::truth;
        set_place(truth_mm, track);
    } else if (enough(firmware_mm, 0.9)) {
        track.source = PlaceSource::firmware;
        set_place(firmware_mm, track);
    } else if (enough(wheels_mm, 0.9)) {
        track.source = PlaceSource::wheels;
        set_place(wheels_mm, track);
    }
    if (track.source != PlaceSource::none &&
        (track.place_m.back() - track.place_m.front()) * 1000.0 < kTrackMinMm) {
        track.source = PlaceSource::none;
        track.place_m.clear();
    }
    return track;
}

}  // namespace report
