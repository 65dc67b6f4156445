// placement.hpp - the image's bytes by module: who owns which address, what each takes.
// Depends on   image_map.hpp, modules.hpp, host_sim/image/symbols.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host_sim/image/symbols.hpp"
#include "tools/budget/image_map.hpp"
#include "tools/budget/modules.hpp"

namespace rover_budget {

/// Bytes of one module. Frames are left out: they overlay one another.
struct ModuleBytes {
    uint32_t rom = 0;    ///< code, constants, and initial values of variables
    uint32_t ram = 0;    ///< variables
    uint32_t stack = 0;  ///< the deepest of its functions, with what it calls; as compiled
};

struct Placement {
    std::vector<uint16_t> module_of;    ///< by address, 65,536: index of the module
    std::vector<ModuleBytes> bytes;     ///< by module
    std::vector<std::string> unmapped;  ///< functions and variables that no pattern fits
};

[[nodiscard]] Placement place(const ImageMap& map, const host_sim::Symbols& symbols,
                              const ModuleTable& table);

}  // namespace rover_budget
