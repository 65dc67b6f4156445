// parallel.hpp - the same work whatever the number of threads.
// Depends on   the standard library only.
// Tests        tests/host_sim/campaign/parallel_test.cpp
#pragma once

#include <cstddef>
#include <functional>

namespace host_sim {

/// Called after each finished piece with the number of pieces done; never by two threads at once.
using Progress = std::function<void(std::size_t done, std::size_t total)>;

/// Calls body(0) ... body(count - 1), each once, on up to `threads` threads (0: one per core).
/// A body writes only its own result, so results cannot depend on the order.
/// @errors  when bodies throw, the exception of the lowest index that threw is rethrown; pieces
///          not yet begun are left out
void parallel_for(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& body,
                  const Progress& progress = {});

}  // namespace host_sim
