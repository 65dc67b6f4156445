// comparison.cpp - see comparison.hpp.
#include "host_sim/bind/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace host_sim {
namespace {

// The table of docs/spec/telemetry.md.
constexpr std::array kFields = {
    TelemetryField{"sync", 0, 2},
    TelemetryField{"version", 2, 1},
    TelemetryField{"payload size", 3, 1},
    TelemetryField{"step_count", 4, 2},
    TelemetryField{"tick_count", 6, 2},
    TelemetryField{"available", 8, 1},
    TelemetryField{"events", 9, 1},
    TelemetryField{"faults", 10, 2},
    TelemetryField{"mode", 12, 1},
    TelemetryField{"cycle_count", 13, 2},
    TelemetryField{"position_q4_mm", 15, 4, true},
    TelemetryField{"odometer_q4_mm", 19, 4, true},
    TelemetryField{"position_sigma_q4_mm", 23, 2},
    TelemetryField{"advance_q4_mm", 25, 2, true},
    TelemetryField{"slip_percent", 27, 1, true},
    TelemetryField{"match_cost_q4", 28, 2},
    TelemetryField{"sinkage_q4_mm", 30, 2, true},
    TelemetryField{"pitch_brad", 32, 2, true},
    TelemetryField{"roll_brad", 34, 2, true},
    TelemetryField{"rocker_brad", 36, 2, true},
    TelemetryField{"bogie_brad", 38, 2, true},
    TelemetryField{"height_middle_q4_mm", 40, 2, true},
    TelemetryField{"height_front_q4_mm", 42, 2, true},
    TelemetryField{"height_ahead_q4_mm[0]", 44, 2, true},
    TelemetryField{"height_ahead_q4_mm[1]", 46, 2, true},
    TelemetryField{"check", 48, 2},
};
constexpr std::size_t kFrameSize = 50;

/// A field of a frame as number and bytes.
std::string field_text(const hal::Commands& commands, const TelemetryField& field) {
    std::string bytes;
    uint32_t value = 0;
    for (std::size_t i = 0; i < field.size; ++i) {
        if (field.offset + i >= commands.telemetry_size) return "nothing";
        const uint8_t byte = commands.telemetry[field.offset + i];
        value |= uint32_t{byte} << (8 * i);
        bytes += fmt::format("{}{:02X}", i == 0 ? "" : " ", byte);
    }
    int64_t number = value;
    const unsigned bits = static_cast<unsigned>(8 * field.size);
    if (field.is_signed && (value >> (bits - 1) & 1) != 0) number -= int64_t{1} << bits;
    return fmt::format("{} ({})", number, bytes);
}

/// Fills in signal and values of the first difference. @return  false: there is none
bool find_difference(const hal::Commands& a, const hal::Commands& b, Divergence& found) {
    const auto differ = [&found](std::string signal, std::string first, std::string second) {
        found.signal = std::move(signal);
        found.first = std::move(first);
        found.second = std::move(second);
        return true;
    };
    if (a.telemetry_size != b.telemetry_size) {
        return differ("telemetry frame", fmt::format("{} bytes", a.telemetry_size),
                      fmt::format("{} bytes", b.telemetry_size));
    }
    for (std::size_t i = 0; i < a.telemetry_size; ++i) {
        if (a.telemetry[i] == b.telemetry[i]) continue;
        const TelemetryField field = telemetry_field_at(i);
        return differ(fmt::format("telemetry {} (byte {})", field.name, i), field_text(a, field),
                      field_text(b, field));
    }
    for (std::size_t i = 0; i < hal::kWheelCount; ++i) {
        if (a.drive_percent[i] == b.drive_percent[i]) continue;
        return differ(fmt::format("drive motor {}", i), fmt::format("{} %", a.drive_percent[i]),
                      fmt::format("{} %", b.drive_percent[i]));
    }
    for (std::size_t i = 0; i < hal::kSteerCount; ++i) {
        if (a.steer_brad[i] == b.steer_brad[i]) continue;
        return differ(fmt::format("steering motor {}", i), fmt::format("{}", a.steer_brad[i]),
                      fmt::format("{}", b.steer_brad[i]));
    }
    if (a.mast_brad != b.mast_brad) {
        return differ("mast motor", fmt::format("{}", a.mast_brad), fmt::format("{}", b.mast_brad));
    }
    if (a.laser_bits != b.laser_bits) {
        return differ("lasers", fmt::format("{:04b}b", a.laser_bits),
                      fmt::format("{:04b}b", b.laser_bits));
    }
    return false;
}

}  // namespace

TelemetryField telemetry_field_at(std::size_t offset) {
    static_assert(kFields.back().offset + kFields.back().size == kFrameSize);
    for (const TelemetryField& field : kFields) {
        if (offset >= field.offset && offset < field.offset + field.size) return field;
    }
    return {"behind the frame", offset, 1};
}

Comparison compare_outputs(const Log& first, const Log& second) {
    Comparison result;
    const std::size_t steps = std::max(first.steps.size(), second.steps.size());
    for (std::size_t i = 0; i < steps; ++i) {
        ++result.steps;
        Divergence found;
        found.step = i;
        if (i >= first.steps.size() || i >= second.steps.size()) {
            found.signal = "steps of the log";
            found.first = fmt::format("{}", first.steps.size());
            found.second = fmt::format("{}", second.steps.size());
            result.divergence = found;
            return result;
        }
        found.time_ms = first.steps[i].time_ms;
        const auto& a = first.steps[i].commands;
        const auto& b = second.steps[i].commands;
        if (a.has_value() != b.has_value()) {
            found.signal = "commands";
            found.first = a ? "there" : "none";
            found.second = b ? "there" : "none";
            result.divergence = found;
            return result;
        }
        if (!a) continue;
        if (find_difference(*a, *b, found)) {
            result.divergence = found;
            return result;
        }
        if (a->telemetry_size != 0) ++result.frames;
        result.bytes += a->telemetry_size;
    }
    return result;
}

}  // namespace host_sim
