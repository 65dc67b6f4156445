// log_samples.hpp - logs for tests: comparison by meaning, random logs, small fixed ones.
// Independent of the code under test: it walks the structs by hand.
#pragma once

#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include "host_sim/log/log.hpp"

namespace log_test {

inline bool same_number(double a, double b) {
    if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
    return a == b && std::signbit(a) == std::signbit(b);
}

inline bool same(const hal::RawInputs& a, const hal::RawInputs& b) {
    bool equal = a.tick_count == b.tick_count && a.range_scan_count == b.range_scan_count &&
                 a.detector_bits == b.detector_bits && a.command_size == b.command_size &&
                 (a.tach_present & 0x3F) == (b.tach_present & 0x3F) &&
                 a.range_present == b.range_present;
    for (std::size_t i = 0; i < hal::kAdcChannelCount; ++i) {
        const auto mark = [](std::uint16_t count) { return count > 65520 ? 65535 : count; };
        equal = equal && mark(a.adc_q4_count[i]) == mark(b.adc_q4_count[i]);
    }
    for (std::size_t i = 0; i < hal::kWheelCount; ++i) {
        const bool present = (a.tach_present >> i & 1) != 0;
        equal = equal && (!present || a.tach_count[i] == b.tach_count[i]);
    }
    for (std::size_t i = 0; i < hal::kRangeSampleCount; ++i) {
        const bool present = (a.range_present >> i & 1) != 0;
        equal = equal && (!present || a.range_q1_mm[i] == b.range_q1_mm[i]);
    }
    return equal && std::memcmp(a.command, b.command, a.command_size) == 0;
}

inline bool same(const host_sim::Truth& a, const host_sim::Truth& b) {
    return same_number(a.position_mm, b.position_mm) &&
           same_number(a.surface_rear_mm, b.surface_rear_mm) &&
           same_number(a.surface_front_mm, b.surface_front_mm) &&
           same_number(a.ground_front_mm, b.ground_front_mm) &&
           same_number(a.sinkage_mm, b.sinkage_mm) && same_number(a.slip, b.slip);
}

inline bool same(const rover::Estimates& a, const rover::Estimates& b) {
    return a.step_count == b.step_count && a.tick_count == b.tick_count &&
           a.available == b.available && a.events == b.events && a.faults == b.faults &&
           a.mode == b.mode && a.cycle_count == b.cycle_count &&
           a.position_q4_mm == b.position_q4_mm && a.odometer_q4_mm == b.odometer_q4_mm &&
           a.position_sigma_q4_mm == b.position_sigma_q4_mm && a.advance_q4_mm == b.advance_q4_mm &&
           a.slip_percent == b.slip_percent && a.match_cost_q4 == b.match_cost_q4 &&
           a.sinkage_q4_mm == b.sinkage_q4_mm && a.pitch_brad == b.pitch_brad &&
           a.roll_brad == b.roll_brad && a.rocker_brad == b.rocker_brad &&
           a.bogie_brad == b.bogie_brad && a.height_middle_q4_mm == b.height_middle_q4_mm &&
           a.height_front_q4_mm == b.height_front_q4_mm &&
           a.height_ahead_q4_mm[0] == b.height_ahead_q4_mm[0] &&
           a.height_ahead_q4_mm[1] == b.height_ahead_q4_mm[1];
}

inline bool same(const hal::Commands& a, const hal::Commands& b) {
    return std::memcmp(a.drive_percent, b.drive_percent, sizeof a.drive_percent) == 0 &&
           std::memcmp(a.steer_brad, b.steer_brad, sizeof a.steer_brad) == 0 &&
           a.mast_brad == b.mast_brad && a.laser_bits == b.laser_bits &&
           a.telemetry_size == b.telemetry_size &&
           std::memcmp(a.telemetry, b.telemetry, a.telemetry_size) == 0;
}

inline bool same(const hal::Calibration& a, const hal::Calibration& b) {
    bool equal = a.version == b.version && a.wheel_radius_q4_mm == b.wheel_radius_q4_mm &&
                 a.tach_counts_per_turn == b.tach_counts_per_turn &&
                 a.tach_q16_mm_per_count == b.tach_q16_mm_per_count &&
                 a.range_offset_q1_mm == b.range_offset_q1_mm;
    for (std::size_t i = 0; i < hal::kAngleChannelCount; ++i) {
        equal = equal && a.angle[i].zero_q4_count == b.angle[i].zero_q4_count &&
                a.angle[i].gain_q16 == b.angle[i].gain_q16 &&
                a.angle[i].inverted == b.angle[i].inverted;
    }
    return equal;
}

template <class Value>
bool same(const std::optional<Value>& a, const std::optional<Value>& b) {
    return a.has_value() == b.has_value() && (!a || same(*a, *b));
}

inline bool same(const host_sim::LogStep& a, const host_sim::LogStep& b) {
    return a.time_ms == b.time_ms && a.restart == b.restart && same(a.inputs, b.inputs) &&
           same(a.truth, b.truth) && same(a.estimates, b.estimates) && same(a.commands, b.commands);
}

/// True if both logs say the same; what an absent slot holds says nothing, nor does `unverified`.
inline bool same(const host_sim::Log& a, const host_sim::Log& b) {
    bool equal = a.head.vehicle == b.head.vehicle && same(a.head.calibration, b.head.calibration) &&
                 a.head.image_identity == b.head.image_identity && a.head.notes == b.head.notes &&
                 a.steps.size() == b.steps.size();
    for (std::size_t i = 0; equal && i < a.steps.size(); ++i) equal = same(a.steps[i], b.steps[i]);
    return equal;
}

/// Random logs that use every corner of the model: absent slots with rubbish in them, NaN, extreme
/// numbers, text that needs escapes. A log is a function of its seed.
class LogMaker {
public:
    explicit LogMaker(std::uint64_t seed) : random_(seed) {}

    host_sim::Log make(std::size_t steps) {
        host_sim::Log log;
        log.head.vehicle = text(5);
        log.head.image_identity = chance(2) ? "" : text(1);
        for (std::uint64_t i = pick(4); i > 0; --i) log.head.notes[note_name()] = text(2);
        log.head.calibration.version = number<std::uint16_t>();
        log.head.calibration.wheel_radius_q4_mm = number<std::uint16_t>();
        log.head.calibration.tach_counts_per_turn = number<std::uint16_t>();
        log.head.calibration.tach_q16_mm_per_count = number<std::uint16_t>();
        log.head.calibration.range_offset_q1_mm = number<std::int16_t>();
        for (auto& angle : log.head.calibration.angle) {
            angle = {number<std::uint16_t>(), number<std::uint16_t>(), chance(2)};
        }
        // A sensor may be missing throughout, in some steps, or never.
        adc_absent_ = static_cast<unsigned>(random_());
        sections_ = static_cast<unsigned>(random_());
        std::uint64_t time_ms = pick(3);
        for (std::size_t i = 0; i < steps; ++i) {
            log.steps.push_back(make_step(static_cast<std::uint32_t>(time_ms)));
            time_ms += 1 + pick(chance(50) ? 50'000'000 : 200);
        }
        return log;
    }

private:
    std::uint64_t pick(std::uint64_t below) { return random_() % below; }
    bool chance(std::uint64_t one_in) { return pick(one_in) == 0; }
    template <class Number>
    Number number() {
        if (chance(8)) return std::numeric_limits<Number>::max();
        if (chance(8)) return std::numeric_limits<Number>::min();
        return static_cast<Number>(random_());
    }
    void fill(void* at, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i) {
            static_cast<unsigned char*>(at)[i] = number<std::uint8_t>();
        }
    }
    std::string text(std::uint64_t lines) {
        static constexpr const char* kPieces[] = {"a",
                                                  "wheel = 65",
                                                  " ",
                                                  "\t",
                                                  "\\",
                                                  "\\n",
                                                  "#",
                                                  "=",
                                                  ",",
                                                  "\"",
                                                  "\r",
                                                  "\n",
                                                  "\x01",
                                                  "\x7F",
                                                  "\xC3\xA9",
                                                  "\xE2\x82\xAC",
                                                  "\xF0\x9F\x9A\x80",
                                                  "\xEF\xBB\xBF",
                                                  "# crc32 0",
                                                  "\n\n"};
        std::string out;
        for (std::uint64_t i = pick(6 * lines); i > 0; --i)
            out += kPieces[pick(std::size(kPieces))];
        return out;
    }
    std::string note_name() {
        static constexpr std::string_view kAllowed = "aZ09_.-";
        std::string out(1 + pick(8), 'n');
        for (char& character : out) character = kAllowed[pick(kAllowed.size())];
        return out;
    }
    double real() {
        switch (pick(6)) {
            case 0:
                return std::numeric_limits<double>::quiet_NaN();
            case 1:
                return chance(2) ? 0.0 : -0.0;
            case 2:
                return chance(2) ? std::numeric_limits<double>::denorm_min()
                                 : -std::numeric_limits<double>::max();
            default:
                return std::uniform_real_distribution<double>(-7e4, 7e4)(random_);
        }
    }
    host_sim::LogStep make_step(std::uint32_t time_ms) {
        host_sim::LogStep step;
        step.time_ms = time_ms;
        fill(&step.inputs, sizeof step.inputs);
        step.inputs.command_size = static_cast<std::uint8_t>(pick(hal::kCommandBytesMax + 1));
        for (std::size_t i = 0; i < hal::kAdcChannelCount; ++i) {
            if ((adc_absent_ >> (2 * i) & 1) != 0 || chance(4)) step.inputs.adc_q4_count[i] = 65535;
        }
        if ((adc_absent_ >> 28 & 1) != 0) step.inputs.tach_present &= 0xC5;
        if ((adc_absent_ >> 29 & 1) != 0) step.inputs.range_present = 0;
        if ((adc_absent_ >> 30 & 1) != 0) step.inputs.range_scan_count = 0;
        if ((sections_ & 1) != 0 && !chance(4)) {
            step.truth = {real(), real(), real(), real(), real(), real()};
        }
        if ((sections_ & 2) != 0 && !chance(4)) {
            rover::Estimates& estimates = step.estimates.emplace();
            fill(&estimates, sizeof estimates);
            const auto mode = static_cast<std::uint8_t>(pick(6));
            std::memcpy(&estimates.mode, &mode, 1);
        }
        if ((sections_ & 4) != 0 && !chance(4)) {
            hal::Commands& commands = step.commands.emplace();
            fill(&commands, sizeof commands);
            commands.telemetry_size = static_cast<std::uint8_t>(pick(hal::kTelemetryBytesMax + 1));
        }
        return step;
    }

    std::mt19937_64 random_;
    unsigned adc_absent_ = 0;
    unsigned sections_ = 0;
};

/// A short log with everything in it.
inline host_sim::Log small_log(std::size_t steps = 3) {
    host_sim::Log log;
    log.head.vehicle = "name = \"rocky\"\n";
    log.head.image_identity = "rover85 0.1.0";
    log.head.notes = {{"seed", "7"}, {"terrain", "fractal"}};
    for (std::size_t i = 0; i < steps; ++i) {
        host_sim::LogStep& step = log.steps.emplace_back();
        step.time_ms = static_cast<std::uint32_t>(100 * (i + 1));
        step.inputs.tick_count = static_cast<std::uint16_t>(10 * (i + 1));
        for (auto& count : step.inputs.adc_q4_count) count = hal::kAdcAbsent;
        step.inputs.adc_q4_count[0] = static_cast<std::uint16_t>(32760 + i);
        step.inputs.tach_present = 0x3F;
        for (auto& count : step.inputs.tach_count) count = static_cast<std::uint16_t>(53 * i);
        step.inputs.range_present = 0x03;
        step.inputs.range_scan_count = static_cast<std::uint8_t>(i);
        step.inputs.range_q1_mm[0] = -12;
        step.truth = {5.0 * static_cast<double>(i), 0.25, -0.5, 0.1, 0.0, std::nan("")};
        step.estimates.emplace().position_q4_mm = static_cast<std::int32_t>(80 * i);
        hal::Commands& commands = step.commands.emplace();
        commands.drive_percent[0] = -100;
        commands.telemetry_size = 2;
        commands.telemetry[0] = 0xA5;
        commands.telemetry[1] = 0x5A;
    }
    return log;
}

}  // namespace log_test
