// host_target.hpp - the controller as a native program: one of its two targets.
// Depends on   firmware/executive/controller.hpp.
// Contract     what comes out is what a board would send: commands, and estimates read back from
//              the telemetry frame, never from the controller's memory.
#pragma once

#include <functional>
#include <string>

#include "host_sim/log/log.hpp"
#include "host_sim/world/drive.hpp"

namespace host_sim {

/// Version and content hash of the firmware sources that this program was built from, and target.
std::string host_image_identity();

/// Called now and then with the share done, [0, 1].
using DriveProgress = std::function<void(double)>;

/// Drives the simulated vehicle with the native controller until the course ends.
/// @param head  calibration and notes of the log; the image identity is filled in
/// @return  every step with inputs, truth, estimates and commands
Log drive_on_host(Drive& drive, LogHead head, const DriveProgress& progress = {});

/// Feeds every row's inputs to a freshly reset native controller. Estimates and commands of the log
/// are replaced; inputs, times and truth stay.
void replay_on_host(Log& log, const DriveProgress& progress = {});

}  // namespace host_sim
