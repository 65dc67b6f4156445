// course_options.cpp - see course_options.hpp.
#include "tools/rover85/course_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "host_sim/calibration/calibration_file.hpp"
#include "host_sim/world/course.hpp"

namespace {

host_sim::AdvanceModel advance_model(const CourseOptions& options) {
    using host_sim::AdvanceKind;
    host_sim::AdvanceModel model;
    model.kind = options.advance == "gaussian"   ? AdvanceKind::gaussian
                 : options.advance == "uniform"  ? AdvanceKind::uniform
                 : options.advance == "constant" ? AdvanceKind::constant
                                                 : AdvanceKind::slope_sinkage;
    model.mean_cm = options.mean_cm;
    model.sigma_cm = options.sigma_cm;
    return model;
}

/// "T:CM": at T seconds the vehicle is put down CM further on.
host_sim::HandMove parse_move(const std::string& text) {
    const std::size_t colon = text.find(':');
    try {
        std::size_t used_time = 0, used_by = 0;
        const std::string time = text.substr(0, colon), by = text.substr(colon + 1);
        const host_sim::HandMove move{std::stod(time, &used_time), std::stod(by, &used_by)};
        if (colon != std::string::npos && used_time == time.size() && used_by == by.size()) {
            return move;
        }
    } catch (const std::exception&) {
        // Falls through to the one message for every malformed text.
    }
    throw host_sim::InputError("--hand-move " + text +
                               ": is not SECONDS:CM; for example --hand-move 120:15");
}

void add_world_options(CLI::App& command, CourseOptions& options) {
    const std::string world = "World";
    command.add_option("--right", options.right, "Ground under the right wheels")
        ->check(CLI::IsMember({"same", "own"}))
        ->capture_default_str()
        ->group(world);
    command
        .add_option("--ramp", options.ramp_m,
                    "Level ramp before the course, on which nothing slips, m; 0: none")
        ->check(CLI::Range(0.0, 10.0))
        ->capture_default_str()
        ->group(world);
    command.add_option("--advance", options.advance, "How the vehicle slips")
        ->check(CLI::IsMember({"gaussian", "uniform", "slope_sinkage", "constant"}))
        ->capture_default_str()
        ->group(world);
    command.add_option("--mean", options.mean_cm, "Mean advance per 6 cm of wheel travel, cm")
        ->check(CLI::Range(-6.0, 6.0))
        ->capture_default_str()
        ->group(world);
    command.add_option("--sigma", options.sigma_cm, "Its spread, cm")
        ->check(CLI::Range(0.0, 6.0))
        ->capture_default_str()
        ->group(world);
    command.add_option("--wheel", options.wheel, "Sinkage law on measured ground")
        ->check(CLI::IsMember({"grouser", "smooth"}))
        ->capture_default_str()
        ->group(world);
    command.add_option("--static-sinkage", options.static_mm, "Sinkage at no slip there, mm")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str()
        ->group(world);
    command.add_option("--vehicle", options.vehicle, "Vehicle description instead of Rocky 3.2")
        ->type_name("TOML")
        ->group(world);
    command.add_option("--hand-move", options.moves, "Put down elsewhere: SECONDS:CM")
        ->group(world);
}

void add_sensor_options(CLI::App& command, CourseOptions& options) {
    const std::string sensors = "Sensors";
    command
        .add_option("--faults", options.faults,
                    "CHANNEL:KIND[=VALUE]@FROM-[TO], several separated by commas; kinds stuck, "
                    "dropped, offset, absent; seconds")
        ->group(sensors);
    command
        .add_option("--pot-noise", options.pot_noise_mrad,
                    "Potentiometer noise, mrad (else 0.075; 0.26 on measured ground)")
        ->check(CLI::Range(0.0, 50.0))
        ->group(sensors);
    command.add_option("--noise-memory", options.noise_memory, "Correlation between steps")
        ->check(CLI::Range(-0.999, 0.999))
        ->group(sensors);
    command
        .add_option("--noise-correlation", options.linkage_correlation,
                    "Correlation of differential and bogie noise")
        ->check(CLI::Range(-1.0, 1.0))
        ->group(sensors);
    command.add_option("--tach-spread", options.tach_spread, "Spread of the wheels' speeds, share")
        ->check(CLI::Range(0.0, 0.2))
        ->group(sensors);
    command.add_option("--calibration", options.calibration, "Calibration record to use")
        ->type_name("TOML")
        ->group(sensors);
}

}  // namespace

host_sim::DriveOptions drive_options(const CourseOptions& options,
                                     const host_sim::Vehicle& vehicle) {
    host_sim::DriveOptions drive;
    constexpr std::string_view kProfile = "profile:";
    if (options.terrain.starts_with(kProfile)) {
        const host_sim::Profile profile =
            host_sim::load_profile(options.terrain.substr(kProfile.size()));
        const auto kind =
            options.wheel == "smooth" ? host_sim::WheelKind::smooth : host_sim::WheelKind::grouser;
        drive = host_sim::profile_course(vehicle, profile, host_sim::built_in_sinkage_law(kind),
                                         options.static_mm / 10, options.seed);
        if (options.length->count() > 0)
            drive.length_cm = std::min(drive.length_cm, 100 * options.length_m);
    } else {
        const auto kind = host_sim::terrain_kind(options.terrain);
        if (!kind) {
            throw host_sim::InputError("--terrain " + options.terrain +
                                       ": is not fractal, wilcox1994 or profile:FILE.csv");
        }
        drive = host_sim::random_course(vehicle, *kind, options.roughness, options.length_m,
                                        options.seed);
        if (options.right == "own") {
            const host_sim::TerrainSpan span{150, 100 * options.length_m, 200};
            drive.right = host_sim::Track(
                host_sim::make_terrain(*kind, options.seed, span, "right terrain")
                    .scaled(options.roughness),
                host_sim::make_sinkage(*kind, options.seed, span).scaled(options.roughness));
        }
    }
    host_sim::add_exit_ramp(drive, 100 * options.ramp_m);
    drive.advance = advance_model(options);
    drive.sensors.noise_memory = options.noise_memory;
    drive.sensors.linkage_correlation = options.linkage_correlation;
    drive.sensors.tach_spread = options.tach_spread;
    if (options.pot_noise_mrad >= 0) {
        drive.sensors.potentiometer_noise_rad = options.pot_noise_mrad / 1000;
    }
    drive.faults = host_sim::parse_faults(options.faults);
    for (const std::string& move : options.moves) drive.hand_moves.push_back(parse_move(move));
    return drive;
}

host_sim::Vehicle vehicle_of(const CourseOptions& options) {
    return options.vehicle.empty() ? host_sim::rocky32() : host_sim::load_vehicle(options.vehicle);
}

host_sim::LogHead head_of(const CourseOptions& options, const host_sim::Vehicle& vehicle) {
    host_sim::LogHead head;
    head.vehicle = vehicle.toml_text;
    head.calibration = options.calibration.empty()
                           ? host_sim::nominal_calibration(vehicle)
                           : host_sim::load_calibration(options.calibration);
    head.notes["source"] = "simulated world";
    head.notes["terrain"] = options.terrain;
    if (!options.terrain.starts_with("profile:")) {
        head.notes["roughness"] = fmt::format("{}", options.roughness);
    }
    head.notes["ramp"] = fmt::format("{} m, level and firm, before the course", options.ramp_m);
    head.notes["seed"] = fmt::format("{}", options.seed);
    head.notes["advance"] =
        fmt::format("{}, mean {} cm per 6 cm of wheel travel", options.advance, options.mean_cm);
    if (!options.faults.empty()) head.notes["faults"] = options.faults;
    return head;
}

void add_course_options(CLI::App& command, CourseOptions& options) {
    command.add_option("--terrain", options.terrain, "fractal, wilcox1994 or profile:FILE.csv")
        ->capture_default_str();
    command.add_option("--roughness", options.roughness, "Amplitude over wavelength (Wilcox 1994)")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    options.length = command.add_option("--length", options.length_m, "Course, m")
                         ->check(CLI::Range(0.1, 10000.0))
                         ->capture_default_str();
    command.add_option("--seed", options.seed, "Everything random follows from it")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    add_world_options(command, options);
    add_sensor_options(command, options);
}
