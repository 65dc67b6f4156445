// calibration.hpp - the calibration record: what turns raw counts into physical units.
// Depends on   hal/io.hpp.
// Kept         in battery-backed RAM on the vehicle; recorded in the head of every log.
// Written by   `rover85 calibrate`; checked by is_valid() before the controller uses it.
#pragma once

#include "hal/io.hpp"

namespace hal {

/// One potentiometer or inclinometer axis:
/// angle_brad = (adc_q4_count - zero_q4_count) * gain_q16 / 2^16, ties away from zero.
struct AngleCalibration {
    uint16_t zero_q4_count = 32760;  ///< Q4 counts at angle zero
    uint16_t gain_q16 = 16384;       ///< u16 Q16 brad per Q4 count; 0 means "not calibrated"
    bool inverted = false;           ///< true: more counts are a smaller angle
};

/// Channels that carry an angle, in the order of Calibration::angle.
enum class AngleChannel : uint8_t { bogie_left, bogie_right, differential, pitch, roll };
inline constexpr uint8_t kAngleChannelCount = 5;

/// Nominal gains: +-45 deg over the converter's 65536 Q4 counts, and +-75 deg.
inline constexpr uint16_t kPotentiometerGainQ16 = 16384;  // 90 deg / 65536 counts in brad, Q16
inline constexpr uint16_t kInclinometerGainQ16 = 27307;   // 150 deg / 65536 counts in brad, Q16

inline constexpr uint16_t kCalibrationVersion = 1;

struct Calibration {
    uint16_t version = kCalibrationVersion;
    AngleCalibration angle[kAngleChannelCount] = {
        {32760, kPotentiometerGainQ16, false}, {32760, kPotentiometerGainQ16, false},
        {32760, kPotentiometerGainQ16, false}, {32760, kInclinometerGainQ16, false},
        {32760, kInclinometerGainQ16, false},
    };
    uint16_t wheel_radius_q4_mm = 1040;      ///< u16 Q4 mm: 65 mm (Rocky 3.2: 13 cm wheels)
    uint16_t tach_counts_per_turn = 2000;    ///< tachometer pulses per wheel turn, [1, 65535]
    uint16_t tach_q16_mm_per_count = 13383;  ///< u16 Q16 mm of rim travel per pulse
    int16_t range_offset_q1_mm = 0;          ///< s16 Q1 mm, subtracted from every range sample
};

}  // namespace hal
