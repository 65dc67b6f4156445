// documents.hpp - a budget for machines (JSON) and as a page with bars (HTML, nothing from a
// network). Depends on   tables.hpp, nlohmann-json.     Format  docs/design/budget.md
#pragma once

#include <string>

#include "tools/budget/tables.hpp"

namespace rover_budget {

[[nodiscard]] std::string json_text(const Review& review);
[[nodiscard]] std::string html_text(const Review& review);

}  // namespace rover_budget
