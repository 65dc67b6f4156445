// host_target.hpp - the controller as a native program: one of its two targets.
// Depends on   firmware/executive/controller.hpp.
// Contract     what comes out is what a board would send: commands, and estimates read back from
//              the telemetry frame, never from the controller's memory.
#pragma once

#include <memory>
#include <string>

#include "host_sim/bind/controller_target.hpp"

namespace host_sim {

/// Version and content hash of the firmware sources that this program was built from, and target.
std::string host_image_identity();

/// The native controller.
std::unique_ptr<ControllerTarget> make_host_target();

/// drive() and replay() on it.
Log drive_on_host(Drive& world, LogHead head, const DriveProgress& progress = {});
void replay_on_host(Log& log, const DriveProgress& progress = {});

}  // namespace host_sim
