#include "tools/opcount/map_grid_count.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/estimation/map_grid.hpp"
#include "host_sim/campaign/planar_course.hpp"

namespace opcount {

namespace {

constexpr std::uint64_t kSeed = 1;
constexpr double kRoughness = 0.02;

static_assert(rover::kOperationCount == kCategoryCount);

rover::S16 q4_mm(double height_cm) {
    return static_cast<std::int16_t>(std::lround(height_cm * 160));
}

rover::MapGridInput input_of(const host_sim::CycleInputs& seen, std::uint64_t cycle) {
    rover::MapGridInput input;
    input.linkage = true;
    // 153.6 units a cycle, exact in the sum: 154, 153, 154, 153, 154, ...
    const std::uint64_t before = (cycle * 1536 + 5) / 10;
    input.odometer_q6_bin = static_cast<std::int16_t>(((cycle + 1) * 1536 + 5) / 10 - before);
    input.middle_height_q4_mm = q4_mm(seen.middle_cm);
    input.front_height_q4_mm = q4_mm(seen.front_cm);
    input.ahead_count = 2;
    input.ahead_height_q4_mm[0] = q4_mm(seen.near_cm);
    input.ahead_height_q4_mm[1] = q4_mm(seen.far_cm);
    input.ahead_distance_q6_bin[0] = std::uint16_t{1536};  // 60 cm
    input.ahead_distance_q6_bin[1] = std::uint16_t{2048};  // 80 cm
    return input;
}

}  // namespace

MapGridCount count_map_grid() {
    const host_sim::PlanarGround ground =
        host_sim::make_planar_ground(host_sim::TerrainKind::wilcox1994, kSeed,
                                     host_sim::kCourseLengthCm)
            .scaled(kRoughness);
    rover::MapGrid map;
    rover::S16 surface_q4_mm[rover::slip::kKnownNodes];
    for (int node = 0; node < rover::slip::kKnownNodes; ++node) {
        surface_q4_mm[node] = q4_mm(ground.surface_cm(2.5 * node) - ground.surface_cm(0));
    }
    rover::slip::start_on_known_ground(map, surface_q4_mm);
    MapGridCount count;
    host_sim::PlanarCourse course(ground, {}, kSeed);
    while (!course.finished()) {
        const rover::MapGridInput input = input_of(course.next(), count.cycles);
        rover::operation_tally() = {};
        rover::map_grid_step(map, input);
        const rover::OperationTally tally = rover::operation_tally();
        for (std::size_t i = 0; i < kCategoryCount; ++i) {
            count.total[i] += tally.count[i];
            count.worst[i] = std::max(count.worst[i], tally.count[i]);
        }
        count.worst_sum = std::max(count.worst_sum, tally.total());
        ++count.cycles;
    }
    count.travelled_q6_bin = rover::native(map.travelled_q6_bin);
    return count;
}

std::string describe(const MapGridCount& count) {
    std::string text = fmt::format(
        "map_grid, elementary operations a cycle: 62.5 m, {} cycles; the paper: \"of the order of "
        "100\"\n\noperation          mean     worst\n",
        count.cycles);
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < kCategoryCount; ++i) {
        sum += count.total[i];
        text += fmt::format("{:<14} {:>8.1f} {:>9}\n", rover::kOperationNames[i],
                            static_cast<double>(count.total[i]) / static_cast<double>(count.cycles),
                            count.worst[i]);
    }
    text +=
        fmt::format("{:<14} {:>8.1f} {:>9}\n", "all",
                    static_cast<double>(sum) / static_cast<double>(count.cycles), count.worst_sum);
    return text;
}

std::string budget(const MapGridCount& count) {
    std::string text =
        "# Elementary operations of map_grid on a nominal course (tools/opcount): `opcount "
        "--budget`.\n"
        "# Exact: better and worse both fail until edited. The paper: of the order of 100 a "
        "cycle.\n"
        "operation,total,worst_cycle\n";
    text += fmt::format("cycles,{},\n", count.cycles);
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < kCategoryCount; ++i) {
        sum += count.total[i];
        text +=
            fmt::format("{},{},{}\n", rover::kOperationNames[i], count.total[i], count.worst[i]);
    }
    text += fmt::format("all,{},{}\n", sum, count.worst_sum);
    return text;
}

}  // namespace opcount
