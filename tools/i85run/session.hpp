// session.hpp - one run from the options to the last line of output.
// Depends on   everything else here.
#pragma once

#include "tools/i85run/options.hpp"

namespace i85run {

/// Loads, runs, reports.
/// @return  kExitPass or kExitUnfinished
/// @errors  UsageError, host_sim::ImageError
int run_session(const Options& options);

}  // namespace i85run
