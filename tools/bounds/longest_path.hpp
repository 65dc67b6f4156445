// longest_path.hpp - an upper bound for what a procedure takes, with all that it calls.
// Method       implicit path enumeration: the number of times that every edge is taken is a
//              variable of a linear program; what flows into a block flows out of it; a loop's
//              header runs at most so often as its bound says for each entry; flow facts hold. The
//              largest sum of times T-states is an upper bound, because every path of the program
//              is a solution.
// Depends on   flow_program.hpp, GLPK (the source).
// Source       [Li 1995] in docs/references.md.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "tools/bounds/flow_program.hpp"

namespace rover_bounds {

/// What a function adds to a longest path.
struct PathShare {
    double calls = 0;
    double own_t = 0;  ///< without what it calls
};

struct PathBound {
    uint64_t t = 0;                    ///< T-states, RET included and CALL not
    std::map<uint16_t, PathShare> by;  ///< by entry; of the step itself its first address
};

/// @return  nothing: it never ends
/// @errors  BudgetError: flow facts with which it cannot end
[[nodiscard]] std::optional<PathBound> longest_path(const FlowProgram& program, uint16_t entry);

/// Of the step's work: one turn of main's loop without its waiting.
/// @errors  BudgetError as above
[[nodiscard]] PathBound longest_step(const FlowProgram& program);

}  // namespace rover_bounds
