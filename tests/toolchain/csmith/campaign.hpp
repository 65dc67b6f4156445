// campaign.hpp - many seeds on several processes, counted. Depends on   compare.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "tests/toolchain/csmith/compare.hpp"

namespace csmith_test {

struct Campaign {
    uint64_t first = 1;
    uint64_t last = 1;
    unsigned jobs = 1;
};

struct Summary {
    std::array<uint64_t, kVerdicts> counts{};  ///< by verdict
    std::map<uint64_t, Finding> findings{};    ///< by seed; all that did not agree

    [[nodiscard]] uint64_t count(Verdict verdict) const {
        return counts.at(static_cast<std::size_t>(verdict));
    }
    [[nodiscard]] uint64_t done() const;
    [[nodiscard]] bool has_fault() const;
};

/// One line with all counts.
[[nodiscard]] std::string counts_text(const Summary& summary);

/// Hands out the seeds to `jobs` processes. `each` hears of every seed, in the order of their ends.
/// A process that dies leaves its seed without a finding: `failed`.
[[nodiscard]] Summary run_campaign(
    const Campaign& campaign, const std::function<Finding(uint64_t)>& work,
    const std::function<void(const Summary&, uint64_t, const Finding&)>& each = {});

}  // namespace csmith_test
