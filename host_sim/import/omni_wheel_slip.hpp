// omni_wheel_slip.hpp - importer for the straight runs of the omni-wheel slip data set.
// Depends on   numeric_table.hpp, board_counts.hpp.
// Source       docs/guides/real-data.md: origin, columns, conversion, what is absent.
// Tests        tests/host_sim/import/omni_wheel_slip_test.cpp
#pragma once

#include <array>
#include <filesystem>
#include <string_view>
#include <vector>

#include "host_sim/import/numeric_table.hpp"
#include "host_sim/log/log.hpp"

namespace host_sim {

inline constexpr std::string_view kOmniHeader =
    "t_ms,set_vx_m_s,set_vy_m_s,set_wz_rad_s,m1_set_rad_s,m2_set_rad_s,m3_set_rad_s,m1_ticks,"
    "m2_ticks,m3_ticks,m1_vel_rad_s,m2_vel_rad_s,m3_vel_rad_s,m1_cur_a,m2_cur_a,m3_cur_a,cur_x_a,"
    "cur_y_a,cur_rot_a,x_px,y_px,heading_deg,dx_mm,dy_mm,dheading_deg";

inline constexpr double kOmniWheelRadiusMm = 40.0;
inline constexpr double kOmniTicksPerTurn = 32000;  ///< 2000 per motor turn, gear 16
inline constexpr int kOmniPrescale = 16;            ///< ticks per count: 2000 counts a wheel turn
inline constexpr double kOmniCameraMmPerPixel = 1.8373;  ///< |dx, dy| over pixels, median of runs
inline constexpr double kOmniSlipWindowMm = 60;          ///< one slip-and-sinkage cycle

/// Which tachometers a run has when the robot is seen as a rover whose nose points along the
/// commanded direction, and how they follow from the three encoders.
struct OmniMapping {
    struct Channel {
        hal::Wheel wheel;
        std::array<double, 3> ticks_forward;  ///< weight of each encoder
    };
    std::vector<Channel> channels;
    double wheel_radius_mm;  ///< travel along the direction per radian of a channel
};

/// Multiples of 60 deg: the two encoders that roll at 30 deg to the motion are the left and right
/// wheels, untouched but for their sign; radius 40 mm / cos 30 deg. Other directions: one channel
/// (middle left), the least-squares projection of the three encoders; radius 40 mm.
/// @param direction_deg  counter-clockwise from the robot's x axis; any
OmniMapping omni_mapping(double direction_deg);

/// Turns a run into a log of 100 ms steps, the first at time 0. Encoders and camera are taken as
/// linear between rows. Truth: position along the commanded direction of the body, and slip over
/// the last 60 mm of odometry; NaN where unknown.
/// @errors  LogError with file and line: see numeric_table.hpp; rows more than 500 ms apart; the
///          command is zero, turns or changes; a tick that is not whole, or jumps by more than
///          100,000
Log import_omni(const NumericTable& run);
Log import_omni(const std::filesystem::path& path);

}  // namespace host_sim
