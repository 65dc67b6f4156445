// names.hpp - the words of the report for modes, faults, estimates and sensors.
// Depends on   hal/io.hpp, firmware/executive/estimates.hpp.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "host_sim/log/log.hpp"

namespace report {

inline constexpr std::size_t kModeCount = 6;
inline constexpr std::array<const char*, kModeCount> kModeNames = {
    "wheel odometry only", "tracking", "re-acquiring", "reversing", "turning", "moved by hand"};
inline constexpr std::array<const char*, kModeCount> kModeKeys = {
    "odometry_only", "tracking", "reacquiring", "reversing", "turning", "moved"};

struct FaultName {
    rover::Fault bit;
    const char* key;
    const char* text;
};
inline constexpr std::array<FaultName, 8> kFaultNames = {{
    {rover::kFaultBogieLeft, "bogie_left", "left bogie potentiometer"},
    {rover::kFaultBogieRight, "bogie_right", "right bogie potentiometer"},
    {rover::kFaultDifferential, "differential", "differential potentiometer"},
    {rover::kFaultPitch, "pitch", "pitch inclinometer"},
    {rover::kFaultRoll, "roll", "roll inclinometer"},
    {rover::kFaultTachometer, "tachometer", "a tachometer disagrees with the others"},
    {rover::kFaultRangeStale, "range_stale", "no fresh range scan"},
    {rover::kFaultCalibration, "calibration", "calibration record refused, nominal values in use"},
}};

struct EstimateName {
    rover::Available bit;
    const char* key;
    const char* text;
    const char* needs;
};
inline constexpr std::array<EstimateName, 6> kEstimateNames = {{
    {rover::kAvailableOdometry, "odometry", "wheel odometry", "at least one tachometer"},
    {rover::kAvailableAttitude, "attitude", "pitch and roll", "the two-axis inclinometer"},
    {rover::kAvailableLinkage, "linkage", "wheel heights from the suspension",
     "pitch, the differential and one bogie potentiometer"},
    {rover::kAvailableSlip, "slip", "slip and slip-corrected position",
     "the suspension geometry and a tachometer"},
    {rover::kAvailableLookAhead, "look_ahead", "ground ahead of the wheels", "fresh range samples"},
    {rover::kAvailableSinkage, "sinkage", "sinkage",
     "the suspension geometry and fresh range samples"},
}};

/// A sensor that slip and sinkage rest on, and whether a step's inputs carry it.
struct Sensor {
    std::string key;
    std::string text;
    bool (*present)(const hal::RawInputs& inputs, unsigned index);
    unsigned index;
};

/// The five angle sensors, six tachometers and the range module, in this order.
const std::vector<Sensor>& sensors();

}  // namespace report
