// spans.hpp - when something was up: alarms, lost lock, tick gaps, sensor faults, absent sensors.
// Depends on   columns.hpp, names.hpp.
// Bounds       one pass over the log per lane.
#pragma once

#include <string>
#include <vector>

#include "tools/report/columns.hpp"

namespace report {

/// In the order of importance: what is listed first when the list must be cut.
enum class LaneKind { slip_alarm, sinkage_alarm, lost_lock, fault, absent, tick_gap, overspeed };

/// One condition over the whole log.
struct Lane {
    LaneKind kind;
    std::string text;
    std::vector<signed char> up;  ///< per step: 1 while the condition holds, else 0
};

/// The lanes that are up in at least one step. A sensor that is absent from the first step to the
/// last is no lane (it is missing, see Summary), nor is the fault bit that says the same.
std::vector<Lane> lanes_of(const host_sim::Log& log);

/// One uninterrupted stretch of a lane.
struct Span {
    LaneKind kind;
    std::string text;
    std::size_t begin;  ///< first step in which it is up
    std::size_t end;    ///< one past the last step in which it is up
    bool open;          ///< still up in the last step of the log
};

/// Every stretch of every lane by its start, at most `count_max`; beyond that the least important
/// kinds are left out first. `left_out` becomes the number left out.
std::vector<Span> spans_of(const std::vector<Lane>& lanes, std::size_t count_max,
                           std::size_t& left_out);

}  // namespace report
