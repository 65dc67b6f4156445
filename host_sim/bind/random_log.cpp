// random_log.cpp - see random_log.hpp.
#include "host_sim/bind/random_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "host_sim/bind/host_target.hpp"
#include "host_sim/bind/link_frames.hpp"
#include "host_sim/world/input_walk.hpp"

namespace host_sim {
namespace {

/// Now and then the ground asks something, or the link picks up rubbish.
void add_link_bytes(Random& random, hal::RawInputs& inputs) {
    std::vector<uint8_t> bytes;
    const double draw = random.uniform();
    if (draw < 0.03) {
        bytes = uplink_frame(draw < 0.015 ? UplinkType::status : UplinkType::identity);
    } else if (draw < 0.06) {
        bytes.resize(1 + static_cast<std::size_t>(random.uniform() * hal::kCommandBytesMax));
        for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random.bits() >> 40);
    } else {
        return;
    }
    inputs.command_size = static_cast<uint8_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), inputs.command);
}

}  // namespace

hal::RawInputs canonical(hal::RawInputs inputs) {
    for (uint16_t& channel : inputs.adc_q4_count) {
        if (channel > hal::kAdcMaxQ4Count) channel = hal::kAdcAbsent;
    }
    inputs.tach_present = static_cast<uint8_t>(inputs.tach_present & 0x3F);
    for (std::size_t i = 0; i < hal::kWheelCount; ++i) {
        if ((inputs.tach_present >> i & 1) == 0) inputs.tach_count[i] = 0;
    }
    for (std::size_t i = 0; i < hal::kRangeSampleCount; ++i) {
        if ((inputs.range_present >> i & 1) == 0) inputs.range_q1_mm[i] = 0;
    }
    for (std::size_t i = inputs.command_size; i < hal::kCommandBytesMax; ++i) inputs.command[i] = 0;
    return inputs;
}

Log random_log(uint64_t seed, std::size_t steps_max) {
    InputWalk walk(seed);
    Random random = stream(seed, "restarts and link");
    const double restart_chance = random.uniform() < 0.4 ? 0.03 : 0.0;
    const bool talks = random.uniform() < 0.5;
    const std::unique_ptr<ControllerTarget> host = make_host_target();
    Log log;
    log.head.notes["random_seed"] = fmt::format("{}", seed);
    hal::Commands commands;
    while (log.steps.size() < steps_max) {
        const InputWalk::Next next = walk.next(commands);
        if (log.steps.empty()) {
            log.head.calibration = next.calibration;
            host->begin(next.calibration);
        } else if (next.reset) {
            break;
        }
        const std::size_t index = log.steps.size();
        LogStep& step = log.steps.emplace_back();
        step.time_ms = static_cast<uint32_t>(100 * index);
        step.inputs = next.inputs;
        if (talks) add_link_bytes(random, step.inputs);
        step.inputs = canonical(step.inputs);
        if (random.uniform() < restart_chance) {
            step.restart = random.uniform() < 0.7 ? Restart::warm : Restart::cold;
        }
        host->step(log.steps, index);
        commands = *log.steps[index].commands;
    }
    host->finish(log.steps);
    log.head.image_identity = host->identity();
    return log;
}

}  // namespace host_sim
