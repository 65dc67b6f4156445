// response.hpp - does everything end in time? Response times under fixed priorities.
// Depends on   the standard library.
// Method       R = blocking + own + sum over what can cut in of ceil(R / period) x its T-states,
//              the smallest solution; a task whose R is not below its period for ever has none.
// Source       [Joseph 1986] in docs/references.md.
// Design note  docs/design/bounds.md, "Response times"
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rover_bounds {

/// Something that comes again and again.
struct Demand {
    uint64_t t = 0;         ///< T-states each time
    uint64_t period_t = 0;  ///< least T-states from one to the next
};

/// The least R with R = first + sum of ceil(R / period) x t. @return  nothing: more than `most`
[[nodiscard]] std::optional<uint64_t> response_time(uint64_t first_t,
                                                    const std::vector<Demand>& cut_in,
                                                    uint64_t most_t);

/// What the image's interrupts and step take at most, in T-states.
struct Workload {
    uint64_t trap = 0, tick = 0, receive = 0, transmit = 0;  ///< handlers, acceptance included
    uint64_t tick_disabled = 0;  ///< the tick's beginning, until it enables interrupts
    uint64_t main_disabled = 0;  ///< longest stretch of the main line with interrupts disabled
    uint64_t step = 0;           ///< main line, from the end of waiting to the next waiting
    uint64_t wake = 0;           ///< from the end of the tick's handler to the end of waiting
};

/// When what comes. A TRAP comes once a step at most: motors stay off from the first one on.
struct Timing {
    uint64_t tick_t = 0, character_t = 0, step_t = 0;
};

struct Deadline {
    std::string what;
    uint64_t own_t = 0;
    std::optional<uint64_t> response_t;  ///< from the request to its end; nothing: behind it
    uint64_t deadline_t = 0;

    [[nodiscard]] bool holds() const { return response_t && *response_t <= deadline_t; }
};

/// Receive, transmit, tick and step.
[[nodiscard]] std::vector<Deadline> deadlines(const Workload& load, const Timing& timing);

}  // namespace rover_bounds
