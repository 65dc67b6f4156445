// map_grid_benchmark.cpp - estimation cycles per second on one core of the host.
// Requirement  2 million a second in the release preset; printed, not a timed test.
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "firmware/estimation/map_grid.hpp"
#include "host_sim/bind/slip_estimators.hpp"
#include "host_sim/campaign/planar_course.hpp"

namespace {

/// A nominal course's measurements, ready before the clock runs.
std::vector<rover::MapGridInput> course_inputs(rover::MapGrid& map) {
    const auto ground =
        host_sim::make_planar_ground(host_sim::TerrainKind::wilcox1994, 1, 6250).scaled(0.02);
    rover::S16 surface_q4_mm[rover::slip::kKnownNodes];
    for (int node = 0; node < rover::slip::kKnownNodes; ++node) {
        surface_q4_mm[node] =
            host_sim::height_q4_mm(ground.surface_cm(2.5 * node) - ground.surface_cm(0));
    }
    rover::slip::start_on_known_ground(map, surface_q4_mm);
    std::vector<rover::MapGridInput> inputs;
    host_sim::PlanarCourse course(ground, {}, 1);
    while (!course.finished()) {
        const host_sim::CycleInputs seen = course.next();
        rover::MapGridInput input;
        input.linkage = true;
        input.odometer_q6_bin = inputs.size() % 5 % 2 == 0 ? 154 : 153;
        input.middle_height_q4_mm = host_sim::height_q4_mm(seen.middle_cm);
        input.front_height_q4_mm = host_sim::height_q4_mm(seen.front_cm);
        input.ahead_count = 2;
        input.ahead_height_q4_mm[0] = host_sim::height_q4_mm(seen.near_cm);
        input.ahead_height_q4_mm[1] = host_sim::height_q4_mm(seen.far_cm);
        input.ahead_distance_q6_bin[0] = 1536;
        input.ahead_distance_q6_bin[1] = 2048;
        inputs.push_back(input);
    }
    return inputs;
}

void map_grid_cycles(benchmark::State& state) {
    rover::MapGrid start;
    const std::vector<rover::MapGridInput> inputs = course_inputs(start);
    for (auto _ : state) {
        rover::MapGrid map = start;
        for (const rover::MapGridInput& input : inputs) rover::map_grid_step(map, input);
        benchmark::DoNotOptimize(map);
    }
    state.counters["cycles"] = benchmark::Counter(static_cast<double>(inputs.size()),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(map_grid_cycles);

}  // namespace

BENCHMARK_MAIN();
