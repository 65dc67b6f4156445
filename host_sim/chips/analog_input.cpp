// analog_input.cpp - the analogue chain.
#include "host_sim/chips/analog_input.hpp"

#include <fmt/format.h>

namespace host_sim::chips {
namespace {

/// The voltage in the middle of a code.
int32_t nominal_uv(const Ad574a::Settings& settings, unsigned code) {
    return static_cast<int32_t>(settings.low_uv + int64_t{code} * settings.span_uv / 4096);
}

}  // namespace

uint8_t AnalogInput::read(uint16_t address, uint64_t now_t) {
    advance(now_t);
    if (silent()) return kOpenBus;
    return adc.read(address, now_t);
}

void AnalogInput::write(uint16_t address, uint8_t value, uint64_t now_t) {
    advance(now_t);
    if (!adc.converting) {
        if (!mux.settled(now_t) || !amplifier.acquired(now_t)) ++unsettled_count;
        next_replayed_code();
        amplifier.hold(mux.output_uv(now_t), now_t);
        adc.set_input(amplifier.held_uv, now_t);
    }
    adc.write(address, value, now_t);
}

void AnalogInput::advance(uint64_t now_t) {
    const bool was_converting = adc.converting;
    adc.advance(now_t);
    if (was_converting && !adc.converting) amplifier.sample(adc.end_t());
}

void AnalogInput::set_sensor(unsigned channel, int32_t voltage_uv, uint64_t now_t) {
    advance(now_t);
    sources[channel % AnalogMux::kChannelCount] = {};
    mux.set_input(channel, voltage_uv);
}

void AnalogInput::set_sensor_sum(unsigned channel, uint16_t sum_q4, uint64_t now_t) {
    advance(now_t);
    sources[channel % AnalogMux::kChannelCount] = {Source::Kind::sum, sum_q4, 0};
    mux.set_input(channel, nominal_uv(adc.settings, sum_q4 / 16));
}

void AnalogInput::set_silent(unsigned channel, uint64_t now_t) {
    advance(now_t);
    sources[channel % AnalogMux::kChannelCount] = {Source::Kind::silent, 0, 0};
}

// Of 16 conversions, sum % 16 give one code more, spread evenly: the running total after j of them
// is j * sum / 16, rounded down. It repeats after 16, so where the 16 begin does not matter.
void AnalogInput::next_replayed_code() {
    Source& source = sources[mux.channel];
    if (source.kind != Source::Kind::sum) return;
    const auto total = [&source](unsigned count) { return count * source.sum_q4 / 16u; };
    const unsigned code = total(source.sequence + 1u) - total(source.sequence);
    source.sequence = static_cast<uint8_t>((source.sequence + 1u) % 16u);
    mux.set_input(mux.channel, nominal_uv(adc.settings, code));
}

void AnalogInput::select(unsigned channel, uint64_t now_t) {
    advance(now_t);
    if (channel % AnalogMux::kChannelCount == mux.channel) return;
    amplifier.input_jumps(mux.output_uv(now_t), now_t);
    mux.select(channel, now_t);
}

Properties AnalogInput::properties(uint64_t now_t) const {
    Properties all;
    const auto append = [&all](const std::string& part, const Properties& properties) {
        for (const auto& [name, value] : properties) all.push_back({part + name, value});
    };
    append("multiplexer: ", mux.properties(now_t));
    append("sample-and-hold: ", amplifier.properties());
    append("converter: ", adc.properties());
    all.push_back({"conversions started too early", fmt::format("{}", unsettled_count)});
    return all;
}

}  // namespace host_sim::chips
