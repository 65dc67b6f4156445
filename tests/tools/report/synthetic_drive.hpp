// synthetic_drive.hpp - drives with every feature that a report shows, made from formulas alone.
// Not a simulation: the numbers only have to look like a drive and be known to the tests.
#pragma once

#include <cstddef>

#include "host_sim/log/log.hpp"

namespace report_test {

/// A 62.5 m drive with truth and estimates over rough ground: slip and sinkage with two soft
/// patches (slip alarm at 20 to 23 m, sinkage alarm at 40 to 42 m), a one-step slip alarm, a loss
/// of lock, a tick gap, a range module that falls silent and a bogie potentiometer that fails.
host_sim::Log full_drive(std::size_t step_count);

/// A vehicle without suspension sensors or truth: tachometers of the front wheels, inclinometer.
host_sim::Log bare_drive(std::size_t step_count);

}  // namespace report_test
