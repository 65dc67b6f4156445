// words.hpp - messages from the rover in words: lines for people.
// Depends on   receiver.hpp.
// Rule         an estimate whose sensors are missing is shown as "-", never as a number.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/monitor/receiver.hpp"

namespace monitor {

/// Names of the bits that are set, "none" when none is: alarms of a telemetry frame, its sensor
/// faults, and the faults of a status frame.
[[nodiscard]] std::string alarm_names(const rover::Estimates& estimates);
[[nodiscard]] std::string sensor_fault_names(const rover::Estimates& estimates);
[[nodiscard]] std::string board_fault_names(uint16_t faults);

/// One line for each message.
[[nodiscard]] std::string telemetry_line(const Telemetry& telemetry);
[[nodiscard]] std::string status_line(const rover::BoardStatus& status);
[[nodiscard]] std::string identity_line(const host_sim::ImageIdentity& identity);

/// What a frame tells beside its content: steps missing, a restart. Empty: nothing.
[[nodiscard]] std::string notice(const Telemetry& telemetry);

/// Losses of the link in words.
[[nodiscard]] std::string link_words(const Counts& counts);

/// All that is known, as the lines of a screen of 80 columns.
struct Known {
    std::string port;
    std::optional<host_sim::ImageIdentity> identity;
    std::optional<rover::BoardStatus> status;
    std::optional<Telemetry> telemetry;
    Counts counts;
};
[[nodiscard]] std::vector<std::string> screen(const Known& known);

}  // namespace monitor
