#include "host_sim/bind/host_target.hpp"

#include <stdexcept>
#include <utility>

#include "firmware/executive/controller.hpp"
#include "firmware/executive/pose_record.hpp"
#include "firmware_identity.hpp"

namespace host_sim {
namespace {

class HostTarget final : public ControllerTarget {
public:
    void begin(const hal::Calibration& calibration) override {
        calibration_ = calibration;
        restart(Restart::cold);
    }

    [[nodiscard]] std::string identity() const override { return host_image_identity(); }

    void step(std::vector<LogStep>& steps, std::size_t index) override {
        LogStep& step = steps[index];
        if (step.restart != Restart::none) restart(step.restart);
        step.commands = rover::controller_step(controller_, step.inputs);
        has_checkpoint_ = true;
        rover::Estimates estimates;
        if (!rover::read_telemetry(step.commands->telemetry, step.commands->telemetry_size,
                                   estimates)) {
            throw std::logic_error("the controller's own telemetry frame does not read back");
        }
        step.estimates = estimates;
    }

    void finish(std::vector<LogStep>&) override {}

private:
    void restart(Restart kind) {
        const rover::PoseRecord checkpoint = rover::pose_record(controller_);
        controller_ = {};
        rover::controller_reset(controller_, calibration_);
        if (kind == Restart::warm && has_checkpoint_) {
            rover::controller_resume(controller_, checkpoint);
        }
        if (kind == Restart::cold) has_checkpoint_ = false;
    }

    hal::Calibration calibration_;
    rover::Controller controller_;
    bool has_checkpoint_ = false;
};

}  // namespace

std::string host_image_identity() {
    return std::string("rover85 ") + kFirmwareVersion + " sources " + kFirmwareSourceHash + " host";
}

std::unique_ptr<ControllerTarget> make_host_target() {
    return std::make_unique<HostTarget>();
}

Log drive_on_host(Drive& world, LogHead head, const DriveProgress& progress) {
    HostTarget target;
    return drive(target, world, std::move(head), progress);
}

void replay_on_host(Log& log, const DriveProgress& progress) {
    HostTarget target;
    replay(target, log, progress);
}

}  // namespace host_sim
