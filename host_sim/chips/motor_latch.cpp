// motor_latch.cpp - motor latches.
#include "host_sim/chips/motor_latch.hpp"

#include <fmt/format.h>

namespace host_sim::chips {

void MotorLatch::reset() {
    duties.fill(0);
    drive_directions = 0;
    steer_directions = 0;
}

uint8_t MotorLatch::read(uint16_t /*address*/, uint64_t /*now_t*/) {
    ++read_count;
    return kOpenBus;
}

void MotorLatch::write(uint16_t address, uint8_t value, uint64_t /*now_t*/) {
    const unsigned index = address & 0x0Fu;
    if (motors_off) {
        ++cleared_write_count;
    } else if (index < kMotorCount) {
        duties[index] = value;
    } else if (index == kDriveDirectionAddress) {
        set_directions(drive_directions, value, 0, kDriveCount);
    } else if (index == kSteerDirectionAddress) {
        set_directions(steer_directions, value, kDriveCount, kSteerCount);
    } else {
        ++unmapped_write_count;
    }
}

void MotorLatch::set_directions(uint8_t& directions, uint8_t value, unsigned first_motor,
                                unsigned count) {
    const unsigned changed = unsigned{directions} ^ value;
    for (unsigned i = 0; i < count; ++i) {
        if ((changed >> i & 1) != 0 && duties[first_motor + i] != 0) ++reversal_count;
    }
    directions = static_cast<uint8_t>(value & ((1u << count) - 1));
}

void MotorLatch::set_motors_off(bool active) {
    motors_off = active;
    if (active) reset();
}

int16_t MotorLatch::duty(unsigned motor) const {
    const bool reverse = motor < kDriveCount ? (drive_directions >> motor & 1) != 0
                                             : (steer_directions >> (motor - kDriveCount) & 1) != 0;
    const int16_t magnitude = duties.at(motor);
    return reverse ? static_cast<int16_t>(-magnitude) : magnitude;
}

Properties MotorLatch::properties() const {
    Properties all;
    for (unsigned motor = 0; motor < kMotorCount; ++motor) {
        const bool drives = motor < kDriveCount;
        all.push_back({fmt::format("{} motor {}", drives ? "drive" : "steering",
                                   drives ? motor : motor - kDriveCount),
                       fmt::format("{}/255", duty(motor))});
    }
    all.push_back({"clear line", motors_off ? "active" : "inactive"});
    all.push_back({"reads of write-only latches", fmt::format("{}", read_count)});
    all.push_back({"writes lost while cleared", fmt::format("{}", cleared_write_count)});
    all.push_back({"writes to no latch", fmt::format("{}", unmapped_write_count)});
    all.push_back({"reversals under power", fmt::format("{}", reversal_count)});
    return all;
}

}  // namespace host_sim::chips
