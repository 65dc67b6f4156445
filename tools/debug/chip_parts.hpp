// chip_parts.hpp - the chips of the board by name, for showing and comparing.
// Depends on   host_sim/board, host_sim/chips.
#pragma once

#include <span>
#include <string_view>

#include "host_sim/board/board_state.hpp"

namespace debug_console {

/// One chip of the board.
struct ChipPart {
    std::string_view name;
    std::string_view description;
    /// Its registers and state at the board's T-state. The board brings a chip up to date only when
    /// somebody looks; so this looks at a copy.
    host_sim::chips::Properties (*properties)(const host_sim::BoardState& state);
    /// Whether two boards agree in it.
    bool (*equal)(const host_sim::BoardState& one, const host_sim::BoardState& other);
};

/// All of them, in the order of their ports; those without a port last.
[[nodiscard]] std::span<const ChipPart> chip_parts();

}  // namespace debug_console
