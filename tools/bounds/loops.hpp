// loops.hpp - the loops of a procedure, nested ones included.
// Depends on   code_graph.hpp.
// Refuses      a loop that can be entered at two places: no bound would belong to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/bounds/code_graph.hpp"

namespace rover_bounds {

struct Loop {
    std::size_t header = 0;               ///< block that is entered first in every turn
    uint16_t address = 0;                 ///< of its first instruction
    std::vector<std::size_t> blocks;      ///< ascending, the header and inner loops included
    std::vector<std::size_t> entries;     ///< edges from outside to the header
    std::vector<std::size_t> turns;       ///< edges from inside to the header
    bool entered_with_procedure = false;  ///< the header is the procedure's first block
};

/// By address of the header, and so of outer loops before inner ones of the same header.
/// @errors BudgetError with the source line of a loop with two entries
[[nodiscard]] std::vector<Loop> find_loops(const Procedure& procedure,
                                           const host_sim::Symbols& symbols);

}  // namespace rover_bounds
