// linkage.hpp - kinematics of one side of the rocker-bogie: angles to heights and distances.
// Depends on   config/vehicle.hpp, core/sine.hpp, inputs/angles.hpp.
// Source       docs/design/controller.md, "Kinematics": z(1), z(2) from rocker and bogie angle,
//              z(3) ... from the range samples in the body frame.
// Bounds       two sines and two products by a byte in a step; in a cycle four more sines, four
//              products, three of them by a byte, and two a range sample.
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

// The rocker is three bogie arms b, so R x -+ b y = 2 b (x + (x -+ y) / 2).
static_assert(vehicle::kRockerQ4Mm == 3 * vehicle::kBogieArmQ4Mm);
static_assert(vehicle::kRockerQ6Bin == 3 * vehicle::kBogieArmQ6Bin);

/// (factor * value + rounding) / 256, rounded down.
[[gnu::noinline]] constexpr int16_t mul_q8(uint8_t factor_q8, int16_t value, uint16_t rounding_q8) {
    const int32_t sum_q8 = add_wrap(mul_wide(factor_q8, value), widen_s32(rounding_q8));
    return narrow_wrap_s16(shift_floor<8>(sum_q8));
}

/// x + (x + y) / 2, s16 Q14, rounded down.
/// @param rocker_q14, bogie_q14  [-16383, 16383], so that nothing overflows
constexpr int16_t arms_q14(int16_t rocker_q14, int16_t bogie_q14) {
    return add_wrap(rocker_q14, halve_floor(add_wrap(rocker_q14, bogie_q14)));
}
/// Height of a contact by the sines of rocker and bogie: twice a bogie's arm times the ratio above,
/// s16 Q4 mm, rounded half up.
[[gnu::noinline]] constexpr int16_t arms_q4_mm(int16_t rocker_q14, int16_t bogie_q14) {
    static_assert(2ul * vehicle::kBogieArmQ4Mm * 512 == 125ul * 16384);
    const int32_t twice_q8 = mul_wide(uint8_t{125}, arms_q14(rocker_q14, bogie_q14));
    return halve_floor(add_wrap(narrow_wrap_s16(shift_floor<8>(twice_q8)), int16_t{1}));
}
/// The same in 1/64 bin; what lies behind counts as 0.
[[gnu::noinline]] constexpr uint16_t arms_q6_bin(int16_t rocker_q14, int16_t bogie_q14) {
    static_assert(2ul * vehicle::kBogieArmQ6Bin * 256 == 10ul * 16384);
    const int16_t arms = arms_q14(rocker_q14, bogie_q14);
    if (arms < 0) return 0;
    // (10 arms + 128) / 256 in 16 bits: 5/4 of it may be rounded down before it is divided by 32.
    const uint16_t size_q14 = narrow_wrap_u16(arms);
    const uint16_t five_quarters = add_wrap(size_q14, shift_floor<2>(size_q14));
    return shift_floor<5>(add_wrap(five_quarters, uint16_t{16}));
}

/// Pose of the left side; of the right one when the left bogie's potentiometer is not valid.
/// Distances are left as they are: see add_distances().
[[gnu::noinline]] constexpr void linkage_pose(const Angles& angles, LinkagePose& pose) {
    using enum hal::AngleChannel;
    const bool left = angles.has(bogie_left);
    if (!angles.has(pitch) || !angles.has(differential) || (!left && !angles.has(bogie_right))) {
        pose.side = Side::none;
        pose.rocker_brad = 0;
        pose.bogie_brad = 0;
        pose.middle_height_q4_mm = 0;
        pose.front_height_q4_mm = 0;
        return;
    }
    pose.side = left ? Side::left : Side::right;
    const int16_t turned_brad = angles[differential];
    pose.rocker_brad =
        left ? add_wrap(angles[pitch], turned_brad) : sub_wrap(angles[pitch], turned_brad);
    pose.bogie_brad = add_wrap(pose.rocker_brad, left ? angles[bogie_left] : angles[bogie_right]);
    const int16_t rocker_q14 = sine_q14(pose.rocker_brad);
    const int16_t bogie_q14 = sine_q14(pose.bogie_brad);
    pose.middle_height_q4_mm = arms_q4_mm(rocker_q14, neg_wrap(bogie_q14));
    pose.front_height_q4_mm = arms_q4_mm(rocker_q14, bogie_q14);
}

/// The distances of a pose: only a slip-and-sinkage cycle needs them.
/// @param pose  of a side
constexpr void add_distances(LinkagePose& pose) {
    const int16_t rocker_q14 = cosine_q14(pose.rocker_brad);
    const int16_t bogie_q14 = cosine_q14(pose.bogie_brad);
    pose.middle_distance_q6_bin = arms_q6_bin(rocker_q14, neg_wrap(bogie_q14));
    pose.front_distance_q6_bin = arms_q6_bin(rocker_q14, bogie_q14);
}

/// Pose with distances.
constexpr LinkagePose linkage_pose(const Angles& angles) {
    LinkagePose pose;
    linkage_pose(angles, pose);
    if (pose.side != Side::none) add_distances(pose);
    return pose;
}

/// A point of ground ahead, relative to the rear contact.
struct GroundPoint {
    int16_t height_q4_mm = 0;
    uint16_t distance_q6_bin = 0;
};

/// The upper half of a product, rounded down.
[[gnu::noinline]] constexpr int16_t mul_upper(int16_t a, int16_t b) {
    return narrow_wrap_s16(shift_floor<16>(mul_wide(a, b)));
}

inline constexpr int16_t kBinPerMmQ15 = 20972;  ///< 16/25: 1/256 bin in 1/16 mm

/// What every range sample of a scan shares: the body's direction; and a place that goes from
/// sample to sample, at axle height, from the rear contact's axle on.
struct LookAhead {
    int16_t up_q4_mm = 0;
    int16_t along_q8_bin = 0;
    int16_t step_up_q4_mm = 0;  ///< from one sample to the next
    int16_t step_along_q8_bin = 0;
    int16_t versine_q14 = 0;   ///< 1 less the cosine of the pitch
    int16_t sine_q14_bin = 0;  ///< of the pitch, times 16/25: 1/16 mm are so many 1/256 bin
};

// The body pivot is half way along the rocker, and z(1) + z(2) is twice the rocker's height. From
// it the first sample is 412.5 mm, 33/2 bins, the second another 200 mm, 8 bins.
static_assert(2 * vehicle::kBodyReferenceQ4Mm == vehicle::kRockerQ4Mm);
static_assert(vehicle::kLookAheadCount == 2 && vehicle::kLookAheadQ4Mm[0] == 6600 &&
              vehicle::kLookAheadQ4Mm[1] - vehicle::kLookAheadQ4Mm[0] == 3200);

/// The view to the first sample.
/// @param pose  with distances
/// @param pitch_brad  [-1/4, 1/4] turn
constexpr void look_ahead(const LinkagePose& pose, int16_t pitch_brad, LookAhead& view) {
    const int16_t sine = sine_q14(pitch_brad);
    const int16_t cosine = cosine_q14(pitch_brad);
    // 6600 in Q14 is 103 and 1/8 in Q8. 5/4 make up for the terms that are rounded down.
    const int16_t first_up_q4_mm = add_wrap(mul_q8(103, sine, 0x140), shift_floor<11>(sine));
    const int16_t pivot_up_q4_mm =
        shift_floor<2>(add_wrap(pose.middle_height_q4_mm, pose.front_height_q4_mm));
    view.up_q4_mm = add_wrap(pivot_up_q4_mm, first_up_q4_mm);
    view.step_up_q4_mm = mul_q8(50, sine, 0);
    const uint16_t pivot_along_q8_bin =
        add_wrap(pose.middle_distance_q6_bin, pose.front_distance_q6_bin);
    view.along_q8_bin = add_wrap(narrow_wrap_s16(pivot_along_q8_bin), mul_q8(66, cosine, 0));
    view.step_along_q8_bin = shift_floor<3>(cosine);
    view.versine_q14 = sub_wrap(int16_t{16384}, cosine);
    view.sine_q14_bin = mul_upper(shift_left_wrap<1>(sine), kBinPerMmQ15);
}

/// On to the next sample.
constexpr void look_further(LookAhead& view) {
    view.up_q4_mm = add_wrap(view.up_q4_mm, view.step_up_q4_mm);
    view.along_q8_bin = add_wrap(view.along_q8_bin, view.step_along_q8_bin);
}

inline constexpr int16_t kRangeMaxQ1Mm = 800;     ///< 400 mm up or down: beyond is taken as this
inline constexpr uint16_t kRadiusMaxQ4Mm = 1600;  ///< 100 mm

/// A range sample turned from the body frame into the frame of the rear contact.
/// @param range_q1_mm       s16 Q1 mm, offset already taken off; level ground reads 0
/// @param wheel_radius_q4_mm  the sensor's zero is one wheel radius below axle height
[[gnu::noinline]] constexpr void ground_point(const LookAhead& view, int16_t range_q1_mm,
                                              uint16_t wheel_radius_q4_mm, GroundPoint& point) {
    const int16_t radius_q4_mm = narrow_wrap_s16(min(wheel_radius_q4_mm, kRadiusMaxQ4Mm));
    const int16_t range_q4_mm =
        shift_left_wrap<3>(clamp(range_q1_mm, static_cast<int16_t>(-kRangeMaxQ1Mm), kRangeMaxQ1Mm));
    const int16_t below_q6_mm = shift_left_wrap<2>(sub_wrap(range_q4_mm, radius_q4_mm));
    // below * cosine + radius = range - below * versine
    point.height_q4_mm =
        sub_wrap(add_wrap(view.up_q4_mm, range_q4_mm), mul_upper(view.versine_q14, below_q6_mm));
    const int16_t along_q8_bin =
        sub_wrap(view.along_q8_bin, mul_upper(view.sine_q14_bin, below_q6_mm));
    point.distance_q6_bin =
        narrow_sat_u16(halve_floor(halve_floor(add_wrap(along_q8_bin, int16_t{2}))));
}
static_assert(32l * kRangeMaxQ1Mm + 4l * kRadiusMaxQ4Mm < 32768, "below_q6_mm");

}  // namespace rover
