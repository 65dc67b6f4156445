#include "host_sim/calibration/calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host_sim/calibration/calibration_file.hpp"

namespace host_sim {
namespace {

using hal::AngleChannel;

constexpr double kBradPerDeg = 65536.0 / 360;
constexpr double kNominalZeroQ4Count = 32760;
constexpr double kDegPerQ4CountPotentiometer = 90.0 / 65536;
constexpr double kDegPerQ4CountInclinometer = 150.0 / 65536;

/// The converter channel of an angle: both enumerations open with the same five.
std::vector<Reading> readings_of(const Log& log, AngleChannel channel) {
    static_assert(static_cast<int>(hal::AdcChannel::bogie_left) ==
                      static_cast<int>(AngleChannel::bogie_left) &&
                  static_cast<int>(hal::AdcChannel::roll) == static_cast<int>(AngleChannel::roll));
    std::vector<Reading> readings;
    for (const LogStep& step : log.steps) {
        readings.push_back(
            {step.time_ms, step.inputs.adc_q4_count[static_cast<std::size_t>(channel)]});
    }
    return readings;
}

void check_options(const CalibrateOptions& options) {
    for (const double stop_deg : {options.bogie_stop_deg, options.differential_stop_deg}) {
        if (!(stop_deg > 0 && stop_deg < 45)) {
            throw CalibrationError(
                fmt::format("stop angle {} deg is outside (0, 45): give the angle from the middle "
                            "to one stop",
                            stop_deg));
        }
    }
    if (!(options.swing.settle_s >= 0 && options.swing.dwell_s > 2 * options.swing.settle_s) ||
        options.swing.visits_min < 2) {
        throw CalibrationError(
            "the dwell time must exceed twice the settling time, visits at least 2");
    }
    if (options.turned_span && !options.level_span) {
        throw CalibrationError("a turned stretch needs the level stretch before the turn");
    }
    if (options.swung.empty() && !options.level_span) {
        throw CalibrationError("nothing to estimate: name a swung channel or a level stretch");
    }
    for (const AngleChannel channel : options.swung) {
        if (channel == AngleChannel::pitch || channel == AngleChannel::roll) {
            throw CalibrationError("the inclinometer has no stops: give a level stretch");
        }
    }
}

void check_zero(double zero_q4_count, double deg_per_q4_count, double max_deg) {
    const double off_deg = (zero_q4_count - kNominalZeroQ4Count) * deg_per_q4_count;
    if (std::abs(off_deg) > max_deg) {
        throw CalibrationError(fmt::format(
            "the zero would be {:.1f} deg off the middle of the converter, at most {:.0f} is "
            "credible: check the mounting and what the log shows",
            off_deg, max_deg));
    }
}

ChannelCalibration from_swing(const Log& log, AngleChannel channel,
                              const CalibrateOptions& options) {
    const Swing swing = find_swing(readings_of(log, channel), options.swing);
    const double stop_deg = channel == AngleChannel::differential ? options.differential_stop_deg
                                                                  : options.bogie_stop_deg;
    const double span_q4_count = swing.high.q4_count - swing.low.q4_count;
    const double stops_error_q4_count =
        std::hypot(swing.low.standard_error_q4_count, swing.high.standard_error_q4_count);
    ChannelCalibration found;
    found.channel = channel;
    found.swing = swing;
    found.zero_q4_count = (swing.low.q4_count + swing.high.q4_count) / 2;
    found.zero_error_q4_count = stops_error_q4_count / 2;
    found.gain_q16 = 2 * stop_deg * kBradPerDeg * 65536 / span_q4_count;
    found.gain_error_q16 = found.gain_q16 * stops_error_q4_count / span_q4_count;
    const double deviation = found.gain_q16 / hal::kPotentiometerGainQ16 - 1;
    if (std::abs(deviation) > options.gain_tolerance) {
        throw CalibrationError(fmt::format(
            "the gain would be {:+.0f} % off nominal, at most {:.0f} % is credible: a stop was not "
            "reached, or the stops are not at +-{} deg",
            deviation * 100, options.gain_tolerance * 100, stop_deg));
    }
    check_zero(found.zero_q4_count, kDegPerQ4CountPotentiometer, options.zero_max_deg);
    return found;
}

/// @param ground_deg  receives the slope of the ground when both headings are there
ChannelCalibration from_level(const Log& log, AngleChannel channel, const CalibrateOptions& options,
                              double& ground_deg) {
    const std::vector<Reading> readings = readings_of(log, channel);
    const LevelReading level = read_level(readings, *options.level_span, options.level);
    ChannelCalibration found;
    found.channel = channel;
    found.zero_q4_count = level.q4_count;
    found.zero_error_q4_count = level.standard_error_q4_count;
    if (options.turned_span) {
        const LevelReading turned = read_level(readings, *options.turned_span, options.level);
        found.zero_q4_count = (level.q4_count + turned.q4_count) / 2;
        found.zero_error_q4_count =
            std::hypot(level.standard_error_q4_count, turned.standard_error_q4_count) / 2;
        const auto index = static_cast<std::size_t>(channel);
        const bool inverted = log.head.calibration.angle[index].inverted != options.flip[index];
        ground_deg = (level.q4_count - turned.q4_count) / 2 * kDegPerQ4CountInclinometer *
                     (inverted ? -1 : 1);
    }
    check_zero(found.zero_q4_count, kDegPerQ4CountInclinometer, options.level_max_deg);
    return found;
}

template <class Estimate>
void add_channel(CalibrationResult& result, AngleChannel channel, const Estimate& estimate) {
    try {
        const ChannelCalibration found = estimate();
        hal::AngleCalibration& angle = result.record.angle[static_cast<std::size_t>(channel)];
        angle.zero_q4_count = static_cast<std::uint16_t>(std::lround(found.zero_q4_count));
        if (found.gain_q16 > 0) {
            angle.gain_q16 = static_cast<std::uint16_t>(std::lround(found.gain_q16));
        }
        result.channels.push_back(found);
    } catch (const CalibrationError& error) {
        throw CalibrationError(fmt::format("{}: {}", angle_channel_name(channel), error.what()));
    }
}

std::string describe_channel(const ChannelCalibration& found) {
    const bool swung = found.swing.has_value();
    const double deg_per_q4_count =
        swung ? found.gain_q16 / 65536 / kBradPerDeg : kDegPerQ4CountInclinometer;
    std::string line =
        fmt::format("{:<13} zero {:8.1f} +- {:.1f} Q4 counts ({:.4f} deg)",
                    angle_channel_name(found.channel), found.zero_q4_count,
                    found.zero_error_q4_count, found.zero_error_q4_count * deg_per_q4_count);
    if (!swung) return line + "; gain not estimated";
    return line + fmt::format(
                      "; gain {:.1f} +- {:.1f} Q16 brad/count ({:.3f} %); stops visited {} and {} "
                      "times; noise {:.1f} Q4 counts",
                      found.gain_q16, found.gain_error_q16,
                      100 * found.gain_error_q16 / found.gain_q16, found.swing->low.visits,
                      found.swing->high.visits, found.swing->noise_q4_count);
}

}  // namespace

CalibrationResult calibrate(const Log& log, const CalibrateOptions& options) {
    check_options(options);
    CalibrationResult result;
    result.record = log.head.calibration;
    for (const AngleChannel channel : options.swung) {
        add_channel(result, channel, [&] { return from_swing(log, channel, options); });
    }
    if (options.level_span) {
        add_channel(result, AngleChannel::pitch, [&] {
            return from_level(log, AngleChannel::pitch, options, result.ground_pitch_deg);
        });
        add_channel(result, AngleChannel::roll, [&] {
            return from_level(log, AngleChannel::roll, options, result.ground_roll_deg);
        });
    }
    for (std::size_t index = 0; index < hal::kAngleChannelCount; ++index) {
        if (options.flip[index]) {
            result.record.angle[index].inverted = !result.record.angle[index].inverted;
        }
    }
    return result;
}

std::vector<std::string> describe(const CalibrationResult& result,
                                  const CalibrateOptions& options) {
    std::vector<std::string> lines;
    for (const ChannelCalibration& found : result.channels)
        lines.push_back(describe_channel(found));
    const bool swung = std::ranges::any_of(
        result.channels, [](const ChannelCalibration& found) { return found.swing.has_value(); });
    if (swung) {
        lines.push_back(fmt::format(
            "stops taken as exactly +-{} deg (bogies) and +-{} deg (differential): an error there "
            "adds to these",
            options.bogie_stop_deg, options.differential_stop_deg));
    }
    if (options.turned_span) {
        lines.push_back(fmt::format("ground under the vehicle: pitch {:.3f} deg, roll {:.3f} deg",
                                    result.ground_pitch_deg, result.ground_roll_deg));
    } else if (options.level_span) {
        lines.push_back(
            "one heading only: the ground's own slope is part of the inclinometer zero");
    }
    return lines;
}

}  // namespace host_sim
