// log.hpp - a drive in memory: what every reader, writer, replay and report shares.
// Depends on   hal/io.hpp, hal/calibration.hpp, firmware/executive/estimates.hpp.
// Files        wide CSV and .rlog; normative description in docs/spec/log-format.md.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "firmware/executive/estimates.hpp"
#include "hal/calibration.hpp"
#include "hal/io.hpp"

namespace host_sim {

/// What really happened in a step, when the source knows: the simulated world or a camera.
/// Never an input of the controller.
struct Truth {
    double position_mm = 0;       ///< rear contact along the track
    double surface_rear_mm = 0;   ///< load-bearing surface y - s under the rear wheel
    double surface_front_mm = 0;  ///< y - s under the front wheel
    double ground_front_mm = 0;   ///< undisturbed ground y at the front wheel
    double sinkage_mm = 0;        ///< s at the front wheel
    double slip = 0;              ///< 1 - advance/odometry over the last cycle; [.., 1]
};

/// What happened to the processor right before a step.
enum class Restart : std::uint8_t {
    none,
    warm,  ///< reset; the controller went on from its checkpoint
    cold,  ///< reset; the checkpoint was dropped
};

/// One control step. Inputs are always there; the rest when its producer has run.
struct LogStep {
    std::uint32_t time_ms = 0;        ///< since the log's start, strictly increasing
    Restart restart = Restart::none;  ///< from here on ticks, pulses and steps count from 0
    hal::RawInputs inputs;
    std::optional<Truth> truth;                 ///< fields that the source lacks are NaN
    std::optional<rover::Estimates> estimates;  ///< what the controller concluded
    std::optional<hal::Commands> commands;      ///< what it commanded
};

/// Head of a log.
struct LogHead {
    std::string vehicle;  ///< vehicle description, TOML text (host_sim/vehicles/*.toml)
    hal::Calibration calibration;
    std::string image_identity;  ///< version and hash of the firmware that ran; empty: none ran
    std::map<std::string, std::string> notes;  ///< source, terrain, seed, ...: shown in the report
};

struct Log {
    LogHead head;
    std::vector<LogStep> steps;
    bool unverified = false;  ///< read from a CSV without a checksum line: edits go unnoticed
};

}  // namespace host_sim
