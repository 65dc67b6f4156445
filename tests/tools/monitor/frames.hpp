// frames.hpp - frames from a rover, made by hand for the monitor's tests. The check is computed
// bit by bit, apart from the code under test.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/executive/estimates.hpp"
#include "firmware/link/telemetry.hpp"

namespace monitor_test {

using Bytes = std::vector<uint8_t>;

/// CRC-16/CCITT-FALSE (docs/spec/telemetry.md).
inline uint16_t crc_of(const Bytes& bytes) {
    unsigned crc = 0xFFFF;
    for (const uint8_t byte : bytes) {
        for (int bit = 7; bit >= 0; --bit) {
            const bool one = ((crc >> 15) ^ (byte >> bit & 1U)) != 0;
            crc = (crc << 1 & 0xFFFFU) ^ (one ? 0x1021U : 0U);
        }
    }
    return static_cast<uint16_t>(crc);
}

inline Bytes frame(uint8_t kind, const Bytes& payload) {
    Bytes checked = {kind, static_cast<uint8_t>(payload.size())};
    for (const uint8_t byte : payload) checked.push_back(byte);
    Bytes bytes = {0xA5, 0x5A};
    for (const uint8_t byte : checked) bytes.push_back(byte);
    const uint16_t crc = crc_of(checked);
    bytes.push_back(static_cast<uint8_t>(crc & 0xFF));
    bytes.push_back(static_cast<uint8_t>(crc >> 8));
    return bytes;
}

inline Bytes telemetry(const rover::Estimates& estimates) {
    uint8_t bytes[hal::kTelemetryBytesMax] = {};
    const uint8_t size = rover::write_telemetry(estimates, bytes);
    return {bytes, bytes + size};
}

/// The telemetry frame of a step, everything else in it zero but for the odometer.
inline Bytes telemetry(uint16_t step, int32_t odometer_q4_mm = 0) {
    rover::Estimates estimates;
    estimates.step_count = step;
    estimates.tick_count = static_cast<uint16_t>(10 * step);
    estimates.odometer_q4_mm = odometer_q4_mm;
    return telemetry(estimates);
}

/// docs/spec/link.md: version 1.2.3, hash 89ABCDEFH, 4660 bytes, CRC BEEFH, "Rocky3.2".
inline Bytes identity() {
    return frame(0x80, {1,    1,    2,   3,   0xEF, 0xCD, 0xAB, 0x89, 0x34, 0x12,
                        0xEF, 0xBE, 'R', 'o', 'c',  'k',  'y',  '3',  '.',  '2'});
}

/// Faults 0240H, the run before 0004H, reset 7, late 1, left out 2, received 300, dropped 3, errors
/// 4, frames left out 5, refused 6, traps 8, watchdog, warm.
inline Bytes status() {
    return frame(0x81,
                 {0x40, 0x02, 0x04, 0, 7, 0, 1, 0, 2, 0, 0x2C, 0x01, 3, 0, 4, 0, 5, 0, 6, 8, 1, 1});
}

}  // namespace monitor_test
