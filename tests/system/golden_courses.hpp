// golden_courses.hpp - the short drives whose estimates are kept as reviewed files.
// Files   tests/golden/replay/NAME.rlog: inputs, estimates and commands of each.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "host_sim/bind/host_target.hpp"
#include "host_sim/world/course.hpp"

namespace system_test {

struct GoldenCourse {
    const char* name;
    double roughness;
    double mean_advance_cm;
    const char* faults;
};

/// Smooth ground; rough ground; heavy slip; and two sensors that fail on the way.
inline constexpr std::array<GoldenCourse, 4> kGoldenCourses = {{
    {"smooth", 0.005, 5.0, ""},
    {"rough", 0.08, 5.0, ""},
    {"slipping", 0.04, 3.0, ""},
    {"faulty", 0.04, 5.0, "bogie_left:absent@20-25,range:stuck@12-16,tach_rear_right:stuck@6-"},
}};

inline std::filesystem::path golden_file(const GoldenCourse& course) {
    return std::filesystem::path(ROVER_SOURCE_DIR) / "tests/golden/replay" /
           (std::string(course.name) + ".rlog");
}

/// Drives a course and keeps inputs, estimates and commands: truth is no part of the contract.
inline host_sim::Log drive_golden(const GoldenCourse& golden) {
    host_sim::Vehicle vehicle = host_sim::rocky32();
    vehicle.speed_cm_per_s = 6;  // a cycle every ten steps instead of sixty keeps the files small
    host_sim::DriveOptions course = host_sim::random_course(
        vehicle, host_sim::TerrainKind::wilcox1994, golden.roughness, 1.5, 85);
    course.advance.mean_cm = golden.mean_advance_cm;
    course.faults = host_sim::parse_faults(golden.faults);
    host_sim::LogHead head;
    head.vehicle = "name = \"rocky32\"\n";
    head.calibration = host_sim::nominal_calibration(vehicle);
    head.notes["course"] = golden.name;
    host_sim::Drive drive(course);
    host_sim::Log log = host_sim::drive_on_host(drive, std::move(head));
    log.head.image_identity.clear();  // changes with every edit of a comment
    for (host_sim::LogStep& step : log.steps) {
        step.truth.reset();
        step.commands->telemetry_size = 0;  // the estimates themselves say it all
        for (std::uint8_t& byte : step.commands->telemetry) byte = 0;
    }
    return log;
}

}  // namespace system_test
