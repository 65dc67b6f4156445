// map_grid_count.hpp - elementary operations of the slip-and-sinkage estimator, cycle by cycle.
// Purpose      the program `opcount` and the budget test; the paper states "of the order of 100".
// Model        one nominal course: 62.5 m of the paper's ground at roughness 0.02, seed 1.
// Tests        tests/tools/opcount/map_grid_count_test.cpp
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace opcount {

inline constexpr std::size_t kCategoryCount = 7;

struct MapGridCount {
    std::uint64_t cycles = 0;
    std::array<std::uint64_t, kCategoryCount> total{};  ///< over the course, by category
    std::array<std::uint64_t, kCategoryCount> worst{};  ///< of any cycle, each category for itself
    std::uint64_t worst_sum = 0;                        ///< all categories together, of any cycle
    std::int32_t travelled_q6_bin = 0;                  ///< result: the same bits as in flight
};

MapGridCount count_map_grid();

/// For people: mean and worst cycle beside the paper's figure.
std::string describe(const MapGridCount& count);
/// The reviewed numbers, as tests/budgets/operations.csv holds them.
std::string budget(const MapGridCount& count);

}  // namespace opcount
