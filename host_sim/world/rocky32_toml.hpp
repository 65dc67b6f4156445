// rocky32_toml.hpp - the text of host_sim/vehicles/rocky32.toml, as of the build.
#pragma once

namespace host_sim {
extern const char* const kRocky32Toml;
}  // namespace host_sim
