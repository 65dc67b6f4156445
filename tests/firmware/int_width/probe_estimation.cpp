// probe_estimation.cpp - both slip-and-sinkage estimators over a synthetic course and over noise.
// The course is two sine waves of ground, driven with 20 % slip: what matters is that both targets
// compute the same, on inputs that lead the estimators into every mode.
#include "firmware/core/sine.hpp"
#include "firmware/estimation/map_grid.hpp"
#include "firmware/estimation/map_paper.hpp"
#include "probe.hpp"

namespace probe {
namespace {

using namespace rover;

/// Ground height at a place in 1/64 bin of 25 mm: waves of 51 cm and 17 cm, s16 Q4 mm.
int16_t ground_q4_mm(uint16_t place_q6_bin) {
    const auto angle = narrow_wrap_s16(mul_wrap(place_q6_bin, uint16_t{50}));
    const auto steep = narrow_wrap_s16(mul_wrap(place_q6_bin, uint16_t{150}));
    return add_wrap(mul_q15_sat(sine_q14(angle), int16_t{1800}),
                    mul_q15_sat(sine_q14(steep), int16_t{600}));
}

int16_t rise_q4_mm(uint16_t place, uint16_t distance) {
    return sub_wrap(ground_q4_mm(add_wrap(place, distance)), ground_q4_mm(place));
}

void add_map_grid(const MapGrid& map, Checksum& sum) {
    sum.add(map.place_q6_bin);
    sum.add(map.travelled_q6_bin);
    sum.add(map.advance_q6_bin);
    sum.add(map.mean_q12_bin);
    sum.add(map.match_cost_q10);
    sum.add(map.sinkage_q4_mm);
    sum.add(position_sigma_q4_mm(map));
    sum.add(slip::slip_percent(slip::learned_share_q15(map)));
    sum.add(static_cast<uint8_t>(map.mode));
    for (const S16 height : map.surface_q4_mm) sum.add(height);
}

void check_map_grid_course(Inputs& inputs, Checksum& sum) {
    MapGrid map;
    uint16_t place = bit_and(inputs.next<uint16_t>(), uint16_t{0xFFC0});
    for (uint8_t cycle = 0; cycle < 60; ++cycle) {
        MapGridInput input;
        input.linkage = true;
        input.odometer_q6_bin = 154;  // 6 cm
        const auto noise = shift_floor<13>(inputs.next<int16_t>());
        input.middle_height_q4_mm = add_wrap(rise_q4_mm(place, 640), noise);
        input.front_height_q4_mm = rise_q4_mm(place, 1280);
        input.ahead_count = 2;
        input.ahead_distance_q6_bin[0] = 1536;
        input.ahead_distance_q6_bin[1] = 2048;
        input.ahead_height_q4_mm[0] = add_wrap(rise_q4_mm(place, 1536), int16_t{80});
        input.ahead_height_q4_mm[1] = add_wrap(rise_q4_mm(place, 2048), int16_t{80});
        if (cycle == 40) input.motion = CycleMotion::reverse;
        if (cycle == 50) input.motion = CycleMotion::turn;
        map_grid_step(map, input);
        add_map_grid(map, sum);
        place = add_wrap(place, uint16_t{128});  // 5 cm
    }
}

void check_map_grid_noise(Inputs& inputs, Checksum& sum) {
    MapGrid map;
    for (uint8_t cycle = 0; cycle < 40; ++cycle) {
        MapGridInput input;
        input.motion = static_cast<CycleMotion>(bit_and(inputs.next<uint8_t>(), uint8_t{3}));
        if (cycle % 4 != 0) input.motion = CycleMotion::forward;
        input.linkage = cycle % 8 != 7;
        input.odometer_q6_bin = inputs.next<int16_t>();
        input.middle_height_q4_mm = inputs.next<int16_t>();
        input.front_height_q4_mm = inputs.next<int16_t>();
        input.ahead_count = bit_and(inputs.next<uint8_t>(), uint8_t{7});
        for (uint8_t i = 0; i < kLookAheadMax; ++i) {
            input.ahead_height_q4_mm[i] = inputs.next<int16_t>();
            input.ahead_distance_q6_bin[i] = inputs.next<uint16_t>();
        }
        map_grid_step(map, input);
        add_map_grid(map, sum);
    }
}

using Paper = MapPaper<10>;  // bins of 2.5 cm

void check_map_paper(Inputs& inputs, Checksum& sum) {
    static Paper map;  // too large for the small target's stack beside the rest
    uint16_t place = bit_and(inputs.next<uint16_t>(), uint16_t{0xFFC0});
    int16_t ground[Paper::Layout::kFarAhead + 1u] = {};
    const int16_t sinkage[Paper::Layout::kFront + 1u] = {};
    for (uint16_t bin = 0; bin <= Paper::Layout::kFarAhead; ++bin) {
        ground[bin] = rise_q4_mm(place, shift_left_wrap<6>(bin));
    }
    map.reset(ground, sinkage, {});
    for (uint8_t cycle = 0; cycle < 30; ++cycle) {
        place = add_wrap(place, uint16_t{128});
        const bool noisy = cycle >= 20;
        MapPaperHeights heights;
        heights.middle_q4_mm = noisy ? inputs.next<int16_t>() : rise_q4_mm(place, 640);
        heights.front_q4_mm = noisy ? inputs.next<int16_t>() : rise_q4_mm(place, 1280);
        heights.near_ahead_q4_mm = rise_q4_mm(place, 1536);
        heights.far_ahead_q4_mm = rise_q4_mm(place, 2048);
        sum.add(map.step(heights));
        sum.add(map.sinkage_q4_mm());
        sum.add(map.least_cost());
        sum.add(map.search_last());
        sum.add(map.ground_q4_mm(20));
        sum.add(map.surface_q4_mm(10));
    }
}

}  // namespace

void run_estimation_groups() {
    run("map_grid_course", 1, check_map_grid_course);
    run("map_grid_noise", 4, check_map_grid_noise);
    run("map_paper", 1, check_map_paper);
}

}  // namespace probe
