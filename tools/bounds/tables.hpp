// tables.hpp - the bounds as text and as JSON. Depends on   bounds.hpp, observed.hpp.
#pragma once

#include <string>

#include "tools/bounds/bounds.hpp"
#include "tools/bounds/observed.hpp"

namespace rover_bounds {

/// A bound and what was seen, in the order in which they are shown.
struct BoundRow {
    std::string name;
    std::optional<uint64_t> bound;
    uint64_t observed = 0;  ///< 0: not seen
};

/// Every function of the image, by address.
[[nodiscard]] std::vector<BoundRow> function_rows(const FlowProgram& program, const Bounds& bounds,
                                                  const Observed& observed);
/// Step and handlers.
[[nodiscard]] std::vector<BoundRow> task_rows(const Bounds& bounds, const Observed& observed);

/// For a terminal, what matters most at the end.
[[nodiscard]] std::string console_text(const FlowProgram& program, const Bounds& bounds,
                                       const Observed& observed);

/// One document: docs/design/bounds.md.
[[nodiscard]] std::string json_text(const FlowProgram& program, const Bounds& bounds,
                                    const Observed& observed);

}  // namespace rover_bounds
