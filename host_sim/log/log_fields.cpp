// log_fields.cpp - the tables of log_fields.hpp. See there.
#include "host_sim/log/log_fields.hpp"

#include <array>
#include <cstring>
#include <limits>

namespace host_sim::detail {
namespace {

using Type = FieldType;
using hal::Calibration;
using hal::Commands;
using hal::RawInputs;
using rover::Estimates;

// A field that is added to one of these structs must be added to its table, to the specification
// and to the format's version; until then the build stops here.
static_assert(sizeof(Calibration) == 40, "Calibration changed: see docs/spec/log-format.md");
static_assert(sizeof(RawInputs) == 80, "RawInputs changed: see docs/spec/log-format.md");
static_assert(sizeof(Truth) == 48, "Truth changed: see docs/spec/log-format.md");
static_assert(sizeof(Estimates) == 48, "Estimates changed: see docs/spec/log-format.md");
static_assert(sizeof(Commands) == 178, "Commands changed: see docs/spec/log-format.md");

constexpr std::size_t angle_offset(std::size_t index) {
    return offsetof(Calibration, angle) + index * sizeof(hal::AngleCalibration);
}
constexpr Field angle_zero(std::string_view name, std::size_t index) {
    return {name, Type::u16, angle_offset(index) + offsetof(hal::AngleCalibration, zero_q4_count)};
}
constexpr Field angle_gain(std::string_view name, std::size_t index) {
    return {name, Type::u16, angle_offset(index) + offsetof(hal::AngleCalibration, gain_q16)};
}
constexpr Field angle_sign(std::string_view name, std::size_t index) {
    return {name, Type::boolean, angle_offset(index) + offsetof(hal::AngleCalibration, inverted)};
}

constexpr std::array kCalibration = {
    Field{"version", Type::u16, offsetof(Calibration, version)},
    angle_zero("bogie_left.zero_q4_count", 0),
    angle_gain("bogie_left.gain_q16", 0),
    angle_sign("bogie_left.inverted", 0),
    angle_zero("bogie_right.zero_q4_count", 1),
    angle_gain("bogie_right.gain_q16", 1),
    angle_sign("bogie_right.inverted", 1),
    angle_zero("differential.zero_q4_count", 2),
    angle_gain("differential.gain_q16", 2),
    angle_sign("differential.inverted", 2),
    angle_zero("pitch.zero_q4_count", 3),
    angle_gain("pitch.gain_q16", 3),
    angle_sign("pitch.inverted", 3),
    angle_zero("roll.zero_q4_count", 4),
    angle_gain("roll.gain_q16", 4),
    angle_sign("roll.inverted", 4),
    Field{"wheel_radius_q4_mm", Type::u16, offsetof(Calibration, wheel_radius_q4_mm)},
    Field{"tach_counts_per_turn", Type::u16, offsetof(Calibration, tach_counts_per_turn)},
    Field{"tach_q16_mm_per_count", Type::u16, offsetof(Calibration, tach_q16_mm_per_count)},
    Field{"range_offset_q1_mm", Type::s16, offsetof(Calibration, range_offset_q1_mm)},
};

constexpr Field adc(std::string_view name, hal::AdcChannel channel) {
    return {name, Type::adc,
            offsetof(RawInputs, adc_q4_count) + 2 * static_cast<std::size_t>(channel)};
}
constexpr Field tach(std::string_view name, hal::Wheel wheel) {
    const auto index = static_cast<std::size_t>(wheel);
    return {name, Type::u16, offsetof(RawInputs, tach_count) + 2 * index,
            static_cast<std::uint8_t>(1u << index), offsetof(RawInputs, tach_present)};
}
constexpr Field range(std::string_view name, std::size_t index) {
    return {name, Type::s16, offsetof(RawInputs, range_q1_mm) + 2 * index,
            static_cast<std::uint8_t>(1u << index), offsetof(RawInputs, range_present)};
}

constexpr std::array kInputs = {
    Field{"tick_count", Type::u16, offsetof(RawInputs, tick_count)},
    adc("bogie_left_q4_count", hal::AdcChannel::bogie_left),
    adc("bogie_right_q4_count", hal::AdcChannel::bogie_right),
    adc("differential_q4_count", hal::AdcChannel::differential),
    adc("pitch_q4_count", hal::AdcChannel::pitch),
    adc("roll_q4_count", hal::AdcChannel::roll),
    adc("steer_front_left_q4_count", hal::AdcChannel::steer_front_left),
    adc("steer_front_right_q4_count", hal::AdcChannel::steer_front_right),
    adc("steer_rear_left_q4_count", hal::AdcChannel::steer_rear_left),
    adc("steer_rear_right_q4_count", hal::AdcChannel::steer_rear_right),
    adc("gyro_q4_count", hal::AdcChannel::gyro),
    adc("mast_q4_count", hal::AdcChannel::mast),
    adc("motor_current_q4_count", hal::AdcChannel::motor_current),
    adc("battery_q4_count", hal::AdcChannel::battery),
    adc("proximity_q4_count", hal::AdcChannel::proximity),
    Field{"", Type::presence, offsetof(RawInputs, tach_present), 0x3F},
    tach("tach_front_left_count", hal::Wheel::front_left),
    tach("tach_front_right_count", hal::Wheel::front_right),
    tach("tach_middle_left_count", hal::Wheel::middle_left),
    tach("tach_middle_right_count", hal::Wheel::middle_right),
    tach("tach_rear_left_count", hal::Wheel::rear_left),
    tach("tach_rear_right_count", hal::Wheel::rear_right),
    Field{"range_scan_count", Type::u8, offsetof(RawInputs, range_scan_count)},
    Field{"", Type::presence, offsetof(RawInputs, range_present), 0xFF},
    range("range_1_q1_mm", 0),
    range("range_2_q1_mm", 1),
    range("range_3_q1_mm", 2),
    range("range_4_q1_mm", 3),
    range("range_5_q1_mm", 4),
    range("range_6_q1_mm", 5),
    range("range_7_q1_mm", 6),
    range("range_8_q1_mm", 7),
    Field{"detector_bits", Type::u8, offsetof(RawInputs, detector_bits)},
    Field{"received_hex", Type::bytes, offsetof(RawInputs, command), 0,
          offsetof(RawInputs, command_size), hal::kCommandBytesMax},
};

constexpr std::array kTruth = {
    Field{"truth_position_mm", Type::f64, offsetof(Truth, position_mm)},
    Field{"truth_surface_rear_mm", Type::f64, offsetof(Truth, surface_rear_mm)},
    Field{"truth_surface_front_mm", Type::f64, offsetof(Truth, surface_front_mm)},
    Field{"truth_ground_front_mm", Type::f64, offsetof(Truth, ground_front_mm)},
    Field{"truth_sinkage_mm", Type::f64, offsetof(Truth, sinkage_mm)},
    Field{"truth_slip", Type::f64, offsetof(Truth, slip)},
};

constexpr std::array kEstimates = {
    Field{"estimate_step_count", Type::u16, offsetof(Estimates, step_count)},
    Field{"estimate_tick_count", Type::u16, offsetof(Estimates, tick_count)},
    Field{"estimate_available_bits", Type::u8, offsetof(Estimates, available)},
    Field{"estimate_event_bits", Type::u8, offsetof(Estimates, events)},
    Field{"estimate_fault_bits", Type::u16, offsetof(Estimates, faults)},
    Field{"estimate_mode", Type::mode, offsetof(Estimates, mode)},
    Field{"estimate_cycle_count", Type::u16, offsetof(Estimates, cycle_count)},
    Field{"estimate_position_q4_mm", Type::s32, offsetof(Estimates, position_q4_mm)},
    Field{"estimate_odometer_q4_mm", Type::s32, offsetof(Estimates, odometer_q4_mm)},
    Field{"estimate_position_sigma_q4_mm", Type::u16, offsetof(Estimates, position_sigma_q4_mm)},
    Field{"estimate_advance_q4_mm", Type::s16, offsetof(Estimates, advance_q4_mm)},
    Field{"estimate_slip_percent", Type::s8, offsetof(Estimates, slip_percent)},
    Field{"estimate_match_cost_q4", Type::u16, offsetof(Estimates, match_cost_q4)},
    Field{"estimate_sinkage_q4_mm", Type::s16, offsetof(Estimates, sinkage_q4_mm)},
    Field{"estimate_pitch_brad", Type::s16, offsetof(Estimates, pitch_brad)},
    Field{"estimate_roll_brad", Type::s16, offsetof(Estimates, roll_brad)},
    Field{"estimate_rocker_brad", Type::s16, offsetof(Estimates, rocker_brad)},
    Field{"estimate_bogie_brad", Type::s16, offsetof(Estimates, bogie_brad)},
    Field{"estimate_height_middle_q4_mm", Type::s16, offsetof(Estimates, height_middle_q4_mm)},
    Field{"estimate_height_front_q4_mm", Type::s16, offsetof(Estimates, height_front_q4_mm)},
    Field{"estimate_height_ahead_1_q4_mm", Type::s16, offsetof(Estimates, height_ahead_q4_mm)},
    Field{"estimate_height_ahead_2_q4_mm", Type::s16, offsetof(Estimates, height_ahead_q4_mm) + 2},
};

constexpr Field drive(std::string_view name, hal::Wheel wheel) {
    return {name, Type::s8, offsetof(Commands, drive_percent) + static_cast<std::size_t>(wheel)};
}
constexpr Field steer(std::string_view name, std::size_t index) {
    return {name, Type::s16, offsetof(Commands, steer_brad) + 2 * index};
}

constexpr std::array kCommands = {
    drive("command_drive_front_left_percent", hal::Wheel::front_left),
    drive("command_drive_front_right_percent", hal::Wheel::front_right),
    drive("command_drive_middle_left_percent", hal::Wheel::middle_left),
    drive("command_drive_middle_right_percent", hal::Wheel::middle_right),
    drive("command_drive_rear_left_percent", hal::Wheel::rear_left),
    drive("command_drive_rear_right_percent", hal::Wheel::rear_right),
    steer("command_steer_front_left_brad", 0),
    steer("command_steer_front_right_brad", 1),
    steer("command_steer_rear_left_brad", 2),
    steer("command_steer_rear_right_brad", 3),
    Field{"command_mast_brad", Type::s16, offsetof(Commands, mast_brad)},
    Field{"command_laser_bits", Type::u8, offsetof(Commands, laser_bits)},
    Field{"command_telemetry_hex", Type::bytes, offsetof(Commands, telemetry), 0,
          offsetof(Commands, telemetry_size), hal::kTelemetryBytesMax},
};

constexpr std::array<std::string_view, 6> kModeNames = {
    "odometry_only", "tracking", "reacquiring", "reversing", "turning", "moved",
};
static_assert(static_cast<std::size_t>(rover::SlipMode::moved) == kModeNames.size() - 1);
constexpr std::array<std::string_view, 3> kRestartNames = {"", "warm", "cold"};

template <class Value>
Value load_as(const std::byte* at) {
    Value value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

template <class Value, class Number>
void store_as(std::byte* at, Number number) {
    const auto value = static_cast<Value>(number);
    std::memcpy(at, &value, sizeof value);
}

template <class Value>
constexpr IntegerRange range_of() {
    return {std::numeric_limits<Value>::min(), std::numeric_limits<Value>::max()};
}

}  // namespace

std::span<const Field> calibration_fields() {
    return kCalibration;
}
std::span<const Field> input_fields() {
    return kInputs;
}
std::span<const Field> truth_fields() {
    return kTruth;
}
std::span<const Field> estimate_fields() {
    return kEstimates;
}
std::span<const Field> command_fields() {
    return kCommands;
}
std::span<const std::string_view> mode_names() {
    return kModeNames;
}
std::span<const std::string_view> restart_names() {
    return kRestartNames;
}

IntegerRange integer_range(FieldType type) {
    switch (type) {
        case Type::s8:
            return range_of<std::int8_t>();
        case Type::u16:
            return range_of<std::uint16_t>();
        case Type::s16:
            return range_of<std::int16_t>();
        case Type::s32:
            return range_of<std::int32_t>();
        case Type::adc:
            return {0, hal::kAdcMaxQ4Count};
        case Type::boolean:
            return {0, 1};
        case Type::mode:
            return {0, kModeNames.size() - 1};
        case Type::u8:
        case Type::presence:
        case Type::f64:
        case Type::bytes:
            break;
    }
    return range_of<std::uint8_t>();
}

std::int64_t load_integer(const Field& field, const std::byte* base) {
    const std::byte* at = base + field.offset;
    switch (field.type) {
        case Type::s8:
            return load_as<std::int8_t>(at);
        case Type::u16:
        case Type::adc:
            return load_as<std::uint16_t>(at);
        case Type::s16:
            return load_as<std::int16_t>(at);
        case Type::s32:
            return load_as<std::int32_t>(at);
        case Type::boolean:
            return load_as<bool>(at) ? 1 : 0;
        case Type::mode:
            return static_cast<std::int64_t>(load_as<rover::SlipMode>(at));
        case Type::u8:
        case Type::presence:
        case Type::f64:
        case Type::bytes:
            break;
    }
    return load_as<std::uint8_t>(at);
}

void store_integer(const Field& field, std::byte* base, std::int64_t value) {
    std::byte* at = base + field.offset;
    switch (field.type) {
        case Type::s8:
            return store_as<std::int8_t>(at, value);
        case Type::u16:
        case Type::adc:
            return store_as<std::uint16_t>(at, value);
        case Type::s16:
            return store_as<std::int16_t>(at, value);
        case Type::s32:
            return store_as<std::int32_t>(at, value);
        case Type::boolean:
            return store_as<bool>(at, value != 0);
        case Type::mode:
            return store_as<rover::SlipMode>(at, value);
        case Type::u8:
        case Type::presence:
        case Type::f64:
        case Type::bytes:
            break;
    }
    store_as<std::uint8_t>(at, value);
}

double load_double(const Field& field, const std::byte* base) {
    return load_as<double>(base + field.offset);
}

void store_double(const Field& field, std::byte* base, double value) {
    store_as<double>(base + field.offset, value);
}

bool is_present(const Field& field, const std::byte* base) {
    if (field.type == Type::adc) return load_integer(field, base) <= hal::kAdcMaxQ4Count;
    if (!field.optional()) return true;
    return (load_as<std::uint8_t>(base + field.mask_offset) & field.bit) != 0;
}

void set_present(const Field& field, std::byte* base) {
    if (!field.optional()) return;
    const auto mask = load_as<std::uint8_t>(base + field.mask_offset);
    store_as<std::uint8_t>(base + field.mask_offset, mask | field.bit);
}

}  // namespace host_sim::detail
