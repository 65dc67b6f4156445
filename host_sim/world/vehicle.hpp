// vehicle.hpp - the vehicle as data: geometry, drive and sensors of one rover.
// Files    host_sim/vehicles/*.toml; rocky32 is built into the program. Every key is required,
// every
//          unknown key refused.
// Depends  hal/calibration.hpp, host_sim/world/input_error.hpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hal/calibration.hpp"
#include "host_sim/world/input_error.hpp"

namespace host_sim {

/// A rocker-bogie rover, both sides alike. Wheels touch the ground below their axles.
struct Vehicle {
    std::string name;
    std::string toml_text;  ///< the description it was read from, for log heads

    double rocker_cm = 0;          ///< rear axle to bogie pivot
    double bogie_arm_cm = 0;       ///< bogie pivot to middle and to front axle
    double body_reference_cm = 0;  ///< body pivot, ahead of the rear axle on the rocker line
    double wheel_radius_cm = 0;
    double track_width_cm = 0;  ///< between left and right wheels

    double speed_cm_per_s = 0;  ///< rim speed at 100 % drive
    int tach_counts_per_turn = 0;

    double potentiometer_range_deg = 0;  ///< suspension potentiometers span -range .. +range
    double inclinometer_range_deg = 0;
    std::vector<double> range_sample_cm;  ///< look-ahead distances from the rear axle, rising

    /// Rim travel of one tachometer pulse.
    [[nodiscard]] double cm_per_pulse() const;
};

/// Reads a description.
/// @param file_name  for messages only
/// @errors  InputError with file, line, key and the legal range
Vehicle parse_vehicle(std::string_view toml_text, const std::string& file_name);

/// Reads a description from a file.
/// @errors  InputError, also when the file cannot be read
Vehicle load_vehicle(const std::string& path);

/// Rocky 3.2, from the description built into the program.
Vehicle rocky32();

/// The calibration record of a vehicle whose sensors are exactly as described.
hal::Calibration nominal_calibration(const Vehicle& vehicle);

}  // namespace host_sim
