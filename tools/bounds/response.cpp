// response.cpp - see response.hpp.
#include "tools/bounds/response.hpp"

#include <algorithm>

namespace rover_bounds {
namespace {

/// An instruction that has just missed a request: the longest of the 8085 (CALL, RST 18 T).
constexpr uint64_t kInstructionT = 18;

}  // namespace

std::optional<uint64_t> response_time(uint64_t first_t, const std::vector<Demand>& cut_in,
                                      uint64_t most_t) {
    for (uint64_t response = first_t; response <= most_t;) {
        uint64_t next = first_t;
        for (const Demand& demand : cut_in) {
            // What comes at the very end of the response comes into it.
            next += (response / demand.period_t + 1) * demand.t;
        }
        if (next == response) return response;
        response = next;
    }
    return {};
}

std::vector<Deadline> deadlines(const Workload& load, const Timing& timing) {
    const Demand trap{load.trap, timing.step_t};
    const Demand tick{load.tick, timing.tick_t};
    const Demand tick_begins{load.tick_disabled, timing.tick_t};
    const Demand receive{load.receive, timing.character_t};
    const Demand transmit{load.transmit, timing.character_t};
    const uint64_t main_blocks = kInstructionT + load.main_disabled;

    std::vector<Deadline> found;
    const auto add = [&](const char* what, uint64_t blocking, uint64_t own_t,
                         const std::vector<Demand>& cut_in, uint64_t deadline_t) {
        found.push_back(
            {what, own_t, response_time(blocking + own_t, cut_in, deadline_t), deadline_t});
    };
    // Of the serial handlers each holds up the other, and the tick both with its beginning only.
    add("character received", std::max(main_blocks, kInstructionT + load.transmit), load.receive,
        {trap, tick_begins}, timing.character_t);
    add("character to send", main_blocks, load.transmit, {trap, tick_begins, receive},
        timing.character_t);
    const uint64_t serial = kInstructionT + std::max(load.receive, load.transmit);
    add("tick", std::max(main_blocks, serial), load.tick, {trap, receive, transmit}, timing.tick_t);
    add("step", 0, load.wake + load.step, {trap, tick, receive, transmit}, timing.step_t);
    return found;
}

}  // namespace rover_bounds
