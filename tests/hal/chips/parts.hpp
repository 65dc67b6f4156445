// parts.hpp - the drivers of RB-85 on a bus that records, and on the chip models.
// Depends on   hal, host_sim/bind/sim_bus.hpp, tests/support/recording_bus.hpp.
#pragma once

#include "hal/board/rb85_parts.hpp"
#include "host_sim/bind/sim_bus.hpp"
#include "tests/support/recording_bus.hpp"

namespace hal_test {

using Recorded = hal::Rb85Parts<test_support::RecordingBus>;
using Script = test_support::RecordingBus::Script;

using Simulated = hal::Rb85Parts<host_sim::SimBus>;
using host_sim::SimBoard;
using host_sim::Stimulus;

}  // namespace hal_test
