// map_grid_fuzz_test.cpp - any sequence of inputs leaves a defined state. Under the asan preset the
// same tests show that nothing is undefined.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <random>
#include <vector>

#include "firmware/estimation/map_grid.hpp"

namespace {

using namespace rover;

/// What must hold after every step; nothing if it does.
const char* broken(const MapGrid& map, const MapGrid& before) {
    if (map.sinkage_count > slip::kSizeSteps) return "sinkage_count";
    if (map.learned > slip::kLearnSteps || map.rough_count > slip::kLearnSteps) return "learned";
    if (map.mean_q12_bin < slip::kMeanMinQ12Bin || map.mean_q12_bin > slip::kMeanNoSlipQ12Bin) {
        return "mean";
    }
    if (map.rough_q8_mm > slip::kRoughMaxQ8Mm) return "rough";
    if (map.match_cost_q10 > slip::kReacquireCostQ10) return "match_cost";
    if (map.mode > SlipMode::moved) return "mode";
    if (map.measured && !map.has_map) return "measured without a map";
    if (map.sinkage_q4_mm < 0) return "sinkage";
    if (map.sinkage_valid && !map.has_behind) return "sinkage_valid";
    if (map.spread_q6_bin < before.spread_q6_bin) return "spread fell";
    if (map.spread_q6_bin > slip::kSpreadMaxQ6Bin) return "spread";
    if (map.variance_q12 < before.variance_q12) return "variance fell";
    if (map.drift_q12_bin < before.drift_q12_bin) return "drift fell";
    if (map.advance_q6_bin < 0 && map.mode != SlipMode::reversing) return "advance";
    const auto moved = static_cast<uint16_t>(map.place_q6_bin - before.place_q6_bin);
    const auto travelled = static_cast<uint16_t>(static_cast<uint32_t>(map.travelled_q6_bin) -
                                                 static_cast<uint32_t>(before.travelled_q6_bin));
    if (moved != travelled || moved != static_cast<uint16_t>(map.advance_q6_bin)) return "place";
    const auto slip_percent = slip::slip_percent(slip::learned_share_q15(map));
    if (slip_percent < 0 || slip_percent > 84) return "slip_percent";
    return nullptr;
}

template <class Bits>
MapGridInput any_input(Bits&& bits, bool plausible) {
    MapGridInput input;
    input.motion =
        static_cast<CycleMotion>(plausible ? (bits() % 64 == 0 ? bits() % 4 : 0) : bits() % 4);
    input.linkage = bits() % 16 != 0;
    input.ahead_count = static_cast<uint8_t>(plausible ? bits() % 3 : bits());
    const auto small = [&](int centre, int width) {
        return static_cast<int16_t>(
            centre + static_cast<int>(bits() % (2 * static_cast<unsigned>(width) + 1)) - width);
    };
    input.odometer_q6_bin = plausible ? small(153, 30) : static_cast<int16_t>(bits());
    input.middle_height_q4_mm = plausible ? small(0, 900) : static_cast<int16_t>(bits());
    input.front_height_q4_mm = plausible ? small(0, 1800) : static_cast<int16_t>(bits());
    const bool fair = plausible || bits() % 2 == 0;
    input.middle_distance_q6_bin = static_cast<uint16_t>(fair ? small(620, 80) : small(0, 32767));
    input.front_distance_q6_bin = static_cast<uint16_t>(fair ? small(1240, 160) : small(0, 32767));
    const uint32_t reach = plausible ? 1000 : 6000;  // the far ones are beyond the ring
    for (int i = 0; i < kLookAheadMax; ++i) {
        input.ahead_height_q4_mm[i] = static_cast<int16_t>(bits());
        input.ahead_distance_q6_bin[i] = static_cast<uint16_t>(1400 + bits() % reach);
    }
    return input;
}

void fuzz(unsigned seed, int cycles, bool plausible) {
    std::mt19937 random(seed);
    MapGrid map;
    for (int i = 0; i < cycles; ++i) {
        const MapGrid before = map;
        map_grid_step(map, any_input([&] { return random(); }, plausible));
        const char* what = broken(map, before);
        ASSERT_EQ(what, nullptr) << what << ", seed " << seed << ", cycle " << i;
    }
}

TEST(MapGrid, AnyInputSequenceLeavesADefinedState) {
    for (unsigned seed = 1; seed <= 4; ++seed) fuzz(seed, 125'000, false);
}

TEST(MapGrid, PlausibleInputsWithFaultsLeaveADefinedState) {
    for (unsigned seed = 11; seed <= 14; ++seed) fuzz(seed, 125'000, true);
}

TEST(MapGrid, AnyShortSequenceLeavesADefinedState) {
    const bool held = rc::check("any short sequence leaves a defined state", [] {
        const auto words =
            *rc::gen::container<std::vector<uint32_t>>(rc::gen::arbitrary<uint32_t>());
        std::size_t next = 0;
        const auto bits = [&] { return next < words.size() ? words[next++] : 0u; };
        MapGrid map;
        do {
            const MapGrid before = map;
            map_grid_step(map, any_input(bits, false));
            const char* what = broken(map, before);
            if (what != nullptr) RC_FAIL(what);
        } while (next < words.size());
    });
    EXPECT_TRUE(held);
}

// The text asks for an estimator that is never stuck: after any sequence, ordinary ground is
// tracked again.
TEST(MapGrid, IsNeverStuck) {
    for (unsigned seed = 21; seed < 61; ++seed) {
        std::mt19937 random(seed);
        MapGrid map;
        for (int i = 0; i < 500; ++i)
            map_grid_step(map, any_input([&] { return random(); }, false));
        // A level plain with a bump every metre, no slip: nothing but consistent.
        const auto ground = [](double bin) {
            return 400 * std::sin(bin * 0.7) * std::sin(bin / 9);
        };
        double place = 0;
        int tracking = 0;
        for (int i = 0; i < 200; ++i) {
            place += 2.4;
            MapGridInput input;
            input.linkage = true;
            input.odometer_q6_bin = static_cast<int16_t>(i % 5 < 3 ? 154 : 153);
            input.middle_height_q4_mm =
                static_cast<int16_t>(std::lround(ground(place + 10) - ground(place)));
            input.front_height_q4_mm =
                static_cast<int16_t>(std::lround(ground(place + 20) - ground(place)));
            map_grid_step(map, input);
            if (i >= 100 && map.mode == SlipMode::tracking) ++tracking;
        }
        EXPECT_GE(tracking, 80) << "seed " << seed;
    }
}

}  // namespace
