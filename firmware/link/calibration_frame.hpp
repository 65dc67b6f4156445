// calibration_frame.hpp - the calibration record as bytes: payload of a frame, and as it is stored.
// Depends on   hal/calibration.hpp, core/arith.hpp.
// Format       docs/spec/link.md (normative): the members in order, words low byte first, one byte
//              for `inverted`.
// Tests        tests/firmware/link/calibration_frame_test.cpp
#pragma once

#include "firmware/core/arith.hpp"
#include "hal/calibration.hpp"

namespace rover {

inline constexpr uint8_t kCalibrationBytes = 2 + 5 * hal::kAngleChannelCount + 8;

namespace link {

constexpr uint8_t* put_word(uint8_t* bytes, uint16_t word) {
    *bytes++ = narrow_wrap_u8(word);
    *bytes++ = narrow_wrap_u8(shift_floor<8>(word));
    return bytes;
}

}  // namespace link

/// Writes a record. The image itself reads it as it stands: there a struct has these bytes.
constexpr void write_calibration(const hal::Calibration& calibration,
                                 uint8_t (&bytes)[kCalibrationBytes]) {
    uint8_t* next = link::put_word(bytes, calibration.version);
    for (const hal::AngleCalibration& angle : calibration.angle) {
        next = link::put_word(next, angle.zero_q4_count);
        next = link::put_word(next, angle.gain_q16);
        *next++ = angle.inverted ? 1 : 0;
    }
    next = link::put_word(next, calibration.wheel_radius_q4_mm);
    next = link::put_word(next, calibration.tach_counts_per_turn);
    next = link::put_word(next, calibration.tach_q16_mm_per_count);
    link::put_word(next, narrow_wrap_u16(calibration.range_offset_q1_mm));
}

}  // namespace rover
