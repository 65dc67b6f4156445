// borealtc.hpp - importer for the proprioception runs of the BorealTC data set (Husky A200).
// Depends on   numeric_table.hpp, board_counts.hpp.
// Source       docs/guides/real-data.md: origin, columns, conversion, what is absent.
// Tests        tests/host_sim/import/borealtc_test.cpp
#pragma once

#include <filesystem>
#include <string_view>

#include "host_sim/import/numeric_table.hpp"
#include "host_sim/log/log.hpp"

namespace host_sim {

inline constexpr std::string_view kBorealtcImuHeader = "time,wx,wy,wz,ax,ay,az";
inline constexpr std::string_view kBorealtcProHeader = "time,curL,curR,velL,velR";
inline constexpr double kHuskyWheelRadiusMm = 165.1;  ///< 13 inch wheels, maker's description

/// Turns a run (inertial unit at 100 Hz, wheel speeds at 6.5 Hz) into a log of 100 ms steps.
/// Step k stands at 0.1 k s and takes the inertial rows of the ten 10 ms before it, that row
/// included. Present: pitch, roll, the tachometers of the four corner wheels. All else is absent.
/// Ends where either file ends.
/// @errors  LogError with file and line: see numeric_table.hpp; inertial rows not 10 ms apart;
///          wheel rows more than 0.5 s apart; speed beyond 5 m/s; acceleration beyond 500 m/s^2
///          or of no direction; less than one step
Log import_borealtc(const NumericTable& imu, const NumericTable& pro);
Log import_borealtc(const std::filesystem::path& imu_path, const std::filesystem::path& pro_path);

}  // namespace host_sim
