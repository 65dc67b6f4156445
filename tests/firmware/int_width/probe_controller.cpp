// probe_controller.cpp - the whole control step over a pseudo-random drive and over noise: every
// byte of telemetry and every command must be the same.
#include "firmware/executive/controller.hpp"
#include "probe.hpp"

namespace probe {
namespace {

using namespace rover;

void add_commands(const hal::Commands& commands, Checksum& sum) {
    for (const int8_t drive : commands.drive_percent) sum.add(drive);
    sum.add(commands.telemetry_size);
    for (uint8_t i = 0; i < commands.telemetry_size; ++i) sum.add(commands.telemetry[i]);
}

hal::RawInputs level_inputs() {
    hal::RawInputs inputs;
    for (uint16_t& count : inputs.adc_q4_count) count = 32760;
    inputs.tach_present = 63;
    inputs.range_present = 3;
    return inputs;
}

/// Steps of about 2.6 cm with hills, a turn, a way back, a failing sensor and a move by hand.
void check_drive(Inputs& inputs, Checksum& sum) {
    static Controller controller;
    controller_reset(controller, hal::Calibration{});
    hal::RawInputs now = level_inputs();
    int16_t slope = 0;
    for (uint8_t step = 0; step < 200; ++step) {
        now.tick_count = add_wrap(now.tick_count, uint16_t{10});
        now.range_scan_count = add_wrap(now.range_scan_count, uint8_t{1});
        const uint16_t pulses = bit_and(inputs.next<uint16_t>(), uint16_t{7});
        for (uint8_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
            const bool back = (step >= 140 && step < 155) || (step >= 160 && wheel % 2 == 0);
            const uint16_t rolled = add_wrap(pulses, uint16_t{120});
            now.tach_count[wheel] = back ? sub_wrap(now.tach_count[wheel], rolled)
                                         : add_wrap(now.tach_count[wheel], rolled);
            if (step >= 180) now.tach_count[wheel] = 0;
        }
        slope = add_wrap(slope, shift_floor<7>(inputs.next<int16_t>()));
        for (uint8_t i = 0; i < hal::kAngleChannelCount; ++i) {
            const int16_t bump = shift_floor<6>(inputs.next<int16_t>());
            now.adc_q4_count[i] = narrow_wrap_u16(
                add_wrap(int32_t{32760}, add_wrap(widen_s32(slope), widen_s32(bump))));
        }
        if (step >= 100 && step < 120) now.adc_q4_count[0] = hal::kAdcAbsent;
        now.range_q1_mm[0] = shift_floor<9>(inputs.next<int16_t>());
        now.range_q1_mm[1] = shift_floor<9>(inputs.next<int16_t>());
        add_commands(controller_step(controller, now), sum);
    }
}

void check_noise(Inputs& inputs, Checksum& sum) {
    static Controller controller;
    hal::Calibration calibration;
    for (hal::AngleCalibration& angle : calibration.angle) {
        angle.zero_q4_count = inputs.next<uint16_t>();
        angle.gain_q16 = inputs.next<uint16_t>();
        angle.inverted = bit_and(inputs.next<uint8_t>(), uint8_t{1}) != 0;
    }
    calibration.wheel_radius_q4_mm = inputs.next<uint16_t>();
    calibration.tach_q16_mm_per_count = inputs.next<uint16_t>();
    calibration.range_offset_q1_mm = inputs.next<int16_t>();
    controller_reset(controller, calibration);
    hal::RawInputs now;
    for (uint8_t step = 0; step < 60; ++step) {
        now.tick_count = inputs.next<uint16_t>();
        for (uint16_t& count : now.adc_q4_count) count = inputs.next<uint16_t>();
        for (uint16_t& count : now.tach_count) count = inputs.next<uint16_t>();
        now.tach_present = inputs.next<uint8_t>();
        now.range_present = inputs.next<uint8_t>();
        now.range_scan_count = inputs.next<uint8_t>();
        for (int16_t& range : now.range_q1_mm) range = inputs.next<int16_t>();
        add_commands(controller_step(controller, now), sum);
    }
}

}  // namespace

void run_controller_groups() {
    run("controller_drive", 1, check_drive);
    run("controller_noise", 6, check_noise);
}

}  // namespace probe
