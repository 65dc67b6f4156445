// motor_latch.hpp - ten 8-bit duty latches and direction bits of the drive and steering motors.
// Source       own circuit: twelve write-only 8-bit latches with a common clear, each duty feeding
// a
//              hardware PWM comparator.
// Depends on   host_sim/chips/chip.hpp.
// Not modelled PWM frequency, motor and gear (host_sim/world turns duty into motion).
// Page         docs/chips/motor-latch.md
#pragma once

#include <array>
#include <cstdint>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

struct MotorLatch {
    static constexpr unsigned kDriveCount = 6;  ///< motors 0 to 5, in the order of hal::Wheel
    static constexpr unsigned kSteerCount =
        4;  ///< motors 6 to 9: front left, right, rear left, right
    static constexpr unsigned kMotorCount = kDriveCount + kSteerCount;

    static constexpr uint16_t kDutyAddress = 0;             ///< 0 to 9: duty in 1/255
    static constexpr uint16_t kDriveDirectionAddress = 10;  ///< bit i reverses motor i
    static constexpr uint16_t kSteerDirectionAddress = 11;  ///< bit i reverses motor 6 + i

    /// The RESET pin clears all latches: every motor off.
    void reset();
    /// The latches are write-only: nothing drives the bus.
    uint8_t read(uint16_t address, uint64_t now_t);
    /// @param address  bits 3 to 0 count
    void write(uint16_t address, uint8_t value, uint64_t now_t);
    void advance(uint64_t /*now_t*/) {}
    [[nodiscard]] uint64_t next_event_t() const { return kNever; }

    /// The clear line, driven by the watchdog: while active all latches are 0 and writes are lost.
    void set_motors_off(bool active);
    /// Signed duty of a motor, [-255, 255]; negative is reverse, or right for steering.
    /// @param motor  [0, kMotorCount)
    [[nodiscard]] int16_t duty(unsigned motor) const;
    [[nodiscard]] Properties properties() const;

    std::array<uint8_t, kMotorCount> duties{};
    uint8_t drive_directions = 0;
    uint8_t steer_directions = 0;
    bool motors_off = false;

    uint64_t read_count = 0;            ///< reads of a write-only address
    uint64_t cleared_write_count = 0;   ///< writes lost while the clear line was active
    uint64_t unmapped_write_count = 0;  ///< writes to addresses 12 to 15
    uint64_t reversal_count = 0;        ///< direction bits changed under a duty other than 0

    bool operator==(const MotorLatch&) const = default;

private:
    void set_directions(uint8_t& directions, uint8_t value, unsigned first_motor, unsigned count);
};

}  // namespace host_sim::chips
