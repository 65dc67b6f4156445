#include "tools/rover85/log_output.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "host_sim/log/log_io.hpp"

namespace {

constexpr std::array<std::string_view, hal::kAdcChannelCount> kAdcNames = {
    "bogie_left",        "bogie_right",     "differential",     "pitch", "roll", "steer_front_left",
    "steer_front_right", "steer_rear_left", "steer_rear_right", "gyro",  "mast", "motor_current",
    "battery",           "proximity"};
constexpr std::array<std::string_view, hal::kWheelCount> kWheelNames = {
    "front_left", "front_right", "middle_left", "middle_right", "rear_left", "rear_right"};

}  // namespace

std::string check_log_name(const std::string& path) {
    const std::string extension = std::filesystem::path(path).extension().string();
    if (extension == ".rlog" || extension == ".csv") return "";
    return fmt::format("{}: the name must end in .rlog or .csv", path);
}

void write_log(const std::filesystem::path& path, const host_sim::Log& log) {
    const std::string extension = path.extension().string();
    if (extension == ".rlog") {
        host_sim::write_rlog(path, log);
    } else if (extension == ".csv") {
        host_sim::write_csv(path, log);
    } else {
        throw host_sim::LogError(path.string(), {}, "not a log's name", "end it in .rlog or .csv");
    }
}

std::string describe_log(const host_sim::Log& log) {
    std::string present;
    const auto add = [&present](std::string_view kind, std::string_view name) {
        present += fmt::format("{}{}{}", present.empty() ? "" : ", ", kind, name);
    };
    std::array<bool, hal::kAdcChannelCount> adc{};
    unsigned tach = 0, range = 0;
    bool truth = false;
    for (const host_sim::LogStep& step : log.steps) {
        for (std::size_t channel = 0; channel < adc.size(); ++channel) {
            adc[channel] |= step.inputs.adc_q4_count[channel] <= hal::kAdcMaxQ4Count;
        }
        tach |= step.inputs.tach_present;
        range |= step.inputs.range_present;
        truth |= step.truth.has_value();
    }
    for (std::size_t channel = 0; channel < adc.size(); ++channel) {
        if (adc[channel]) add("", kAdcNames[channel]);
    }
    for (std::size_t wheel = 0; wheel < kWheelNames.size(); ++wheel) {
        if ((tach >> wheel & 1U) != 0) add("tachometer ", kWheelNames[wheel]);
    }
    if (range != 0) add("", "range");
    if (truth) add("", "truth");
    const double duration_s =
        log.steps.empty() ? 0 : (log.steps.back().time_ms - log.steps.front().time_ms) / 1000.0;
    return fmt::format("{} steps, {:.1f} s; present: {}; all else absent", log.steps.size(),
                       duration_s, present.empty() ? "nothing" : present);
}
