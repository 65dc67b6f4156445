// budget_bounds.hpp - `rover85 budget --bounds`: upper bounds, compared with what the logs show.
// Depends on   tools/bounds.     Guide  docs/design/bounds.md
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/rover85/target_option.hpp"

struct BoundsOptions {
    TargetOptions target;
    std::filesystem::path folder;             ///< of flow.csv and bounds.json
    std::vector<std::filesystem::path> logs;  ///< to fly
    std::uint64_t random_logs = 0, seed = 1;  ///< to fly as well
    std::string json;                         ///< file, or empty
    bool update = false;
};

/// @return  exit code: 1 when a run exceeds a bound or breaks a flow fact, a deadline does not
///          hold, or a number is not the reviewed one
int show_bounds(const BoundsOptions& options);
