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
    // 2.55 is 2 and 563/1024; 530 instead of 512 makes halves go up. 563 is 512 and 51, that is 3
    // times 17, and 512 is 2 in the upper byte. Exact for all 101 values.
    const uint16_t three = add_wrap(shift_left_wrap<1>(widen_u16(size)), widen_u16(size));
    const uint16_t scaled = add_wrap(add_wrap(shift_left_wrap<4>(three), three), uint16_t{530});
    const uint8_t twice = shift_left_wrap<1>(size);
    const uint8_t upper = add_wrap(narrow_wrap_u8(shift_floor<8>(scaled)), twice);
    return add_wrap(twice, shift_floor<2>(upper));
}

inline constexpr uint8_t kAllWheels = (1u << hal::kWheelCount) - 1u;

/// Is every wheel to turn alike? That is the usual case.
constexpr bool is_straight(const int8_t (&percent)[hal::kWheelCount]) {
    const int8_t* next = percent;
    uint8_t differs = 0;
    for (uint8_t left = hal::kWheelCount - 1; left != 0; --left) {
        differs = bit_or(differs, sub_wrap(narrow_wrap_u8(*++next), narrow_wrap_u8(percent[0])));
    }
    return differs == 0;
}

/// @return  bit w: wheel w is to turn backward
constexpr uint8_t backward_wheels(const int8_t (&percent)[hal::kWheelCount]) {
    const int8_t* next = percent + hal::kWheelCount;
    uint8_t backward = 0;
    for (uint8_t left = hal::kWheelCount; left != 0; --left) {
        backward = shift_left_wrap<1>(backward);
        if (*--next < 0) backward = bit_or(backward, uint8_t{1});
    }
    return backward;
}

/// Puts drive commands into the latches.
/// @tparam Motors  MotorLatch
template <class Motors>
void drive_motors(const int8_t (&percent)[hal::kWheelCount]) {
    if (is_straight(percent)) {
        Motors::direct_drive(percent[0] < 0 ? kAllWheels : uint8_t{0});
        Motors::put_drive(drive_duty(percent[0]));
        return;
    }
    Motors::direct_drive(backward_wheels(percent));
    Motors::template put_drive<0>(drive_duty(percent[0]));
    Motors::template put_drive<1>(drive_duty(percent[1]));
    Motors::template put_drive<2>(drive_duty(percent[2]));
    Motors::template put_drive<3>(drive_duty(percent[3]));
    Motors::template put_drive<4>(drive_duty(percent[4]));
    Motors::template put_drive<5>(drive_duty(percent[5]));
}

}  // namespace rover
