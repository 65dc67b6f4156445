// motor_commands.hpp - Commands to the latches of the drive motors.
// Depends on   hal/io.hpp, core/arith.hpp; the board's parts as a template argument.
// Not here     steering and mast: servo_loops.hpp.
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/motor_commands_test.cpp
#pragma once

#include "firmware/core/arith.hpp"
#include "hal/io.hpp"

namespace rover {

/// Duty of 255 for a speed of 100 percent: |percent| 255/100 rounded to nearest, half up. Beyond
/// 100 it is 255.
[[gnu::noinline]] constexpr uint8_t drive_duty(int8_t percent) {
    const uint8_t size = min(abs_u8(percent), uint8_t{100});
    // 2.55 is 2 and 563/1024; 530 instead of 512 makes halves go up. 563 is 512 and 51, and 512 is
    // 2 in the upper byte. Exact for all 101 values.
    const uint16_t scaled = add_wrap(mul_wrap(widen_u16(size), uint16_t{51}), uint16_t{530});
    const uint8_t twice = shift_left_wrap<1>(size);
    const uint8_t upper = add_wrap(narrow_wrap_u8(shift_floor<8>(scaled)), twice);
    return add_wrap(twice, shift_floor<2>(upper));
}

/// What the drive latches are to hold.
struct DriveLatches {
    uint8_t duty[hal::kWheelCount];
    uint8_t backward;  ///< bit w: wheel w
};

/// Is no wheel to turn backward?
constexpr bool is_all_ahead(const int8_t (&percent)[hal::kWheelCount]) {
    uint8_t bits = 0;
    bits = bit_or(bits, narrow_wrap_u8(percent[0]));
    bits = bit_or(bits, narrow_wrap_u8(percent[1]));
    bits = bit_or(bits, narrow_wrap_u8(percent[2]));
    bits = bit_or(bits, narrow_wrap_u8(percent[3]));
    bits = bit_or(bits, narrow_wrap_u8(percent[4]));
    bits = bit_or(bits, narrow_wrap_u8(percent[5]));
    return bits < 0x80;
}

/// Equal neighbours, the usual case, are computed once.
constexpr void drive_latches(const hal::Commands& commands, DriveLatches& latches) {
    const int8_t* percent = commands.drive_percent;
    uint8_t* to = latches.duty;
    uint8_t duty = drive_duty(*percent);
    *to++ = duty;
    for (uint8_t left = hal::kWheelCount - 1; left != 0; --left) {
        const int8_t last = *percent++;
        if (*percent != last) duty = drive_duty(*percent);
        *to++ = duty;
    }
    latches.backward = 0;
    if (is_all_ahead(commands.drive_percent)) return;
    uint8_t wheel_bit = 1;
    for (const int8_t each : commands.drive_percent) {
        if (each < 0) latches.backward = bit_or(latches.backward, wheel_bit);
        wheel_bit = shift_left_wrap<1>(wheel_bit);
    }
}

}  // namespace rover
