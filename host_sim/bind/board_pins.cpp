// board_pins.cpp - see board_pins.hpp.
#include "host_sim/bind/board_pins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "firmware/config/board_inputs.hpp"

namespace host_sim {

namespace rb85 = hal::rb85;

namespace {

/// The percentage whose duty this is: 255/100 of it, rounded to nearest, halves up.
std::optional<int8_t> percent_of_duty(int duty) {
    const int size = duty < 0 ? -duty : duty;
    const int percent = (100 * size + 127) / 255;
    if ((255 * percent + 50) / 100 != size) return {};
    return static_cast<int8_t>(duty < 0 ? -percent : percent);
}

}  // namespace

uint64_t next_tick_t(const Board& board) {
    const chips::I82c54& timer = board.state.timers[0];
    const uint64_t change_t = timer.next_event_t();
    return timer.output(rb85::kTickCounter) ? change_t + 1 : change_t;  // low for one clock
}

// -- In
// ------------------------------------------------------------------------------------------

void unplug_sensors(Board& board) {
    for (uint8_t channel = 0; channel < hal::kAdcChannelCount; ++channel) {
        board.replay_sensor(channel, hal::kAdcAbsent);
    }
}

void InputPins::set_levels(Board& board, const hal::RawInputs& inputs) {
    const uint64_t t = board.state.cpu.t;
    for (uint8_t channel = 0; channel < rover::kSampledChannelCount; ++channel) {
        const uint16_t sum = inputs.adc_q4_count[channel];
        if (sum == sums_[channel]) continue;
        sums_[channel] = sum;
        board.replay_sensor(channel, sum);
    }
    for (uint8_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        board.schedule(
            {t, Stimulus::Kind::tach_connected, wheel, inputs.tach_present >> wheel & 1});
    }
    board.schedule({t, Stimulus::Kind::detectors, 0, inputs.detector_bits});
    if (inputs.range_present != 0 || inputs.range_scan_count != 0) range_seen_ = true;
    board.set_range_connected(range_seen_);
    chips::RangeModule::Heights heights{};
    std::copy(std::begin(inputs.range_q1_mm), std::end(inputs.range_q1_mm), heights.begin());
    board.replay_range_scan(inputs.range_scan_count, inputs.range_present, heights);
}

void InputPins::turn_wheels(Board& board, const hal::RawInputs& inputs) const {
    for (uint8_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        const auto pulses = static_cast<int16_t>(inputs.tach_count[wheel] - tach_count_[wheel]);
        board.turn_wheel(wheel, pulses);
    }
}

void InputPins::set_counts(const hal::RawInputs& inputs) {
    std::copy(std::begin(inputs.tach_count), std::end(inputs.tach_count), tach_count_.begin());
}

// -- Out
// -----------------------------------------------------------------------------------------

hal::Commands commands_of(const Board& board) {
    hal::Commands commands;
    const chips::MotorLatch& motors = board.state.motors;
    for (unsigned wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        const auto percent = percent_of_duty(motors.duty(wheel));
        if (!percent) {
            throw std::range_error(
                fmt::format("duty {} of drive motor {} stands for no whole percentage",
                            motors.duty(wheel), wheel));
        }
        commands.drive_percent[wheel] = *percent;
    }
    for (unsigned motor = 0; motor < hal::kSteerCount; ++motor) {
        commands.steer_brad[motor] = motors.duty(hal::kWheelCount + motor);
    }
    const chips::I82c55a& ppi = board.state.ppis[0];
    const unsigned driven =
        ppi.port_output(chips::I82c55a::Port::c) & ppi.port_output_mask(chips::I82c55a::Port::c);
    commands.laser_bits = static_cast<uint8_t>(driven & rb85::kLaserMask);
    if ((driven & rb85::kMastOnBit) != 0) {
        commands.mast_brad = (driven & rb85::kMastLeftBit) != 0 ? 1 : -1;
    }
    return commands;
}

}  // namespace host_sim
