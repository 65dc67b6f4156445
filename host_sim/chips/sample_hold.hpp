// sample_hold.hpp - sample-and-hold amplifier (LF398, 1 nF polypropylene hold capacitor).
// Source       Texas Instruments LF398-N data sheet (SNOSBI3C): acquisition time below 10 us, 6 us
//              typical to 0.01 %.
// Depends on   host_sim/chips/settling.hpp.
// Not modelled hold step (constant; trimmed by the data sheet's circuit or part of the calibrated
//              zero), droop (30 pA into 1 nF: 1 uV in a conversion), aperture time (below 1 T).
// Design note  a function of time and input; there is no event and nothing to advance.
// Page         docs/chips/ad574a.md
#pragma once

#include <cstdint>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

struct SampleHold {
    static constexpr uint64_t kAcquisitionNs = 10'000;

    /// Samples an input of 0 V since long ago.
    explicit SampleHold(uint64_t clock_hz, uint64_t acquisition_ns = kAcquisitionNs)
        : acquisition_t(t_states_from_ns(acquisition_ns, clock_hz)) {}

    /// Begins to follow the input. Nothing happens when it does already.
    void sample(uint64_t now_t);
    /// Keeps what has been reached. Held before the acquisition time is over, that is a mixture of
    /// the value held before and the input. Nothing happens when it holds already.
    /// @param input_uv  input at `now_t`
    void hold(int32_t input_uv, uint64_t now_t);
    /// The input is about to jump: while sampling, acquisition starts again.
    /// @param input_uv  input at `now_t`, before the jump
    void input_jumps(int32_t input_uv, uint64_t now_t);
    /// @param input_uv  input at `now_t`; without effect while holding
    [[nodiscard]] int32_t output_uv(int32_t input_uv, uint64_t now_t) const;
    [[nodiscard]] bool acquired(uint64_t now_t) const {
        return !holding && now_t - sample_t >= acquisition_t;
    }
    [[nodiscard]] Properties properties() const;

    uint64_t acquisition_t = 0;
    bool holding = false;
    uint64_t sample_t = 0;          ///< beginning of the acquisition
    int32_t held_uv = 0;            ///< output at that time, or while holding
    uint64_t early_hold_count = 0;  ///< held before the acquisition time was over

    bool operator==(const SampleHold&) const = default;
};

}  // namespace host_sim::chips
