// analog_input.cpp - the analogue chain.
#include "host_sim/chips/analog_input.hpp"

#include <fmt/format.h>

namespace host_sim::chips {

uint8_t AnalogInput::read(uint16_t address, uint64_t now_t) {
    advance(now_t);
    return adc.read(address, now_t);
}

void AnalogInput::write(uint16_t address, uint8_t value, uint64_t now_t) {
    advance(now_t);
    if (!adc.converting) {
        if (!mux.settled(now_t) || !amplifier.acquired(now_t)) ++unsettled_count;
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
    mux.set_input(channel, voltage_uv);
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
