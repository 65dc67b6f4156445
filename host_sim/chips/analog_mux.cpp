// analog_mux.cpp - 16:1 analogue multiplexer.
#include "host_sim/chips/analog_mux.hpp"

#include <fmt/format.h>

#include "host_sim/chips/settling.hpp"

namespace host_sim::chips {

void AnalogMux::select(unsigned input, uint64_t now_t) {
    const auto selected = static_cast<uint8_t>(input % kChannelCount);
    if (selected == channel) return;
    from_uv = output_uv(now_t);
    channel = selected;
    selected_t = now_t;
}

int32_t AnalogMux::output_uv(uint64_t now_t) const {
    return settle_uv(from_uv, inputs_uv[channel], now_t - selected_t, settling_t);
}

Properties AnalogMux::properties(uint64_t now_t) const {
    return {
        {"channel", fmt::format("{}", channel)},
        {"output", fmt::format("{} uV{}", output_uv(now_t), settled(now_t) ? "" : ", settling")},
    };
}

}  // namespace host_sim::chips
