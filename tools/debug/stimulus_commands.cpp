// stimulus_commands.cpp - commands that do what the world does to the board. See commands.hpp.
#include <array>

#include "tools/debug/console.hpp"

namespace debug_console {

using host_sim::Stimulus;
using RangeModule = host_sim::chips::RangeModule;

namespace {

constexpr std::array<std::string_view, hal::kAdcChannelCount> kSensorNames = {
    "bogie_left",        "bogie_right",     "differential",     "pitch", "roll", "steer_front_left",
    "steer_front_right", "steer_rear_left", "steer_rear_right", "gyro",  "mast", "motor_current",
    "battery",           "proximity"};
constexpr int64_t kSensorUvMax = 15'000'000;  // the multiplexer's supply
constexpr int64_t kCountMax = 4095;
constexpr int64_t kPulsesMax = 100'000;
constexpr uint64_t kPulsePeriodT = 3072;  // 1 ms
constexpr int64_t kPeriodMaxT = 1'000'000'000;

void schedule(Console& console, Stimulus::Kind kind, uint8_t index, int32_t value,
              uint64_t later_t = 0) {
    const uint64_t t = console.stimulus_t.value_or(console.session.board.state.cpu.t);
    console.session.board.schedule({t + later_t, kind, index, value});
}

bool take_switch(Arguments& arguments) {
    if (arguments.take("on")) return true;
    if (arguments.take("off")) return false;
    throw DebugError("on or off is missing");
}

// -- Serial line
// ------------------------------------------------------------------------------------------------

void send(Console& console, Arguments& arguments) {
    std::string bytes;
    while (!arguments.empty()) {
        if (const auto text = arguments.take_quoted()) {
            bytes += *text;
        } else {
            bytes += static_cast<char>(console.take_value(arguments, "BYTE", 0, 0xFF));
        }
    }
    if (bytes.empty()) throw DebugError("BYTE or \"TEXT\" is missing");
    for (const char byte : bytes) {
        schedule(console, Stimulus::Kind::serial_byte, 0, static_cast<unsigned char>(byte));
    }
}

void serial(Console& console, Arguments& arguments) {
    using Mode = SerialDisplay::Mode;
    if (arguments.take("text")) {
        console.serial.set_mode(Mode::text);
    } else if (arguments.take("hex")) {
        console.serial.set_mode(Mode::hex);
    } else if (arguments.take("off")) {
        console.serial.set_mode(Mode::off);
    } else {
        throw DebugError("text, hex or off is missing");
    }
    arguments.expect_end();
}

// -- Sensors
// ------------------------------------------------------------------------------------------------

uint8_t take_sensor(Console& console, Arguments& arguments) {
    for (std::size_t i = 0; i < kSensorNames.size(); ++i) {
        if (arguments.take(kSensorNames[i])) return static_cast<uint8_t>(i);
    }
    return static_cast<uint8_t>(
        console.take_value(arguments, "SENSOR", 0, hal::rb85::kMuxInputCount - 1));
}

void list_sensors(Console& console) {
    const auto& inputs_uv = console.session.board.state.analog.mux.inputs_uv;
    for (std::size_t i = 0; i < inputs_uv.size(); ++i) {
        console.print("{:>2} {:<17} {:>9} uV\n", i,
                      i < kSensorNames.size() ? kSensorNames[i] : "0 V", inputs_uv[i]);
    }
}

void sensor(Console& console, Arguments& arguments) {
    if (arguments.empty()) return list_sensors(console);
    const uint8_t index = take_sensor(console, arguments);
    int32_t voltage_uv = 0;
    if (arguments.take("counts")) {
        voltage_uv = host_sim::sensor_uv_of_count(
            static_cast<uint16_t>(console.take_value(arguments, "COUNTS", 0, kCountMax)));
    } else if (arguments.take("uv")) {
        voltage_uv = static_cast<int32_t>(
            console.take_value(arguments, "MICROVOLTS", -kSensorUvMax, kSensorUvMax));
    } else {
        throw DebugError("uv VALUE or counts VALUE is missing");
    }
    arguments.expect_end();
    schedule(console, Stimulus::Kind::sensor, index, voltage_uv);
}

void tach(Console& console, Arguments& arguments) {
    const auto wheel =
        static_cast<uint8_t>(console.take_value(arguments, "WHEEL", 0, hal::kWheelCount - 1));
    const bool forward = arguments.take("forward");
    if (forward || arguments.take("backward")) {
        arguments.expect_end();
        return schedule(console, Stimulus::Kind::tach_forward, wheel, forward ? 1 : 0);
    }
    const bool in = arguments.take("in");
    if (in || arguments.take("out")) {
        arguments.expect_end();
        return schedule(console, Stimulus::Kind::tach_connected, wheel, in ? 1 : 0);
    }
    int64_t count = 1;
    uint64_t period_t = kPulsePeriodT;
    if (!arguments.empty()) count = console.take_value(arguments, "PULSES", 1, kPulsesMax);
    if (!arguments.empty()) {
        period_t = static_cast<uint64_t>(console.take_value(arguments, "PERIOD_T", 1, kPeriodMaxT));
    }
    arguments.expect_end();
    for (uint64_t i = 0; i < static_cast<uint64_t>(count); ++i) {
        schedule(console, Stimulus::Kind::tach_pulse, wheel, 0, i * period_t);
    }
}

void detectors(Console& console, Arguments& arguments) {
    const auto bits = static_cast<int32_t>(console.take_value(arguments, "BITS", 0, 0xFF));
    arguments.expect_end();
    schedule(console, Stimulus::Kind::detectors, 0, bits);
}

void scan(Console& console, Arguments& arguments) {
    RangeModule::Heights heights_q1_mm{};
    unsigned present = 0;
    if (arguments.empty()) throw DebugError("HEIGHT is missing");
    for (unsigned i = 0; !arguments.empty(); ++i) {
        if (i == RangeModule::kSampleCount) {
            throw DebugError(
                fmt::format("a scan has at most {} samples", RangeModule::kSampleCount));
        }
        if (arguments.take("none")) continue;
        heights_q1_mm[i] =
            static_cast<int16_t>(console.take_value(arguments, "HEIGHT", INT16_MIN, INT16_MAX));
        present |= 1U << i;
    }
    console.session.board.set_range_scan(static_cast<uint8_t>(present), heights_q1_mm);
}

// -- Lines
// ------------------------------------------------------------------------------------------------

void trap(Console& console, Arguments& arguments) {
    const bool undervoltage = arguments.take("undervoltage");
    if (!undervoltage && !arguments.take("bumper")) {
        throw DebugError("undervoltage or bumper is missing");
    }
    const bool on = take_switch(arguments);
    arguments.expect_end();
    schedule(console, undervoltage ? Stimulus::Kind::undervoltage : Stimulus::Kind::bumper, 0,
             on ? 1 : 0);
}

void service(Console& console, Arguments& arguments) {
    const bool on = take_switch(arguments);
    arguments.expect_end();
    schedule(console, Stimulus::Kind::service, 0, on ? 1 : 0);
}

void reset(Console& console, Arguments& arguments) {
    arguments.expect_end();
    if (console.stimulus_t) return schedule(console, Stimulus::Kind::reset_button, 0, 0);
    const uint64_t t = console.session.board.state.cpu.t;
    console.session.reset();
    console.report({}, t, console.session.board.state.reset_count);
}

void power(Console& console, Arguments& arguments) {
    arguments.expect_end();
    const uint64_t t = console.session.board.state.cpu.t;
    console.session.power_cycle();
    console.report({}, t, console.session.board.state.reset_count);
}

void at(Console& console, Arguments& arguments) {
    const uint64_t t = parse_time(arguments.word("TIME"), console.session.board.state.cpu.t);
    const Command& command = console.find_command(arguments.word("COMMAND"));
    if (!command.stimulus) {
        throw DebugError(
            fmt::format("{} cannot be scheduled; `help at` lists what can", command.name));
    }
    console.stimulus_t = t;
    try {
        command.run(console, arguments);
    } catch (...) {
        console.stimulus_t.reset();
        throw;
    }
    console.stimulus_t.reset();
}

}  // namespace

std::vector<Command> stimulus_commands() {
    return {
        {"send", "", "send BYTE|\"TEXT\"...", "characters to the board's serial line",
         "At 19,200 baud, one behind the other.\n  send \"status\\r\"\n  send 7EH 1 2\n", send,
         true},
        {"serial", "", "serial text|hex|off", "how the characters from the board are shown",
         "  serial hex\n", serial},
        {"sensor", "", "sensor [NAME|INDEX uv|counts VALUE]",
         "voltage at an input of the multiplexer, or list all",
         "  sensor\n  sensor pitch counts 2048\n  sensor 12 uv 1500000\n", sensor, true},
        {"tach", "", "tach WHEEL [PULSES [PERIOD_T]] | tach WHEEL forward|backward|in|out",
         "tachometer pulses of a wheel, its direction, or its plug",
         "Pulses come every 1 ms (3072 T) when no period is given, the first one at once.\n"
         "  tach 0 10\n  tach 5 100 614\n  tach 5 backward\n  tach 3 out\n",
         tach, true},
        {"detectors", "", "detectors BITS", "the eight laser detector bits",
         "  detectors 00000101B\n", detectors, true},
        {"scan", "", "scan HEIGHT|none...", "a scan of the range module, up to 8 heights in 0.5 mm",
         "  scan 0 -12 none 40\n", scan},
        {"trap", "", "trap undervoltage|bumper on|off", "what pulls TRAP", "  trap bumper on\n",
         trap, true},
        {"service", "", "service on|off", "the service jumper at SID", "  service on\n", service,
         true},
        {"reset", "", "reset", "press RESET", "  reset\n", reset, true},
        {"power", "", "power", "take the supply away and give it back",
         "RAM and EEPROM keep their contents.\n  power\n", power},
        {"at", "", "at TIME COMMAND", "let a stimulus happen later",
         "For send, sensor, tach, detectors, trap, service and reset. TIME as for `until`.\n"
         "  at +10ms send \"go\\r\"\n  at 500000 trap undervoltage on\n",
         at},
    };
}

}  // namespace debug_console
