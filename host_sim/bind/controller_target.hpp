// controller_target.hpp - where a controller runs: the steps that a log is made of, one by one.
// Depends on   host_sim/log, host_sim/world.
// Targets      host_target.hpp (native), board_target.hpp (the image on the simulated board).
// Design note  docs/design/targets.md
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "host_sim/log/log.hpp"
#include "host_sim/world/drive.hpp"

namespace host_sim {

/// A controller that can be switched on, reset and stepped.
class ControllerTarget {
public:
    ControllerTarget() = default;
    ControllerTarget(const ControllerTarget&) = delete;
    ControllerTarget& operator=(const ControllerTarget&) = delete;
    virtual ~ControllerTarget() = default;

    /// Switches on, with this calibration record and no checkpoint.
    virtual void begin(const hal::Calibration& calibration) = 0;
    /// Version and content hash of the firmware sources, and the target. @pre begin()
    [[nodiscard]] virtual std::string identity() const = 0;
    /// Carries out the restart that the step asks for, then the step with its inputs. Fills in
    /// commands at once; telemetry and estimates at the latest by finish().
    /// @param index  of the step; steps come in their order
    virtual void step(std::vector<LogStep>& steps, std::size_t index) = 0;
    /// Waits for what is still under way.
    virtual void finish(std::vector<LogStep>& steps) = 0;
};

/// Called now and then with the share done, [0, 1].
using DriveProgress = std::function<void(double)>;

/// Drives the simulated vehicle until the course ends.
/// @param head       calibration and notes of the log; the image identity is filled in
/// @param resets_s   in ascending order: at the first step from then on the processor is reset and
///                   starts warm. The vehicle stands for no time; ticks and pulses begin at 0
/// @return  every step with inputs, truth, estimates and commands
Log drive(ControllerTarget& target, Drive& world, LogHead head, const DriveProgress& progress = {},
          const std::vector<double>& resets_s = {});

/// Feeds every row's inputs and restarts to a target that is switched on for it. Estimates,
/// commands and identity of the log are replaced; inputs, times and truth stay.
void replay(ControllerTarget& target, Log& log, const DriveProgress& progress = {});

}  // namespace host_sim
