// random_log.hpp - random logs for comparing targets: drives, faults, moves by hand, calibrations,
// noise, resets, ticks that jump, bytes on the link.
// Depends on   host_sim/world/input_walk.hpp, host_target.hpp.
// Determinism  everything follows from the seed.
#pragma once

#include <cstddef>
#include <cstdint>

#include "host_sim/log/log.hpp"

namespace host_sim {

/// A log that the native controller has driven.
/// @param steps_max  it has at most so many steps, at least one
[[nodiscard]] Log random_log(uint64_t seed, std::size_t steps_max);

/// Inputs as a log records them: what is absent has the one value that stands for it.
[[nodiscard]] hal::RawInputs canonical(hal::RawInputs inputs);

}  // namespace host_sim
