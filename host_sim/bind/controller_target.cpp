// controller_target.cpp - see controller_target.hpp.
#include "host_sim/bind/controller_target.hpp"

#include <algorithm>
#include <utility>

namespace host_sim {
namespace {

constexpr std::size_t kProgressEverySteps = 64;

/// What the processor counted before its last reset, and so does not count any more.
class CountsSinceReset {
public:
    void restart(const hal::RawInputs& inputs) {
        tick_count_ = inputs.tick_count;
        std::copy(std::begin(inputs.tach_count), std::end(inputs.tach_count), tach_count_);
    }
    void apply(hal::RawInputs& inputs) const {
        inputs.tick_count = static_cast<std::uint16_t>(inputs.tick_count - tick_count_);
        for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
            if ((inputs.tach_present >> wheel & 1) == 0) continue;
            inputs.tach_count[wheel] =
                static_cast<std::uint16_t>(inputs.tach_count[wheel] - tach_count_[wheel]);
        }
    }

private:
    std::uint16_t tick_count_ = 0;
    std::uint16_t tach_count_[hal::kWheelCount] = {};
};

}  // namespace

Log drive(ControllerTarget& target, Drive& world, LogHead head, const DriveProgress& progress,
          const std::vector<double>& resets_s) {
    Log log;
    log.head = std::move(head);
    const double length_cm = world.options().length_cm;
    log.steps.reserve(static_cast<std::size_t>(
        12.0 * length_cm / std::max(world.options().vehicle.speed_cm_per_s, 0.01)));
    target.begin(log.head.calibration);
    log.head.image_identity = target.identity();
    CountsSinceReset counts;
    auto next_reset = resets_s.begin();
    hal::Commands commands;  // the vehicle stands until the controller has spoken
    while (!world.finished()) {
        const std::size_t index = log.steps.size();
        LogStep& step = log.steps.emplace_back();
        DriveStep driven = world.step(commands);
        step.time_ms = static_cast<std::uint32_t>(100 * index);
        if (next_reset != resets_s.end() && step.time_ms >= 1000 * *next_reset - 1e-6) {
            ++next_reset;
            step.restart = Restart::warm;
            counts.restart(driven.inputs);
        }
        counts.apply(driven.inputs);
        step.inputs = driven.inputs;
        step.truth = driven.truth;
        target.step(log.steps, index);
        commands = *log.steps[index].commands;
        if (progress && index % kProgressEverySteps == 0) {
            progress(std::clamp(world.state().position_cm / length_cm, 0.0, 1.0));
        }
    }
    target.finish(log.steps);
    if (progress) progress(1.0);
    return log;
}

void replay(ControllerTarget& target, Log& log, const DriveProgress& progress) {
    target.begin(log.head.calibration);
    log.head.image_identity = target.identity();
    for (std::size_t i = 0; i < log.steps.size(); ++i) {
        target.step(log.steps, i);
        if (progress && i % kProgressEverySteps == 0) {
            progress(static_cast<double>(i) / static_cast<double>(log.steps.size()));
        }
    }
    target.finish(log.steps);
    if (progress) progress(1.0);
}

}  // namespace host_sim
