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

constexpr const uint8_t* get_word(const uint8_t* bytes, uint16_t& word) {
    const uint8_t low = *bytes++;
    const uint8_t high = *bytes++;
    word = bit_or(widen_u16(low), shift_left_wrap<8>(widen_u16(high)));
    return bytes;
}
constexpr uint8_t* put_word(uint8_t* bytes, uint16_t word) {
    *bytes++ = narrow_wrap_u8(word);
    *bytes++ = narrow_wrap_u8(shift_floor<8>(word));
    return bytes;
}

}  // namespace link

/// Reads a record. Any bytes give a defined one; is_valid() says whether it can be used.
constexpr void read_calibration(const uint8_t (&bytes)[kCalibrationBytes],
                                hal::Calibration& calibration) {
    const uint8_t* next = link::get_word(bytes, calibration.version);
    for (hal::AngleCalibration& angle : calibration.angle) {
        next = link::get_word(next, angle.zero_q4_count);
        next = link::get_word(next, angle.gain_q16);
        angle.inverted = *next++ != 0;
    }
    next = link::get_word(next, calibration.wheel_radius_q4_mm);
    next = link::get_word(next, calibration.tach_counts_per_turn);
    next = link::get_word(next, calibration.tach_q16_mm_per_count);
    uint16_t offset_q1_mm = 0;
    link::get_word(next, offset_q1_mm);
    calibration.range_offset_q1_mm = narrow_wrap_s16(offset_q1_mm);
}

/// The same, written.
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
