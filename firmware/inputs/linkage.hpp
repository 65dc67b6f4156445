// linkage.hpp - kinematics of one side of the rocker-bogie: angles to heights and distances.
// Depends on   config/vehicle.hpp, core/sine.hpp, inputs/angles.hpp.
// Source       docs/design/controller.md, "Kinematics": z(1), z(2) from rocker and bogie angle,
//              z(3) ... from the range samples in the body frame.
// Bounds       four sines and cosines per step, two more and four products per range sample.
#pragma once

#include "firmware/config/vehicle.hpp"
#include "firmware/core/sine.hpp"
#include "firmware/inputs/angles.hpp"

namespace rover {

enum class Side : uint8_t { none, left, right };

/// Heights and distances of the contacts of one side, relative to the rear contact.
struct LinkagePose {
    Side side = Side::none;   ///< none: the sensors that it needs are not there
    int16_t rocker_brad = 0;  ///< against the horizon, nose up positive
    int16_t bogie_brad = 0;
    int16_t middle_height_q4_mm = 0;  ///< z(1)
    int16_t front_height_q4_mm = 0;   ///< z(2)
    uint16_t middle_distance_q6_bin = 0;
    uint16_t front_distance_q6_bin = 0;
};

/// a * b + c * d for a length and a Q15 ratio each, rounded half up.
constexpr int16_t sum_of_products_q15(uint16_t a, int16_t b_q15, uint16_t c, int16_t d_q15) {
    return narrow_sat_s16(
        shift_round_half_up<15>(add_wrap(mul_wide(a, b_q15), mul_wide(c, d_q15))));
}

/// Pose of the left side; of the right one when the left bogie's potentiometer is not valid.
constexpr LinkagePose linkage_pose(const Angles& angles) {
    LinkagePose pose;
    const AngleReading& pitch = angles[hal::AngleChannel::pitch];
    const AngleReading& differential = angles[hal::AngleChannel::differential];
    const AngleReading& left = angles[hal::AngleChannel::bogie_left];
    const AngleReading& right = angles[hal::AngleChannel::bogie_right];
    if (!pitch.valid || !differential.valid || (!left.valid && !right.valid)) return pose;
    pose.side = left.valid ? Side::left : Side::right;
    pose.rocker_brad = left.valid ? add_wrap(pitch.brad, differential.brad)
                                  : sub_wrap(pitch.brad, differential.brad);
    pose.bogie_brad = add_wrap(pose.rocker_brad, left.valid ? left.brad : right.brad);
    const int16_t rocker_sine = sine_q15(pose.rocker_brad);
    const int16_t rocker_cosine = cosine_q15(pose.rocker_brad);
    const int16_t bogie_sine = sine_q15(pose.bogie_brad);
    const int16_t bogie_cosine = cosine_q15(pose.bogie_brad);
    using namespace vehicle;
    pose.middle_height_q4_mm =
        sum_of_products_q15(kRockerQ4Mm, rocker_sine, kBogieArmQ4Mm, neg_wrap(bogie_sine));
    pose.front_height_q4_mm =
        sum_of_products_q15(kRockerQ4Mm, rocker_sine, kBogieArmQ4Mm, bogie_sine);
    pose.middle_distance_q6_bin = narrow_sat_u16(
        sum_of_products_q15(kRockerQ6Bin, rocker_cosine, kBogieArmQ6Bin, neg_wrap(bogie_cosine)));
    pose.front_distance_q6_bin = narrow_sat_u16(
        sum_of_products_q15(kRockerQ6Bin, rocker_cosine, kBogieArmQ6Bin, bogie_cosine));
    return pose;
}

/// A point of ground ahead, relative to the rear contact.
struct GroundPoint {
    int16_t height_q4_mm = 0;
    uint16_t distance_q6_bin = 0;
};

/// Range sample `index` turned from the body frame into the frame of the rear contact.
/// @param range_q1_mm       s16 Q1 mm, offset already taken off; level ground reads 0
/// @param wheel_radius_q4_mm  the sensor's zero is one wheel radius below axle height
constexpr GroundPoint ground_point(const LinkagePose& pose, int16_t pitch_brad, uint8_t index,
                                   int16_t range_q1_mm, uint16_t wheel_radius_q4_mm) {
    using namespace vehicle;
    const int16_t pitch_sine = sine_q15(pitch_brad);
    const int16_t pitch_cosine = cosine_q15(pitch_brad);
    const int16_t radius_q4_mm = narrow_sat_s16(wheel_radius_q4_mm);
    const int16_t below_q4_mm = sub_sat(shift_left_sat<3>(range_q1_mm), radius_q4_mm);
    const int32_t up_q19 =
        add_sat(add_wrap(mul_wide(kBodyReferenceQ4Mm, sine_q15(pose.rocker_brad)),
                         mul_wide(kLookAheadQ4Mm[index], pitch_sine)),
                mul_wide(below_q4_mm, pitch_cosine));
    const int32_t along_q19 =
        sub_sat(add_wrap(mul_wide(kBodyReferenceQ4Mm, cosine_q15(pose.rocker_brad)),
                         mul_wide(kLookAheadQ4Mm[index], pitch_cosine)),
                mul_wide(below_q4_mm, pitch_sine));
    GroundPoint point;
    point.height_q4_mm = add_sat(narrow_sat_s16(shift_round_half_up<15>(up_q19)), radius_q4_mm);
    // mm Q4 to 1/64 bin: times 4/25.
    const uint16_t along_q4_mm = narrow_sat_u16(shift_round_half_up<15>(along_q19));
    point.distance_q6_bin =
        div_round_sat_u16(shift_left_wrap<2>(widen_u32(along_q4_mm)), uint16_t{25});
    return point;
}

}  // namespace rover
