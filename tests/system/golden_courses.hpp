// golden_courses.hpp - the short drives whose estimates are kept as reviewed files.
// Files   tests/golden/replay/NAME.rlog: inputs, restarts, estimates and commands of each.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "host_sim/bind/host_target.hpp"
#include "host_sim/world/course.hpp"

namespace system_test {

/// What is done to the inputs of a drive before the controller sees them: what the simulated
/// vehicle cannot do by itself.
enum class Edit : std::uint8_t {
    none,
    reverse_and_turn,  ///< the wheels turn back from 10 s on, and on the spot from 16 s on
    stand,             ///< the wheels stand from 8 s to 11 s, though the vehicle moves: carried
    tick_gaps,         ///< ticks begin at 65,000, leap now and then, and once stand still
};

struct GoldenCourse {
    const char* name;
    double roughness = 0.04;
    double mean_advance_cm = 5.0;
    const char* faults = "";
    double length_m = 1.0;
    host_sim::AdvanceKind advance = host_sim::AdvanceKind::gaussian;
    double noise_mrad = 0;  ///< of potentiometers and inclinometer; 0: the default
    double move_at_s = 0;   ///< put down 12 cm further on; 0: never
    double reset_1_s = 0, reset_2_s = 0;
    Edit edit = Edit::none;
};

inline constexpr std::array<GoldenCourse, 13> kGoldenCourses = {{
    {.name = "smooth", .roughness = 0.005, .length_m = 1.5},
    {.name = "rough", .roughness = 0.08, .length_m = 1.5},
    {.name = "slipping", .mean_advance_cm = 3.0, .length_m = 1.5},
    {.name = "faulty",
     .faults = "bogie_left:absent@20-25,range:stuck@12-16,tach_rear_right:stuck@6-",
     .length_m = 1.5},
    {.name = "sinking",
     .roughness = 0.1,
     .length_m = 0.5,
     .advance = host_sim::AdvanceKind::slope_sinkage},
    {.name = "stuck_sensor", .faults = "bogie_left:stuck@4-"},
    {.name = "dropouts",
     .faults = "differential:dropped=0.3@2-18,pitch:dropped=0.1@4-,tach:dropped=0.05@1-,"
               "range_0:dropped=0.5@0-"},
    {.name = "absent_sensors",
     .faults = "bogie_right:absent@0-,roll:absent@0-,range:absent@0-,tach_rear_left:absent@0-,"
               "tach_front_right:absent@0-"},
    {.name = "resets", .reset_1_s = 7.3, .reset_2_s = 13},
    {.name = "moved_by_hand", .move_at_s = 9, .edit = Edit::stand},
    {.name = "reverse_and_turn", .length_m = 1.2, .edit = Edit::reverse_and_turn},
    {.name = "tick_gaps", .edit = Edit::tick_gaps},
    {.name = "noise", .roughness = 0.02, .noise_mrad = 1},
}};

inline std::filesystem::path golden_file(const GoldenCourse& course) {
    return std::filesystem::path(ROVER_SOURCE_DIR) / "tests/golden/replay" /
           (std::string(course.name) + ".rlog");
}

/// Wheels that turn by `pulses` a step as they did, but back, and the left ones back and the right
/// ones forward.
inline void reverse_and_turn(std::vector<host_sim::LogStep>& steps) {
    constexpr std::size_t kReverseStep = 100, kTurnStep = 160;
    const std::vector<host_sim::LogStep> driven = steps;
    for (std::size_t i = kReverseStep; i < steps.size(); ++i) {
        for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
            const bool back = i < kTurnStep || wheel % 2 == 0;
            const int pulses =
                driven[i].inputs.tach_count[wheel] - driven[i - 1].inputs.tach_count[wheel];
            steps[i].inputs.tach_count[wheel] = static_cast<std::uint16_t>(
                steps[i - 1].inputs.tach_count[wheel] + (back ? -pulses : pulses));
        }
    }
}

inline void stand(std::vector<host_sim::LogStep>& steps) {
    constexpr std::size_t kFirst = 80, kLast = 109;
    const std::vector<host_sim::LogStep> driven = steps;
    for (std::size_t i = kFirst; i < steps.size(); ++i) {
        for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
            const int not_counted = driven[std::min(i, kLast)].inputs.tach_count[wheel] -
                                    driven[kFirst - 1].inputs.tach_count[wheel];
            steps[i].inputs.tach_count[wheel] =
                static_cast<std::uint16_t>(driven[i].inputs.tach_count[wheel] - not_counted);
        }
    }
}

inline void make_tick_gaps(std::vector<host_sim::LogStep>& steps) {
    unsigned tick = 65'000;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        steps[i].inputs.tick_count = static_cast<std::uint16_t>(tick);
        tick += i % 17 == 16 ? 30U : i == 40 ? 0U : i == 90 ? 20'000U : 10U;
    }
}

/// Drives a course and keeps inputs, estimates and commands: truth is no part of the contract.
inline host_sim::Log drive_golden(const GoldenCourse& golden) {
    host_sim::Vehicle vehicle = host_sim::rocky32();
    vehicle.speed_cm_per_s = 6;  // a cycle every ten steps instead of sixty keeps the files small
    host_sim::DriveOptions course = host_sim::random_course(
        vehicle, host_sim::TerrainKind::wilcox1994, golden.roughness, golden.length_m, 85);
    course.advance.kind = golden.advance;
    course.advance.mean_cm = golden.mean_advance_cm;
    course.faults = host_sim::parse_faults(golden.faults);
    if (golden.noise_mrad > 0) {
        course.sensors.potentiometer_noise_rad = golden.noise_mrad / 1000;
        course.sensors.inclinometer_noise_rad = golden.noise_mrad / 1000;
    }
    if (golden.move_at_s > 0) course.hand_moves = {{golden.move_at_s, 12}};
    std::vector<double> resets_s;
    for (const double at_s : {golden.reset_1_s, golden.reset_2_s}) {
        if (at_s > 0) resets_s.push_back(at_s);
    }
    host_sim::LogHead head;
    head.vehicle = "name = \"rocky32\"\n";
    head.calibration = host_sim::nominal_calibration(vehicle);
    head.notes["course"] = golden.name;
    host_sim::Drive drive(course);
    const auto host = host_sim::make_host_target();
    host_sim::Log log = host_sim::drive(*host, drive, std::move(head), {}, resets_s);
    if (golden.edit == Edit::reverse_and_turn) reverse_and_turn(log.steps);
    if (golden.edit == Edit::stand) stand(log.steps);
    if (golden.edit == Edit::tick_gaps) make_tick_gaps(log.steps);
    if (golden.edit != Edit::none) host_sim::replay_on_host(log);
    log.head.image_identity.clear();  // changes with every edit of a comment
    for (host_sim::LogStep& step : log.steps) step.truth.reset();
    return log;
}

/// The estimates themselves say it all: telemetry would only make the files larger.
inline void drop_telemetry(host_sim::Log& log) {
    for (host_sim::LogStep& step : log.steps) {
        if (!step.commands) continue;
        step.commands->telemetry_size = 0;
        for (std::uint8_t& byte : step.commands->telemetry) byte = 0;
    }
}

}  // namespace system_test
