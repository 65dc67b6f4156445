// tables.hpp - a budget for people: on the terminal and as Markdown.
// Depends on   figures.hpp, reviewed.hpp.
#pragma once

#include <string>
#include <vector>

#include "tools/budget/figures.hpp"
#include "tools/budget/reviewed.hpp"

namespace rover_budget {

inline constexpr double kClockMhz = 3.072;      ///< the board's
inline constexpr double kSlowClockMhz = 2.000;  ///< the 80C85 of the first rover on Mars

/// Everything that is shown.
struct Review {
    Figures figures;
    Numbers numbers;
    std::vector<Limit> limits;
    Numbers reviewed;                     ///< empty: there are none yet
    std::vector<Difference> differences;  ///< from the reviewed numbers
    std::string against;                  ///< the other revision's file; empty: none
    std::vector<Difference> since_then;   ///< from the other revision
};

struct Table {
    std::string title;
    std::vector<std::string> head;  ///< the first column is text, the others are right-aligned
    std::vector<std::vector<std::string>> rows;
};

/// Milliseconds with three digits. @param clock_mhz  of the processor
[[nodiscard]] std::string ms_text(double t_states, double clock_mhz);

/// Step, modules, interrupts, operations, limits and, where there are some, differences.
[[nodiscard]] std::vector<Table> tables_of(const Review& review);

[[nodiscard]] std::string console_text(const Review& review);
[[nodiscard]] std::string markdown_text(const Review& review);

}  // namespace rover_budget
