// rover_bench.hpp - a rover on a bench for the executive's tests: wheels, angles and look-ahead are
// set by hand, a step at a time.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "firmware/executive/controller.hpp"

namespace test {

struct RoverBench {
    rover::Controller controller;
    hal::RawInputs inputs;
    hal::Commands commands;
    std::array<double, hal::kWheelCount> travel_mm = {};
    int steps = 0;

    explicit RoverBench(const hal::Calibration& calibration = {}) {
        rover::controller_reset(controller, calibration);
        for (std::uint16_t& count : inputs.adc_q4_count) count = hal::kAdcAbsent;
        for (std::uint8_t i = 0; i < hal::kAngleChannelCount; ++i) adc(i) = 32760;
        inputs.tach_present = 63;
        inputs.range_present = 3;
    }

    std::uint16_t& adc(std::size_t channel) {
        return inputs.adc_q4_count[static_cast<std::size_t>(channel)];
    }
    std::uint16_t& adc(hal::AngleChannel channel) { return adc(static_cast<std::size_t>(channel)); }

    [[nodiscard]] const rover::Estimates& estimates() const { return controller.estimates; }
    [[nodiscard]] bool has(rover::Event event) const { return (estimates().events & event) != 0; }
    [[nodiscard]] bool has(rover::Available bit) const {
        return (estimates().available & bit) != 0;
    }
    [[nodiscard]] bool has(rover::Fault fault) const { return (estimates().faults & fault) != 0; }
    [[nodiscard]] double position_mm() const { return estimates().position_q4_mm / 16.0; }
    [[nodiscard]] double odometer_mm() const { return estimates().odometer_q4_mm / 16.0; }

    /// One step with the inputs as they are.
    void step() {
        commands = rover::controller_step(controller, inputs);
        inputs.tick_count = static_cast<std::uint16_t>(inputs.tick_count + 10);
        ++inputs.range_scan_count;
        ++steps;
    }
    /// One step in which the sides roll so far, on level ground with a little noise.
    void roll(double left_mm, double right_mm) {
        for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
            travel_mm[wheel] += wheel % 2 == 0 ? left_mm : right_mm;
            const double pulses = std::floor(travel_mm[wheel] * 65536 / 13383 + 1e-6);
            inputs.tach_count[wheel] =
                static_cast<std::uint16_t>(static_cast<std::int64_t>(pulses) & 0xFFFF);
        }
        step();
    }
    void roll(double mm) { roll(mm, mm); }
    /// Steps of 1 mm; returns the number of cycles.
    int drive(int millimetres, double step_mm = 1.0) {
        int cycles = 0;
        for (int i = 0; i < millimetres; ++i) {
            dither();
            roll(step_mm);
            cycles += has(rover::kEventCycle) ? 1 : 0;
        }
        return cycles;
    }
    /// At rest until the begun cycle, if there is one, is complete.
    void finish_cycle() {
        while (controller.stage != rover::CycleStage::none) roll(0);
    }
    /// A little converter noise on every angle that is near the middle, other in every cycle.
    void dither() {
        for (std::size_t i = 0; i < hal::kAngleChannelCount; ++i) {
            if (adc(i) < 32757 || adc(i) > 32763) continue;
            adc(i) = static_cast<std::uint16_t>(32757 + steps % 7);
        }
    }
};

}  // namespace test
