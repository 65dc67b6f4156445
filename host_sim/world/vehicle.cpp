// vehicle.cpp - vehicle descriptions from TOML, checked key by key.
#include "host_sim/world/vehicle.hpp"

#include <cmath>
#include <numbers>

#include "hal/io.hpp"
#include "host_sim/world/rocky32_toml.hpp"
#include "host_sim/world/text_file.hpp"
#include "host_sim/world/toml_input.hpp"

namespace host_sim {

double Vehicle::cm_per_pulse() const {
    return 2.0 * std::numbers::pi * wheel_radius_cm / tach_counts_per_turn;
}

Vehicle parse_vehicle(std::string_view toml_text, const std::string& file_name) {
    const toml::table parsed = parse_toml(toml_text, file_name);
    const TomlTable root(parsed, file_name, "");
    root.allow_only({"name", "linkage", "drive", "sensors"});
    Vehicle vehicle;
    vehicle.toml_text = std::string(toml_text);
    vehicle.name = root.text("name");

    const TomlTable linkage = root.table("linkage");
    linkage.allow_only(
        {"rocker_cm", "bogie_arm_cm", "body_reference_cm", "wheel_radius_cm", "track_width_cm"});
    vehicle.rocker_cm = linkage.number("rocker_cm", 1, 1000);
    vehicle.bogie_arm_cm = linkage.number("bogie_arm_cm", 1, 1000);
    vehicle.body_reference_cm = linkage.number("body_reference_cm", 0, 1000);
    vehicle.wheel_radius_cm = linkage.number("wheel_radius_cm", 0.5, 200);
    vehicle.track_width_cm = linkage.number("track_width_cm", 1, 1000);
    if (vehicle.bogie_arm_cm >= vehicle.rocker_cm) {
        throw linkage.wrong("bogie_arm_cm",
                            "must be shorter than rocker_cm, or the middle wheel "
                            "would stand behind the rear wheel");
    }
    if (vehicle.body_reference_cm > vehicle.rocker_cm) {
        throw linkage.wrong("body_reference_cm", "must not lie ahead of the bogie pivot");
    }

    const TomlTable drive = root.table("drive");
    drive.allow_only({"speed_cm_per_s", "tach_counts_per_turn"});
    vehicle.speed_cm_per_s = drive.number("speed_cm_per_s", 0.01, 200);
    vehicle.tach_counts_per_turn = drive.integer("tach_counts_per_turn", 1, 65535);

    const TomlTable sensors = root.table("sensors");
    sensors.allow_only({"potentiometer_range_deg", "inclinometer_range_deg", "range_sample_cm"});
    vehicle.potentiometer_range_deg = sensors.number("potentiometer_range_deg", 1, 179);
    vehicle.inclinometer_range_deg = sensors.number("inclinometer_range_deg", 1, 179);
    vehicle.range_sample_cm = sensors.numbers("range_sample_cm", 0, 2000);
    if (vehicle.range_sample_cm.size() > hal::kRangeSampleCount) {
        throw sensors.wrong("range_sample_cm", "may have 8 samples at most");
    }
    for (std::size_t i = 1; i < vehicle.range_sample_cm.size(); ++i) {
        if (vehicle.range_sample_cm[i] <= vehicle.range_sample_cm[i - 1]) {
            throw sensors.wrong("range_sample_cm", "must rise from sample to sample");
        }
    }
    // The calibration record keeps the rim travel of a pulse in 16 bits, Q16 mm.
    if (vehicle.cm_per_pulse() >= 0.0999) {
        throw drive.wrong("tach_counts_per_turn",
                          "is too small: a pulse must be less than 1 mm of rim travel");
    }
    return vehicle;
}

Vehicle load_vehicle(const std::string& path) {
    return parse_vehicle(read_text_file(path), path);
}

Vehicle rocky32() {
    return parse_vehicle(kRocky32Toml, "rocky32.toml");
}

namespace {

// brad per Q4 count, Q16, of a sensor that spans -range .. +range over the 65536 Q4 counts.
std::uint16_t gain_q16(double range_deg) {
    const double brad_per_count = 2.0 * range_deg / 360.0 * 65536.0 / 65536.0;
    return static_cast<std::uint16_t>(std::lround(brad_per_count * 65536.0));
}

}  // namespace

hal::Calibration nominal_calibration(const Vehicle& vehicle) {
    hal::Calibration calibration;
    for (std::size_t i = 0; i < hal::kAngleChannelCount; ++i) {
        const bool inclinometer = i >= static_cast<std::size_t>(hal::AngleChannel::pitch);
        calibration.angle[i].gain_q16 = gain_q16(inclinometer ? vehicle.inclinometer_range_deg
                                                              : vehicle.potentiometer_range_deg);
    }
    calibration.wheel_radius_q4_mm =
        static_cast<std::uint16_t>(std::lround(vehicle.wheel_radius_cm * 10.0 * 16.0));
    calibration.tach_counts_per_turn = static_cast<std::uint16_t>(vehicle.tach_counts_per_turn);
    calibration.tach_q16_mm_per_count =
        static_cast<std::uint16_t>(std::lround(vehicle.cm_per_pulse() * 10.0 * 65536.0));
    return calibration;
}

}  // namespace host_sim
