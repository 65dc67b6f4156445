// words.cpp - see words.hpp.
#include "tools/monitor/words.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

#include "tools/report/names.hpp"

namespace monitor {
namespace {

using rover::Estimates;

struct BitName {
    unsigned bit;
    const char* name;
};

constexpr std::array<BitName, 5> kAlarmNames = {{
    {rover::kEventSlipAlarm, "SLIP"},
    {rover::kEventSinkageAlarm, "SINKAGE"},
    {rover::kEventLostLock, "lost lock"},
    {rover::kEventOverspeed, "overspeed"},
    {rover::kEventTickGap, "tick gap"},
}};
constexpr std::array<BitName, 10> kBoardFaultNames = {{
    {rover::kFaultRom, "ROM check wrong (drives off)"},
    {rover::kFaultRam, "RAM test failed (drives off)"},
    {rover::kFaultStack, "stack overwritten (drives off)"},
    {rover::kFaultStepLate, "step late"},
    {rover::kFaultLinkLost, "link bytes or frames lost"},
    {rover::kFaultConverter, "converter without an end"},
    {rover::kFaultNoRecord, "no calibration record"},
    {rover::kFaultNoCheckpoint, "no checkpoint"},
    {rover::kTrapUndervoltage << 8U, "undervoltage (drives off)"},
    {rover::kTrapBumper << 8U, "bumper (drives off)"},
}};
constexpr std::array<const char*, 4> kResetCauses = {"power-up", "watchdog", "restart frame",
                                                     "button, or a hang"};

std::string names_of(unsigned bits, std::span<const BitName> names) {
    std::string text;
    for (const BitName& each : names) {
        if ((bits & each.bit) == 0) continue;
        if (!text.empty()) text += ", ";
        text += each.name;
        bits &= ~each.bit;
    }
    if (bits != 0) text += fmt::format("{}bits {:04X}H", text.empty() ? "" : ", ", bits);
    return text.empty() ? "none" : text;
}

double metres(int32_t q4_mm) {
    return q4_mm / 16.0 / 1000.0;
}

/// To a tenth, and without a negative zero.
double degrees(int16_t brad) {
    return std::round(brad * 3600.0 / 65536.0) / 10.0 + 0.0;
}

bool has(const Estimates& estimates, unsigned available) {
    return (estimates.available & available) != 0;
}

std::string angle(const Estimates& estimates, unsigned available, int16_t brad) {
    return has(estimates, available) ? fmt::format("{:+.1f}°", degrees(brad)) : "-";
}

/// Seconds since reset, by the rover's steps.
double seconds(const Telemetry& telemetry) {
    return static_cast<double>(telemetry.step) / 10.0;
}

const char* mode_name(const Estimates& estimates) {
    return report::kModeNames[static_cast<std::size_t>(estimates.mode)];
}

std::string position(const Estimates& estimates) {
    if (!has(estimates, rover::kAvailableOdometry)) return "-";
    return fmt::format("{:.3f} m ±{:.3f}", metres(estimates.position_q4_mm),
                       metres(estimates.position_sigma_q4_mm));
}

std::string odometer(const Estimates& estimates) {
    if (!has(estimates, rover::kAvailableOdometry)) return "-";
    return fmt::format("{:.3f} m", metres(estimates.odometer_q4_mm));
}

std::string slip(const Estimates& estimates) {
    if (!has(estimates, rover::kAvailableSlip)) return "-";
    return fmt::format("{} %", estimates.slip_percent);
}

std::string sinkage(const Estimates& estimates) {
    if (!has(estimates, rover::kAvailableSinkage)) return "-";
    return fmt::format("{:.1f} mm", estimates.sinkage_q4_mm / 16.0);
}

std::string attitude(const Estimates& e) {
    return fmt::format("pitch {} roll {} rocker {} bogie {}",
                       angle(e, rover::kAvailableAttitude, e.pitch_brad),
                       angle(e, rover::kAvailableAttitude, e.roll_brad),
                       angle(e, rover::kAvailableLinkage, e.rocker_brad),
                       angle(e, rover::kAvailableLinkage, e.bogie_brad));
}

std::string reset_words(const rover::BoardStatus& status) {
    return fmt::format("reset {}: {}, {} start", status.reset_count,
                       kResetCauses[static_cast<std::size_t>(status.reset_cause)],
                       status.warm != 0 ? "warm" : "cold");
}

std::string loss_words(const rover::BoardStatus& status) {
    return fmt::format(
        "steps late {}, left out {}; bytes received {}, dropped {}, wrong {}; frames left out {}, "
        "refused {}; traps {}",
        status.late_steps, status.missed_steps, status.received, status.receive_dropped,
        status.receive_errors, status.frames_dropped, status.frames_refused, status.trap_count);
}

}  // namespace

std::string alarm_names(const Estimates& estimates) {
    constexpr unsigned kNoAlarms = rover::kEventCycle | rover::kEventSensorFault;
    return names_of(estimates.events & ~kNoAlarms, kAlarmNames);
}

std::string sensor_fault_names(const Estimates& estimates) {
    std::array<BitName, report::kFaultNames.size()> names{};
    for (std::size_t i = 0; i < names.size(); ++i) {
        names[i] = {report::kFaultNames[i].bit, report::kFaultNames[i].text};
    }
    return names_of(estimates.faults, names);
}

std::string board_fault_names(uint16_t faults) {
    return names_of(faults, kBoardFaultNames);
}

std::string telemetry_line(const Telemetry& telemetry) {
    const Estimates& e = telemetry.estimates;
    return fmt::format(
        "step {} {:.1f} s: position {}, odometer {}, slip {}, sinkage {}, {}; {}; alarms: {}; "
        "sensor faults: {}",
        telemetry.step, seconds(telemetry), position(e), odometer(e), slip(e), sinkage(e),
        attitude(e), mode_name(e), alarm_names(e), sensor_fault_names(e));
}

std::string status_line(const rover::BoardStatus& status) {
    return fmt::format("status: {}; faults: {}; of the run before: {}; {}", reset_words(status),
                       board_fault_names(status.faults), board_fault_names(status.last_faults),
                       loss_words(status));
}

std::string identity_line(const host_sim::ImageIdentity& identity) {
    return "identity: " + host_sim::describe(identity);
}

std::string notice(const Telemetry& telemetry) {
    std::string text;
    if (telemetry.restart != host_sim::Restart::none) {
        text = fmt::format("the rover was reset and has started {}",
                           telemetry.restart == host_sim::Restart::warm ? "warm" : "cold");
    }
    if (telemetry.missing != 0) {
        text += fmt::format("{}no telemetry of {} step{} before step {}", text.empty() ? "" : "; ",
                            telemetry.missing, telemetry.missing == 1 ? "" : "s", telemetry.step);
    }
    return text;
}

std::string link_words(const Counts& counts) {
    return fmt::format(
        "{} telemetry frames, {} steps missing, {} frames refused, {} stray bytes, {} restarts",
        counts.telemetry, counts.steps_missing, counts.refused, counts.stray_bytes,
        counts.restarts);
}

std::vector<std::string> screen(const Known& known) {
    std::vector<std::string> lines;
    lines.push_back(fmt::format(
        "{}   {}", known.port,
        known.identity ? host_sim::describe_sources(*known.identity) : "identity not known yet"));
    if (known.telemetry) {
        const Estimates& e = known.telemetry->estimates;
        lines.push_back(fmt::format("time      {:.1f} s since reset, step {}",
                                    seconds(*known.telemetry), known.telemetry->step));
        lines.push_back(fmt::format("position  {}   odometer {}", position(e), odometer(e)));
        lines.push_back(fmt::format("slip      {}   sinkage {}   cycles {}   {}", slip(e),
                                    sinkage(e), e.cycle_count, mode_name(e)));
        lines.push_back("angles    " + attitude(e));
        lines.push_back("alarms    " + alarm_names(e));
        lines.push_back("sensors   faults: " + sensor_fault_names(e));
    }
    if (known.status) {
        lines.push_back("board     " + reset_words(*known.status));
        lines.push_back("          faults: " + board_fault_names(known.status->faults));
    }
    lines.push_back("link      " + link_words(known.counts));
    return lines;
}

}  // namespace monitor
