// summary_text.cpp - the summary in plain words. Every sentence depends on the figures it needs.
#include <fmt/format.h>

#include <cmath>

#include "tools/report/summary.hpp"

namespace report {
namespace {

std::string joined(const std::vector<std::string>& words) {
    std::string out;
    for (std::size_t index = 0; index < words.size(); ++index) {
        if (index != 0) out += index + 1 == words.size() ? " and " : ", ";
        out += words[index];
    }
    return out;
}

std::string times(std::size_t count) {
    return count == 1 ? "once" : count == 2 ? "twice" : fmt::format("{} times", count);
}

/// The mark of a value below zero; the distance and percent texts carry none.
const char* minus(double value) {
    return value < 0 ? "\u2212" : "";
}

void say_drive(const Summary& summary, std::vector<std::string>& out) {
    const std::string duration = text_of_duration(summary.duration_s);
    const Figure& wheels = summary.wheel_distance_m;
    const std::string turned = wheels ? minus(*wheels) + text_of_distance(*wheels) : "";
    if (summary.true_distance_m) {
        const double distance = *summary.true_distance_m;
        std::string text = fmt::format("The rover drove {}{} in {}", minus(distance),
                                       text_of_distance(distance), duration);
        if (wheels) text += fmt::format("; its wheels turned {}", turned);
        if (summary.slip_overall_percent) {
            text += fmt::format(", so {}{} of the wheel travel was slip",
                                minus(*summary.slip_overall_percent),
                                text_of_percent(*summary.slip_overall_percent));
        }
        out.push_back(text + ".");
    } else if (wheels) {
        out.push_back(fmt::format("The wheels turned {} forward in {}.", turned, duration));
        const auto turning = summary.mode_share.find("turning");
        if (turning != summary.mode_share.end() && turning->second >= 0.01) {
            out.push_back(fmt::format("For {} of the time the vehicle turned on the spot.",
                                      text_of_percent(100 * turning->second)));
        }
        out.push_back("The log holds no true position, so no error can be given.");
    } else {
        out.push_back(
            fmt::format("The log lasts {}. It holds neither a true position nor a wheel "
                        "tachometer, so no distance can be given.",
                        duration));
    }
}

void say_position(const Summary& summary, std::vector<std::string>& out) {
    if (!summary.has_estimates) {
        out.push_back("No controller has run on this log: it holds inputs only.");
        return;
    }
    const auto share = summary.available_share.find("slip");
    const bool has_slip = share != summary.available_share.end() && share->second > 0;
    if (!has_slip) {
        out.push_back(
            "The firmware had no usable suspension geometry: its position is plain wheel "
            "odometry, not corrected for slip.");
    }
    if (summary.firmware_error_percent) {
        const std::string wheel_error = text_of_percent(*summary.wheel_error_percent);
        out.push_back(
            has_slip ? fmt::format("At the end the firmware's position is off by {} ({} too {}); "
                                   "plain wheel odometry is off by {}.",
                                   text_of_percent(*summary.firmware_error_percent),
                                   text_of_distance(*summary.firmware_error_m),
                                   *summary.firmware_error_m < 0 ? "short" : "far", wheel_error)
                     : fmt::format("At the end it is off by {}.", wheel_error));
    } else if (has_slip && summary.firmware_distance_m) {
        const double distance = *summary.firmware_distance_m;
        out.push_back(fmt::format("By the firmware's slip-corrected position the rover drove {}{}.",
                                  minus(distance), text_of_distance(distance)));
    }
    if (has_slip && summary.position_sigma_m) {
        out.push_back(
            fmt::format("The firmware itself gives its final position an uncertainty of {} "
                        "(one sigma).",
                        text_of_distance(*summary.position_sigma_m)));
    }
}

void say_sinkage(const Summary& summary, std::vector<std::string>& out) {
    const QuantityFigures& sinkage = summary.sinkage_mm;
    std::string text;
    if (sinkage.estimated_mean) {
        text = fmt::format("Sinkage is estimated at {:.1f} mm on average and {:.0f} mm at most",
                           *sinkage.estimated_mean, *sinkage.estimated_greatest);
        if (sinkage.true_mean) {
            text += fmt::format("; the truth is {:.1f} mm and {:.0f} mm", *sinkage.true_mean,
                                *sinkage.true_greatest);
        }
        if (sinkage.rms_error) text += fmt::format(" (RMS error {:.1f} mm)", *sinkage.rms_error);
    } else if (sinkage.true_mean) {
        text = fmt::format("True sinkage is {:.1f} mm on average and {:.0f} mm at most",
                           *sinkage.true_mean, *sinkage.true_greatest);
    }
    if (!text.empty()) out.push_back(text + ".");
}

std::string alarm_text(const char* name, const AlarmFigures& alarm) {
    if (alarm.count == 0) return fmt::format("The {} alarm never went up.", name);
    const std::string duration = text_of_duration(*alarm.first_time_s);
    const std::string where = alarm.first_place_m
                                  ? fmt::format("at {}{} (after {})", minus(*alarm.first_place_m),
                                                text_of_distance(*alarm.first_place_m), duration)
                                  : fmt::format("after {}", duration);
    return fmt::format("The {} alarm went up {}, first {}; it was up for {} of the time.", name,
                       times(alarm.count), where, text_of_percent(100.0 * alarm.raised_share));
}

void say_alarms(const Summary& summary, std::vector<std::string>& out) {
    const auto can = [&](const char* estimate) {
        const auto share = summary.available_share.find(estimate);
        return share != summary.available_share.end() && share->second > 0;
    };
    if (can("slip") || summary.slip_alarm.count != 0) {
        out.push_back(alarm_text("slip", summary.slip_alarm));
    }
    if (can("sinkage") || summary.sinkage_alarm.count != 0) {
        out.push_back(alarm_text("sinkage", summary.sinkage_alarm));
    }
    if (summary.lost_lock_count != 0) {
        out.push_back(
            fmt::format("The estimator declared loss of lock {}.", times(summary.lost_lock_count)));
    }
    if (summary.tick_gap_count != 0) {
        out.push_back(fmt::format("Ticks are missing before {} step{}.", summary.tick_gap_count,
                                  summary.tick_gap_count == 1 ? "" : "s"));
    }
}

void say_sensors(const Summary& summary, std::vector<std::string>& out) {
    if (!summary.sensors_missing.empty()) {
        out.push_back("Sensors missing throughout: " + joined(summary.sensors_missing) + ".");
    }
    if (!summary.sensors_intermittent.empty()) {
        out.push_back("Sensors that fell silent at times: " + joined(summary.sensors_intermittent) +
                      ".");
    }
    if (!summary.not_available.empty()) {
        out.push_back("Estimates not available on this vehicle: " + joined(summary.not_available) +
                      ".");
    }
}

}  // namespace

std::string text_of_percent(double value) {
    const double size = std::abs(value);
    if (size == 0) return "0 %";
    if (size < 0.01) return "less than 0.01 %";
    return size < 0.995  ? fmt::format("{:.2f} %", size)
           : size < 9.95 ? fmt::format("{:.1f} %", size)
                         : fmt::format("{:.0f} %", size);
}

std::string text_of_distance(double value_m) {
    const double size = std::abs(value_m);
    if (size < 0.01) return fmt::format("{:.0f} mm", 1000.0 * size);
    if (size < 0.995) return fmt::format("{:.0f} cm", 100.0 * size);
    return size < 9.995 ? fmt::format("{:.2f} m", size) : fmt::format("{:.1f} m", size);
}

std::string text_of_duration(double value_s) {
    if (value_s < 59.95) return fmt::format("{:.1f} s", value_s);
    const auto whole_s = static_cast<long long>(std::llround(value_s));
    const bool hours = whole_s >= 3600;
    const long long large = hours ? whole_s / 3600 : whole_s / 60;
    const long long small = hours ? whole_s % 3600 / 60 : whole_s % 60;
    std::string text = fmt::format("{} {}", large, hours ? "h" : "min");
    if (small != 0) text += fmt::format(" {} {}", small, hours ? "min" : "s");
    return text;
}

std::string text_of_count(std::size_t count) {
    std::string text = std::to_string(count);
    for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, 1, ',');
    return text;
}

std::vector<std::string> sentences(const Summary& summary) {
    if (summary.step_count == 0) return {"The log is empty: it holds no step."};
    std::vector<std::string> out;
    say_drive(summary, out);
    say_position(summary, out);
    say_sinkage(summary, out);
    say_alarms(summary, out);
    say_sensors(summary, out);
    return out;
}

}  // namespace report
