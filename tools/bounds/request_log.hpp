// request_log.hpp - a log whose every step has as many requests from the ground as the link takes.
// Depends on   host_sim/log, host_sim/bind/link_frames.hpp.
#pragma once

#include "host_sim/log/log.hpp"

namespace rover_bounds {

/// The same drive under a stream of calibration, status, identity and refused frames without a
/// pause, 16 bytes a step. The frames' ends fall on every byte of a step in turn. The calibration
/// is the log's own.
[[nodiscard]] host_sim::Log with_requests(host_sim::Log log);

}  // namespace rover_bounds
