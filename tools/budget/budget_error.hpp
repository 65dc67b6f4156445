// budget_error.hpp - a budget file, map or image that cannot be used.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace rover_budget {

/// The text is complete: "file:line: what; what to do".
class BudgetError : public std::runtime_error {
public:
    /// @param line  0: concerns the whole file
    BudgetError(std::string_view file, std::size_t line, std::string_view what,
                std::string_view advice)
        : std::runtime_error(text(file, line, what, advice)) {}

private:
    static std::string text(std::string_view file, std::size_t line, std::string_view what,
                            std::string_view advice) {
        std::string made(file);
        if (line != 0) made.append(":").append(std::to_string(line));
        return made.append(": ").append(what).append("; ").append(advice);
    }
};

}  // namespace rover_budget
