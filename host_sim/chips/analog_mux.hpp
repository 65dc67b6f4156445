// analog_mux.hpp - 16:1 analogue multiplexer (DG406) with the settling of its output.
// Source       Vishay Siliconix DG406 data sheet, application hints: settling to 12 bits takes nine
//              time constants of source and switch resistance with the output's capacitance.
// Depends on   host_sim/chips/settling.hpp.
// Not modelled charge injection, leakage, the enable input (wired active).
// Design note  the output is a function of time; there is no event and nothing to advance.
// Page         docs/chips/ad574a.md
#pragma once

#include <array>
#include <cstdint>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

struct AnalogMux {
    static constexpr unsigned kChannelCount = 16;
    /// 300 ns transition and 9 * (2.5 kOhm + 100 Ohm) * 100 pF: the source is a 10 kOhm
    /// potentiometer in its middle.
    static constexpr uint64_t kSettlingNs = 2'640;

    explicit AnalogMux(uint64_t clock_hz, uint64_t settling_ns = kSettlingNs)
        : settling_t(t_states_from_ns(settling_ns, clock_hz)) {}

    /// Sets the voltage at an input. @param input  modulo 16
    void set_input(unsigned input, int32_t voltage_uv) {
        inputs_uv[input % kChannelCount] = voltage_uv;
    }
    /// Connects an input to the output. The one that is connected already stays undisturbed.
    /// @param input  modulo 16
    void select(unsigned input, uint64_t now_t);
    [[nodiscard]] int32_t output_uv(uint64_t now_t) const;
    [[nodiscard]] bool settled(uint64_t now_t) const { return now_t - selected_t >= settling_t; }
    [[nodiscard]] Properties properties(uint64_t now_t) const;

    uint64_t settling_t = 0;
    std::array<int32_t, kChannelCount> inputs_uv{};
    uint8_t channel = 0;
    uint64_t selected_t = 0;
    int32_t from_uv = 0;  ///< output when the channel was selected

    bool operator==(const AnalogMux&) const = default;
};

}  // namespace host_sim::chips
