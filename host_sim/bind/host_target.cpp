#include "host_sim/bind/host_target.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include "firmware/executive/controller.hpp"
#include "firmware_identity.hpp"

namespace host_sim {
namespace {

constexpr std::size_t kProgressEverySteps = 1024;

class HostController {
public:
    explicit HostController(const hal::Calibration& calibration) {
        rover::controller_reset(controller_, calibration);
    }

    void step(LogStep& step) {
        step.commands = rover::controller_step(controller_, step.inputs);
        rover::Estimates estimates;
        if (!rover::read_telemetry(step.commands->telemetry, step.commands->telemetry_size,
                                   estimates)) {
            throw std::logic_error("the controller's own telemetry frame does not read back");
        }
        step.estimates = estimates;
    }

private:
    rover::Controller controller_;
};

}  // namespace

std::string host_image_identity() {
    return std::string("rover85 ") + kFirmwareVersion + " sources " + kFirmwareSourceHash + " host";
}

Log drive_on_host(Drive& drive, LogHead head, const DriveProgress& progress) {
    Log log;
    log.head = std::move(head);
    log.head.image_identity = host_image_identity();
    const double length_cm = drive.options().length_cm;
    log.steps.reserve(static_cast<std::size_t>(
        12.0 * length_cm / std::max(drive.options().vehicle.speed_cm_per_s, 0.01)));
    HostController controller(log.head.calibration);
    hal::Commands commands;  // the vehicle stands until the controller has spoken
    while (!drive.finished()) {
        LogStep& step = log.steps.emplace_back();
        DriveStep driven = drive.step(commands);
        step.time_ms = static_cast<std::uint32_t>(100 * (log.steps.size() - 1));
        step.inputs = driven.inputs;
        step.truth = driven.truth;
        controller.step(step);
        commands = *step.commands;
        if (progress && log.steps.size() % kProgressEverySteps == 0) {
            progress(std::clamp(drive.state().position_cm / length_cm, 0.0, 1.0));
        }
    }
    if (progress) progress(1.0);
    return log;
}

void replay_on_host(Log& log, const DriveProgress& progress) {
    log.head.image_identity = host_image_identity();
    HostController controller(log.head.calibration);
    for (std::size_t i = 0; i < log.steps.size(); ++i) {
        controller.step(log.steps[i]);
        if (progress && i % kProgressEverySteps == 0) {
            progress(static_cast<double>(i) / static_cast<double>(log.steps.size()));
        }
    }
    if (progress) progress(1.0);
}

}  // namespace host_sim
