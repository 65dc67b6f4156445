// measure.hpp - flies an image through logs on the simulated board and adds up what it costs.
// Depends on   host_sim/bind/board_target.hpp, host_sim/image, figures.hpp, reviewed.hpp.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "host_sim/bind/board_target.hpp"
#include "tools/budget/figures.hpp"

namespace rover_budget {

struct MeasureOptions {
    std::filesystem::path image;   ///< Intel HEX, with .map and .sym beside it
    std::filesystem::path folder;  ///< tests/budgets: modules.csv, operations.csv
    std::vector<std::filesystem::path> logs;
    host_sim::SlowStep slow_step = host_sim::SlowStep::fail;
};

/// @param progress  called now and then with the share done, [0, 1]
/// @errors  BudgetError, host_sim::ImageError, host_sim::LogError; host_sim::BoardError from the
/// image
[[nodiscard]] Figures measure(const MeasureOptions& options,
                              const std::function<void(double)>& progress);

/// The logs below `folder`, in the order of their paths.
[[nodiscard]] std::vector<std::filesystem::path> logs_below(const std::filesystem::path& folder);

}  // namespace rover_budget
