// reviewed.hpp - reviewed numbers and limits: read, written, compared.
// Depends on   figures.hpp, nlohmann-json.
// Files        tests/budgets/budget.json, tests/budgets/limits.csv; docs/design/budget.md
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/budget/figures.hpp"

namespace rover_budget {

/// One number that is not what it was.
struct Difference {
    std::string name;
    std::optional<uint64_t> before, now;  ///< nothing: there was none, there is none any more

    bool operator==(const Difference&) const = default;
};

/// In the order of the names; empty when all are equal.
[[nodiscard]] std::vector<Difference> differences(const Numbers& before, const Numbers& now);

/// "module.control.t_states_worst  1000 -> 990  (-10, -1.0 %)".
[[nodiscard]] std::string describe(const Difference& difference);

/// Numbers of a reviewed file, or of a document that `--json` has written.
/// @errors BudgetError: no such document, a number that is none
[[nodiscard]] Numbers parse_numbers(std::string_view text, std::string_view file);

/// The reviewed file, a number a line.
/// @param command  which compares them, and with --update writes them
[[nodiscard]] std::string reviewed_text(const Numbers& numbers,
                                        std::string_view command = "rover85 budget",
                                        std::string_view page = "docs/design/budget.md");

/// What a number may be at most, by the project's requirements.
struct Limit {
    std::string number;  ///< its name
    uint64_t most = 0;
    std::string what;  ///< for people

    [[nodiscard]] std::optional<uint64_t> value(const Numbers& numbers) const;
    /// A number that was not measured holds no limit.
    [[nodiscard]] bool holds(const Numbers& numbers) const;
};

/// Reads `name,most,text` lines. @errors BudgetError
[[nodiscard]] std::vector<Limit> parse_limits(std::string_view text, std::string_view file);

}  // namespace rover_budget
