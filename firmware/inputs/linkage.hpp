// linkage.hpp - kinematics of one side of the rocker-bogie: angles to heights and distances.
// Depends on   config/vehicle.hpp, core/sine.hpp, inputs/angles.hpp.
// Source       docs/design/controller.md, "Kinematics": z(1), z(2) from rocker and bogie angle,
//              z(3) ... from the range samples in the body frame.
// Bounds       two sines per step; in a cycle four more, and four products per range sample.
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
    int16_t rocker_sine_q15 = 0;
    int16_t rocker_cosine_q15 = 0;  ///< with the distances
};

/// A sum of lengths times Q15 ratios, rounded half up to the length's format, saturating.
/// @param sum  below 2^31 - 2^14: three products of this vehicle's lengths are
constexpr int16_t whole_q15(int32_t sum) {
    return narrow_sat_s16(shift_floor<15>(add_wrap(sum, int32_t{0x4000})));
}
static_assert(32768l * 32768 + 32768l * (vehicle::kBodyReferenceQ4Mm + vehicle::kLookAheadQ4Mm[1]) <
              2147483647l - 0x4000);

/// Pose of the left side; of the right one when the left bogie's potentiometer is not valid.
/// Distances are left out: see add_distances().
[[gnu::noinline]] constexpr void linkage_pose(const Angles& angles, LinkagePose& pose) {
    pose = LinkagePose{};
    const AngleReading& pitch = angles[hal::AngleChannel::pitch];
    const AngleReading& differential = angles[hal::AngleChannel::differential];
    const AngleReading& left = angles[hal::AngleChannel::bogie_left];
    const AngleReading& right = angles[hal::AngleChannel::bogie_right];
    if (!pitch.valid || !differential.valid || (!left.valid && !right.valid)) return;
    pose.side = left.valid ? Side::left : Side::right;
    pose.rocker_brad = left.valid ? add_wrap(pitch.brad, differential.brad)
                                  : sub_wrap(pitch.brad, differential.brad);
    pose.bogie_brad = add_wrap(pose.rocker_brad, left.valid ? left.brad : right.brad);
    pose.rocker_sine_q15 = sine_q15(pose.rocker_brad);
    const int32_t rocker_q19 = mul_wide(vehicle::kRockerQ4Mm, pose.rocker_sine_q15);
    const int32_t bogie_q19 = mul_wide(vehicle::kBogieArmQ4Mm, sine_q15(pose.bogie_brad));
    pose.middle_height_q4_mm = whole_q15(sub_wrap(rocker_q19, bogie_q19));
    pose.front_height_q4_mm = whole_q15(add_wrap(rocker_q19, bogie_q19));
}

/// The distances of a pose: only a slip-and-sinkage cycle needs them.
constexpr void add_distances(LinkagePose& pose) {
    if (pose.side == Side::none) return;
    pose.rocker_cosine_q15 = cosine_q15(pose.rocker_brad);
    const int32_t rocker_q21 = mul_wide(vehicle::kRockerQ6Bin, pose.rocker_cosine_q15);
    const int32_t bogie_q21 = mul_wide(vehicle::kBogieArmQ6Bin, cosine_q15(pose.bogie_brad));
    pose.middle_distance_q6_bin = narrow_sat_u16(whole_q15(sub_wrap(rocker_q21, bogie_q21)));
    pose.front_distance_q6_bin = narrow_sat_u16(whole_q15(add_wrap(rocker_q21, bogie_q21)));
}

/// Pose with distances.
constexpr LinkagePose linkage_pose(const Angles& angles) {
    LinkagePose pose;
    linkage_pose(angles, pose);
    add_distances(pose);
    return pose;
}

/// A point of ground ahead, relative to the rear contact.
struct GroundPoint {
    int16_t height_q4_mm = 0;
    uint16_t distance_q6_bin = 0;
};

/// What every range sample of a scan shares: the body pivot, and the body's direction.
struct LookAhead {
    int32_t pivot_up_q19_mm = 0;     ///< s32 Q19 mm, above the rear contact's axle
    int32_t pivot_along_q19_mm = 0;  ///< ahead of it
    int16_t pitch_sine_q15 = 0;
    int16_t pitch_cosine_q15 = 0;
};

/// @param pose  with distances
constexpr LookAhead look_ahead(const LinkagePose& pose, int16_t pitch_brad) {
    using vehicle::kBodyReferenceQ4Mm;
    return {mul_wide(kBodyReferenceQ4Mm, pose.rocker_sine_q15),
            mul_wide(kBodyReferenceQ4Mm, pose.rocker_cosine_q15), sine_q15(pitch_brad),
            cosine_q15(pitch_brad)};
}

/// Range sample `index` turned from the body frame into the frame of the rear contact.
/// @param range_q1_mm       s16 Q1 mm, offset already taken off; level ground reads 0
/// @param wheel_radius_q4_mm  the sensor's zero is one wheel radius below axle height
[[gnu::noinline]] constexpr void ground_point(const LookAhead& view, uint8_t index,
                                              int16_t range_q1_mm, uint16_t wheel_radius_q4_mm,
                                              GroundPoint& point) {
    const uint16_t ahead_q4_mm = vehicle::kLookAheadQ4Mm[index];
    const int16_t radius_q4_mm = narrow_sat_s16(wheel_radius_q4_mm);
    const int16_t below_q4_mm = sub_sat(shift_left_sat<3>(range_q1_mm), radius_q4_mm);
    const int32_t up_q19_mm =
        add_wrap(add_wrap(view.pivot_up_q19_mm, mul_wide(ahead_q4_mm, view.pitch_sine_q15)),
                 mul_wide(below_q4_mm, view.pitch_cosine_q15));
    const int32_t along_q19_mm =
        sub_wrap(add_wrap(view.pivot_along_q19_mm, mul_wide(ahead_q4_mm, view.pitch_cosine_q15)),
                 mul_wide(below_q4_mm, view.pitch_sine_q15));
    point.height_q4_mm = add_sat(whole_q15(up_q19_mm), radius_q4_mm);
    // mm Q4 to 1/64 bin: times 4/25, which is 10485.8 in Q16.
    const uint16_t along_q4_mm = narrow_sat_u16(whole_q15(along_q19_mm));
    point.distance_q6_bin = narrow_wrap_u16(
        shift_floor<16>(add_wrap(mul_wide(along_q4_mm, uint16_t{10486}), uint32_t{0x8000})));
}

}  // namespace rover
