// figures.hpp - everything `rover85 budget` knows of an image, and its numbers by name.
// Depends on   placement.hpp, step_profile.hpp.
// Format       docs/design/budget.md; the JSON document and tests/budgets/budget.json hold the same
//              names.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/budget/placement.hpp"
#include "tools/budget/step_profile.hpp"

namespace rover_budget {

/// Whole numbers by name, as "module.control.t_states_worst".
using Numbers = std::map<std::string, uint64_t, std::less<>>;

/// Elementary operations of one slip-and-sinkage cycle (tests/budgets/operations.csv).
struct Operations {
    uint64_t cycles = 0, total = 0, worst = 0;
    [[nodiscard]] double mean() const {
        return cycles == 0 ? 0.0 : static_cast<double>(total) / static_cast<double>(cycles);
    }
};

struct LogSize {
    std::string name;
    uint64_t steps = 0;
};

/// Figures of an image over some logs.
struct Figures {
    std::string identity;
    std::vector<LogSize> logs;
    uint32_t rom_bytes = 0, ram_bytes = 0;
    uint32_t frame_bytes = 0;  ///< of RAM: overlaid frames of all functions
    uint32_t stack_bytes = 0;  ///< of RAM: the deepest, exact, as compiled
    std::vector<Module> modules;
    Placement placement;
    ProfileFigures profile;
    std::optional<Operations> operations;
};

/// Mean T-states a step, over all steps.
[[nodiscard]] double mean_t(const Figures& figures, const StepTime& time);

/// Does a module work in a part of the steps only, and then in several in a row?
[[nodiscard]] bool is_spread(const Figures& figures, std::size_t module);

/// Every number that is reviewed. A module that takes no bytes and no time has none.
[[nodiscard]] Numbers numbers_of(const Figures& figures);

/// Share of all time that interrupts took, in hundredths of a percent, rounded up.
[[nodiscard]] uint64_t interrupt_share_e4(const ProfileFigures& profile);

/// Reads the counts of tests/budgets/operations.csv. @errors BudgetError
[[nodiscard]] Operations parse_operations(std::string_view text, std::string_view file);

}  // namespace rover_budget
