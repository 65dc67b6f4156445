// settling.hpp - how an analogue voltage runs into its new value, in integers.
// Depends on   the standard library.
// Design note  a first-order lag halves its distance in equal times. After 13 halvings 0.012 % are
//              left, half a count of 12 bits, which is where data sheets say "settled".
#pragma once

#include <cstdint>

namespace host_sim::chips {

inline constexpr uint64_t kSettlingHalvings = 13;

/// Voltage on its way from `from_uv` to `to_uv`, `elapsed_t` after the beginning of a change that
/// is complete after `settling_t`.
/// @return  microvolts between the two; exactly `to_uv` from `settling_t` on
/// @rounding  the remaining distance is rounded to zero; both differences may span 32 bits
[[nodiscard]] constexpr int32_t settle_uv(int32_t from_uv, int32_t to_uv, uint64_t elapsed_t,
                                          uint64_t settling_t) {
    if (elapsed_t >= settling_t) return to_uv;
    const uint64_t halvings = elapsed_t * kSettlingHalvings / settling_t;
    const int64_t distance = int64_t{from_uv} - to_uv;
    return static_cast<int32_t>(to_uv + distance / (int64_t{1} << halvings));
}

}  // namespace host_sim::chips
