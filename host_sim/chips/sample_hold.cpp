// sample_hold.cpp - sample-and-hold amplifier.
#include "host_sim/chips/sample_hold.hpp"

#include <fmt/format.h>

#include "host_sim/chips/settling.hpp"

namespace host_sim::chips {

void SampleHold::sample(uint64_t now_t) {
    if (!holding) return;
    holding = false;
    sample_t = now_t;
}

void SampleHold::hold(int32_t input_uv, uint64_t now_t) {
    if (holding) return;
    if (!acquired(now_t)) ++early_hold_count;
    held_uv = output_uv(input_uv, now_t);
    holding = true;
}

void SampleHold::input_jumps(int32_t input_uv, uint64_t now_t) {
    if (holding) return;
    held_uv = output_uv(input_uv, now_t);
    sample_t = now_t;
}

int32_t SampleHold::output_uv(int32_t input_uv, uint64_t now_t) const {
    if (holding) return held_uv;
    return settle_uv(held_uv, input_uv, now_t - sample_t, acquisition_t);
}

Properties SampleHold::properties() const {
    return {
        {"mode", holding ? fmt::format("holds {} uV", held_uv)
                         : fmt::format("samples since T {}", sample_t)},
        {"held too early", fmt::format("{}", early_hold_count)},
    };
}

}  // namespace host_sim::chips
