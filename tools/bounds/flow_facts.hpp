// flow_facts.hpp - what is known of the program's flow and cannot be seen in its code.
// Depends on   the standard library, fnmatch.
// Format       tests/budgets/flow.csv; docs/design/bounds.md
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rover_bounds {

/// Functions by the pattern of their names, or loops of them.
struct FlowItem {
    std::string pattern;
    /// From 1, by address of the loops' first instructions; nothing: the function's calls.
    std::optional<unsigned> loop;

    [[nodiscard]] bool fits(std::string_view function) const;
};

struct FlowTerm {
    int64_t factor = 1;
    FlowItem item;
};

/// sum of `terms` <= most, in every step and in every run of a handler.
struct FlowFact {
    std::vector<FlowTerm> terms;
    int64_t most = 0;
    std::string text, reason;
    std::size_t line = 0;
};

enum class LoopKind : uint8_t {
    turns,    ///< at most so many each time it is entered
    endless,  ///< never left: what contains it has no bound
    waits,    ///< for an interrupt: bounded from the one that ends it on
};

/// A bound for a loop to which the compiler knows none.
struct LoopRule {
    LoopKind kind = LoopKind::turns;
    FlowItem item;
    uint32_t turns = 0;
    std::string reason;
    std::size_t line = 0;
};

struct FlowTable {
    std::string file;  ///< for messages
    std::vector<FlowFact> facts;
    std::vector<LoopRule> loops;
};

/// @errors BudgetError with file and line
[[nodiscard]] FlowTable parse_flow(std::string_view text, std::string_view file);

}  // namespace rover_bounds
