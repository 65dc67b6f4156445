// motor_latch.hpp - driver of the motor latches: duty and direction of drive and steering motors.
// Depends on   hal/io.hpp (how many). Bus: docs/design/hal.md
// Reset        RESET clears the latches, start-up the copy of the direction bits here.
// Page         docs/chips/motor-latch.md
#pragma once

#include <stdint.h>

#include "hal/io.hpp"

namespace hal {

/// @tparam kPort  duty of the first drive motor; the others, four steering motors and two direction
///                registers follow
template <class Bus, uint8_t kPort>
struct MotorLatch {
    static constexpr uint8_t kSteer = kPort + kWheelCount;
    static constexpr uint8_t kDriveSign = kSteer + kSteerCount;
    static constexpr uint8_t kSteerSign = kDriveSign + 1;

    /// Sets the directions of the drive motors, in front of their duties. If one changes, all six
    /// have no power while it does and until they are set anew, so no bridge reverses under power.
    /// @param backward  bit w: motor w runs backward
    [[gnu::noinline]] static void direct_drive(uint8_t backward) {
        if (backward == backward_) return;
        put_drive(0);
        Bus::template out<kDriveSign>(backward);
        backward_ = backward;
    }

    /// Sets all drive motors. @param duty  of 255
    [[gnu::noinline]] static void put_drive(uint8_t duty) {
        Bus::template out<kPort>(duty);
        Bus::template out<kPort + 1>(duty);
        Bus::template out<kPort + 2>(duty);
        Bus::template out<kPort + 3>(duty);
        Bus::template out<kPort + 4>(duty);
        Bus::template out<kPort + 5>(duty);
    }
    /// Sets one drive motor, in the order of hal::Wheel.
    template <uint8_t kMotor>
    static void put_drive(uint8_t duty) {
        static_assert(kMotor < kWheelCount);
        Bus::template out<kPort + kMotor>(duty);
    }

    /// Both for all drive motors. @param duty  of 255, in the order of hal::Wheel
    static void drive(const uint8_t (&duty)[kWheelCount], uint8_t backward) {
        direct_drive(backward);
        put_drive<0>(duty[0]);
        put_drive<1>(duty[1]);
        put_drive<2>(duty[2]);
        put_drive<3>(duty[3]);
        put_drive<4>(duty[4]);
        put_drive<5>(duty[5]);
    }

    /// Sets the steering motors.
    /// @param duty   of 255
    /// @param right  bit s: motor s turns to the right
    /// @pre  a motor whose direction changes has duty 0, so no bridge reverses under power
    static void steer(const uint8_t (&duty)[kSteerCount], uint8_t right) {
        Bus::template out<kSteer>(duty[0]);
        Bus::template out<kSteer + 1>(duty[1]);
        Bus::template out<kSteer + 2>(duty[2]);
        Bus::template out<kSteer + 3>(duty[3]);
        Bus::template out<kSteerSign>(right);
    }

    /// All ten motors without power, all directions as after RESET.
    static void all_off() {
        put_drive(0);
        stop_steer();
        Bus::template out<kDriveSign>(0);
        Bus::template out<kSteerSign>(0);
        backward_ = 0;
    }

private:
    static void stop_steer() {
        Bus::template out<kSteer>(0);
        Bus::template out<kSteer + 1>(0);
        Bus::template out<kSteer + 2>(0);
        Bus::template out<kSteer + 3>(0);
    }

    static inline volatile uint8_t backward_ = 0;  ///< the direction register: it cannot be read
};

}  // namespace hal
