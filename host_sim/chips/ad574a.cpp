// ad574a.cpp - AD574A: successive approximation bit by bit.
#include "host_sim/chips/ad574a.hpp"

#include <fmt/format.h>

namespace host_sim::chips {
namespace {

constexpr uint8_t kResolution = 12;
constexpr unsigned kA0 = 1;

}  // namespace

Ad574a::Ad574a(uint64_t clock_hz, const Settings& wanted)
    : settings(wanted),
      conversion12_t(t_states_from_ns(wanted.conversion12_ns, clock_hz)),
      conversion8_t(t_states_from_ns(wanted.conversion8_ns, clock_hz)) {}

uint8_t Ad574a::read(uint16_t address, uint64_t now_t) {
    advance(now_t);
    if (converting) {
        ++busy_read_count;
        return kOpenBus;
    }
    return static_cast<uint8_t>((address & kA0) == 0 ? code >> 4 : (code & 0x0F) << 4);
}

void Ad574a::write(uint16_t address, uint8_t /*value*/, uint64_t now_t) {
    advance(now_t);
    if (converting) {
        ++busy_start_count;
        return;
    }
    converting = true;
    start_t = now_t;
    bit_count = (address & kA0) == 0 ? kResolution : 8;
    duration_t = bit_count == kResolution ? conversion12_t : conversion8_t;
    bits_decided = 0;
    input_moved = false;
    code = 0;
}

uint64_t Ad574a::decision_t(uint8_t bit) const {
    return start_t + (bit + 1u) * duration_t / bit_count;
}

uint64_t Ad574a::next_event_t() const {
    return converting ? decision_t(bits_decided) : kNever;
}

void Ad574a::advance(uint64_t now_t) {
    while (converting && decision_t(bits_decided) <= now_t) decide_bit();
}

// The code n begins half a count below its nominal voltage low + n * span / 4096.
void Ad574a::decide_bit() {
    const auto trial = static_cast<uint16_t>(code | 1u << (kResolution - 1 - bits_decided));
    const int64_t level = (int64_t{input_uv} - settings.low_uv) * 2 * 4096;
    if (level >= (2 * int64_t{trial} - 1) * settings.span_uv) code = trial;
    ++bits_decided;
    if (bits_decided < bit_count) return;
    converting = false;
    if (bit_count < kResolution) {  // the next bit has been tried and not decided
        code = static_cast<uint16_t>(code | 1u << (kResolution - 1 - bit_count));
    }
    ++conversion_count;
    if (input_moved) ++moved_input_count;
}

void Ad574a::set_input(int32_t voltage_uv, uint64_t now_t) {
    if (now_t > 0) advance(now_t - 1);
    if (voltage_uv == input_uv) return;
    input_uv = voltage_uv;
    input_moved = true;
}

Properties Ad574a::properties() const {
    return {
        {"status",
         converting ? fmt::format("converts {} bits until T {}", bit_count, end_t()) : "ready"},
        {"code", fmt::format("{:03X}h", code)},
        {"input", fmt::format("{} uV", input_uv)},
        {"conversions", fmt::format("{}", conversion_count)},
        {"starts ignored: busy", fmt::format("{}", busy_start_count)},
        {"reads while busy", fmt::format("{}", busy_read_count)},
        {"conversions of a moving input", fmt::format("{}", moved_input_count)},
    };
}

}  // namespace host_sim::chips
