// bounds.hpp - all bounds of an image: functions, step, handlers, stack, response times.
// Depends on   longest_path.hpp, stack_bound.hpp, response.hpp, tools/budget/figures.hpp.
// Design note  docs/design/bounds.md
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/bounds/flow_program.hpp"
#include "tools/bounds/longest_path.hpp"
#include "tools/bounds/response.hpp"
#include "tools/bounds/stack_bound.hpp"
#include "tools/budget/figures.hpp"

namespace rover_bounds {

/// In T-states and bytes. Every one is an upper bound.
struct Bounds {
    std::map<uint16_t, std::optional<uint64_t>> function_t;  ///< by entry; nothing: never ends
    std::map<std::string, uint64_t> handler_t;               ///< acceptance included
    PathBound step;                                          ///< main line without waiting
    StackBound stack;
    std::vector<DisabledStretch> disabled;
    std::vector<Deadline> deadlines;
};

/// @errors BudgetError: code that has no bound, with its source line
[[nodiscard]] Bounds find_bounds(const FlowProgram& program, const Timing& timing);

/// The numbers that are reviewed: "bound.step", "bound.handler.RST 7.5", "bound.stack", ...
[[nodiscard]] rover_budget::Numbers numbers_of(const Bounds& bounds);

}  // namespace rover_bounds
