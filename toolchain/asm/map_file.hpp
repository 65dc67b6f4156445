// map_file.hpp - what is where and how much: ranges, sections, functions, notes.
// Form         docs/spec/map.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "toolchain/asm/program.hpp"

namespace toolchain::assembly {

/// Fewest and most T-states of a call, RET included and CALL not.
struct TStates {
    uint32_t least = 0;
    uint32_t most = 0;
    bool operator==(const TStates&) const = default;
};

/// What belongs to a function, added up over its sections.
struct FunctionSizes {
    std::string name{};   ///< Section::function, or the name of the code section
    std::string title{};  ///< demangled name, or empty
    uint16_t address = 0;
    uint32_t rom_bytes = 0;  ///< code and constants
    uint32_t ram_bytes = 0;  ///< frame and other RAM; frames overlay one another
    /// From a note "t ...", or exact if the code is straight.
    std::optional<TStates> t_states{};
    std::optional<uint32_t> stack_bytes{};  ///< from a note "stack N"
};

/// All functions with code, by address.
[[nodiscard]] std::vector<FunctionSizes> function_sizes(const Program& program);

/// T-states of code that runs from its first instruction to a RET that is its last, with neither
/// jump nor call; nothing for other code.
[[nodiscard]] std::optional<uint32_t> straight_t_states(const Section& section);

[[nodiscard]] std::string map_file(const Program& program);

}  // namespace toolchain::assembly
