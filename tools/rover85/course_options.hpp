// course_options.hpp - the simulated world of a command: its options, and the course that they
// name. Depends on   host_sim/world, host_sim/log, CLI11. Tests        run as the real program by
// tests/system
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "host_sim/log/log.hpp"
#include "host_sim/world/drive.hpp"

/// What the options say; add_course_options() shows their defaults.
struct CourseOptions {
    std::string terrain = "fractal";
    double roughness = 0.02, length_m = 62.5, ramp_m = 1.0;
    CLI::Option* length = nullptr;  ///< to tell whether it was given
    std::uint64_t seed = 1;
    std::string right = "same", advance = "gaussian";
    double mean_cm = 5.0, sigma_cm = 1.0;
    std::string wheel = "grouser";
    double static_mm = 5.0;
    std::string faults, vehicle, calibration;
    std::vector<std::string> moves;
    double pot_noise_mrad = -1, noise_memory = 0, linkage_correlation = 0, tach_spread = 0;
};

/// Adds them to a command. @param options  must outlive it
void add_course_options(CLI::App& command, CourseOptions& options);

/// The vehicle that drives. @errors  host_sim::InputError: its description cannot be used
host_sim::Vehicle vehicle_of(const CourseOptions& options);

/// The course. @errors  host_sim::InputError: terrain, profile, faults or moves cannot be used
host_sim::DriveOptions drive_options(const CourseOptions& options,
                                     const host_sim::Vehicle& vehicle);

/// Head of a log of this drive: vehicle, calibration record, notes.
/// @errors  host_sim::InputError: the calibration record cannot be used
host_sim::LogHead head_of(const CourseOptions& options, const host_sim::Vehicle& vehicle);
