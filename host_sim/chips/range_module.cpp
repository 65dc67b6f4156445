// range_module.cpp - look-ahead range module.
#include "host_sim/chips/range_module.hpp"

#include <fmt/format.h>

namespace host_sim::chips {

void RangeModule::set_scan(uint8_t present, const Heights& heights_q1_mm) {
    set_scan(static_cast<uint8_t>(scan_counter + 1), present, heights_q1_mm);
}

void RangeModule::set_scan(uint8_t counter, uint8_t present, const Heights& heights_q1_mm) {
    scan_counter = counter;
    scan_present = present;
    for (unsigned i = 0; i < kSampleCount; ++i) {
        scan_q1_mm[i] = (present >> i & 1) != 0 ? heights_q1_mm[i] : int16_t{0};
    }
}

void RangeModule::take_frame() {
    frame[0] = scan_counter;
    frame[1] = scan_present;
    for (unsigned i = 0; i < kSampleCount; ++i) {
        const auto bits = static_cast<uint16_t>(scan_q1_mm[i]);
        frame[2 + 2 * i] = static_cast<uint8_t>(bits & 0xFF);
        frame[3 + 2 * i] = static_cast<uint8_t>(bits >> 8);
    }
    uint8_t checksum = kFrameSum;
    for (unsigned i = 0; i + 1 < kFrameSize; ++i) {
        checksum = static_cast<uint8_t>(checksum - frame[i]);
    }
    frame[kFrameSize - 1] = checksum;
    served_count = 0;
}

void RangeModule::set_connected(bool plugged, uint64_t now_t) {
    advance(now_t);
    if (plugged == connected) return;
    connected = plugged;
    release();
    if (plugged && select_line) {
        take_frame();
        serve(now_t);
    }
}

void RangeModule::set_lines(bool select, bool strobe, uint64_t now_t) {
    advance(now_t);
    const bool rises = select && !select_line;
    if (serving && select && strobe != strobe_line) ++early_strobe_count;
    select_line = select;
    strobe_line = strobe;
    if (!connected) return;
    if (!select) {
        release();
    } else if (rises) {
        take_frame();
        serve(now_t);
    } else if (!serving && strobe != acknowledge_line) {
        serve(now_t);
    }
}

void RangeModule::advance(uint64_t now_t) {
    while (serving && ready_t <= now_t) {
        serving = false;
        if (served_count < kFrameSize) {
            lines = frame[served_count++];
        } else {
            lines = kOpenBus;
            ++overread_count;
        }
        acknowledge_line = serving_level;
        if (strobe_line != acknowledge_line) serve(ready_t);
    }
}

// Nothing is driven: the pull-ups win.
void RangeModule::release() {
    serving = false;
    lines = kOpenBus;
    acknowledge_line = true;
}

// The module looks at STROBE now and again when this byte is out; edges between are not seen.
void RangeModule::serve(uint64_t from_t) {
    serving = true;
    serving_level = strobe_line;
    ready_t = from_t + service_t;
}

Properties RangeModule::properties() const {
    return {
        {"module", connected ? "connected" : "absent"},
        {"scan counter", fmt::format("{}", scan_counter)},
        {"samples present", fmt::format("{:08b}b", scan_present)},
        {"SELECT, STROBE, ACKNOWLEDGE", fmt::format("{} {} {}", select_line ? 1 : 0,
                                                    strobe_line ? 1 : 0, acknowledge_line ? 1 : 0)},
        {"bytes served of this frame", fmt::format("{}", served_count)},
        {"strobes too early", fmt::format("{}", early_strobe_count)},
        {"bytes asked for behind the frame", fmt::format("{}", overread_count)},
    };
}

}  // namespace host_sim::chips
