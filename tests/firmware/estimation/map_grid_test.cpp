// map_grid_test.cpp - the estimator that flies: tuning, agreement with double, modes.
// Figures "measured" are of 60 seeds other than those here.
#include "firmware/estimation/map_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "map_grid_rig.hpp"

namespace {

using namespace rover;
using host_sim::PlanarCourse;
using host_sim::TerrainKind;
using map_grid_rig::Rig;

static_assert(sizeof(MapGrid) < 400, "state of the estimator on the target");

host_sim::PlanarGround ground_of(std::uint64_t seed, double roughness) {
    return host_sim::make_planar_ground(TerrainKind::fractal, seed, 6250).scaled(roughness);
}

TEST(SlipTuning, IsTheDoubleModelsWithinRounding) {
    const host_sim::MapGridTuning tuning;
    using namespace rover::slip;
    EXPECT_EQ(kBinMm / 10.0, tuning.bin_cm);
    EXPECT_NEAR(kMeanNoSlipQ12Bin / 4096.0 * 2.5, tuning.prior_mean_cm, 0.0005);
    // A half bin is one sigma of the prior.
    EXPECT_EQ(tuning.prior_sigma_cm, tuning.bin_cm / 2);
    EXPECT_EQ(kPriorVarianceQ12, std::pow(tuning.prior_sigma_cm / 2.5 * 64, 2));
    EXPECT_EQ(1.6, tuning.sigma_max_cm);
    MapGrid smooth;  // 1/8 mm is the least sigma that there is
    smooth.rough_q8_mm = 0;
    EXPECT_EQ(residual_sigma_q3_mm(smooth) / 80.0, tuning.sigma_floor_cm);
    for (int quarter = 0; quarter <= 16; ++quarter) {
        const double cost = quarter < 16 ? (quarter + 0.5) / 4 : 4;
        const double widen = std::clamp(tuning.sigma_per_cost * cost, 1.0, tuning.sigma_widen_max);
        const double rough_cm =
            tuning.sigma_max_cm / std::sqrt(2) / 1.04 / widen / tuning.sigma_per_rough;
        EXPECT_NEAR(kRoughOf16MmQ1[quarter], 20 * rough_cm, 0.6) << quarter;
    }
    EXPECT_EQ(kCostCapQ3 / 8.0, tuning.cost_cap);
    EXPECT_EQ(kCredibleFitQ3 / 8.0, tuning.credible_fit);
    EXPECT_EQ(kReacquireCostQ10 / 1024.0, tuning.reacquire_cost);
    EXPECT_EQ(kAfterLossCostQ10 / 1024.0, tuning.reacquire_cost / 2);
    EXPECT_EQ(kTrackingCostQ10 / 1024.0, tuning.tracking_cost);
    EXPECT_NEAR(kMeanReacquireQ12Bin / 4096.0 * 2.5, tuning.reacquire_mean_cm, 1e-9);
    EXPECT_EQ(kSlipAlarmCostQ10 / 1024.0, tuning.slip_alarm_cost);
    EXPECT_EQ(kSlipAlarmPercent, tuning.slip_alarm_percent);
    EXPECT_EQ(kSinkageAlarmQ4Mm / 160.0, tuning.sinkage_alarm_cm);
    EXPECT_NEAR(kNoiseFloorQ4Mm / 160.0, std::sqrt(0.25 / (2 - 0.25)) * 0.82 * tuning.look_sigma_cm,
                0.5 / 160);
    EXPECT_NEAR(kPercentPerMeanQ16 / 65536.0, 100.0 / kMeanNoSlipQ12Bin, 0.5 / 65536);
    EXPECT_EQ(kBendInformedQ3, std::ceil(16 / 0.85));
    for (int n = 0; n <= kLearnSteps; ++n) {
        EXPECT_NEAR(kLearnGainQ8[n], std::max(8.0, 256.0 / (n + 8)), 0.5) << n;
    }
    for (int n = 1; n <= kSizeSteps; ++n) EXPECT_NEAR(kSizeGainQ8[n], 256.0 / (n + 1), 0.51) << n;
}

TEST(SlipPercent, IsThatOfTheLearnedMeanWithinOnePercent) {
    MapGrid map;
    for (int mean = slip::kMeanMinQ12Bin; mean <= slip::kMeanNoSlipQ12Bin; ++mean) {
        map.mean_q12_bin = static_cast<S16>(mean);
        const double slip_percent = 100 * (1 - mean / 4096.0 * 2.5 / 6);
        ASSERT_NEAR(slip::slip_percent(slip::learned_share_q15(map)), slip_percent, 0.6) << mean;
    }
}

// Whole traverses: 2500 bins, so that places (2^16 units of 1/64 bin) wrap twice. Choices between
// nearly equal minima differ now and then, and costs are known in 1/8 of a squared sigma. Measured
// in 270 runs: 26 cm apart at most, 3 to 5 cm in the median of the runs' worst.
TEST(MapGrid, StaysWithin0p6PercentOfTheDoubleModelInEveryCycleOf62Metres) {
    for (const double roughness : {0.005, 0.02, 0.08}) {
        for (std::uint64_t seed = 740000; seed < 740010; ++seed) {
            const auto ground = ground_of(seed, roughness);
            PlanarCourse course(ground, {}, seed);
            Rig rig(ground);
            int apart = 0;
            while (!course.finished()) {
                rig.step(course.next());
                const double off_cm = rig.fixed_cm() - rig.floating.position_cm();
                ASSERT_LE(std::abs(off_cm), 37.5) << "seed " << seed << " at " << rig.fixed_cm();
                const double advance_cm = rig.fixed.advance_q6_bin * 2.5 / 64;
                apart += std::abs(advance_cm - rig.floating.advance_cm()) > 0.5 ? 1 : 0;
            }
            EXPECT_GT(rig.fixed.travelled_q6_bin, 2 * 65536);
            EXPECT_LE(apart, 0.2 * rig.cycles) << "seed " << seed;
        }
    }
}

TEST(MapGrid, AHillOfThreeMetresWrapsHeightsWithoutHarm) {
    // s16 Q4 holds 4.1 m in all: a 10 % grade over 62 m climbs 6.2 m.
    const auto rough = ground_of(740050, 0.02);
    std::vector<double> heights_cm(25800);
    for (std::size_t i = 0; i < heights_cm.size(); ++i) {
        const double x_cm = 0.25 * static_cast<double>(i);
        heights_cm[i] = rough.ground_cm(x_cm) + 0.1 * x_cm;
    }
    const host_sim::PlanarGround hill(host_sim::Terrain(0, 0.25, heights_cm),
                                      host_sim::SinkageField());
    PlanarCourse course(hill, {}, 740050);
    Rig rig(hill);
    while (!course.finished()) rig.step(course.next());
    EXPECT_NEAR(rig.fixed_cm() / course.position_cm(), 1, 0.015);
}

/// Drives 200 cycles, does something, and drives on until the estimator tracks again.
struct Interrupted {
    std::vector<int> cycles;
    std::vector<double> error_cm;
};
Interrupted interrupt(double roughness, const std::function<void(Rig&, PlanarCourse&)>& action) {
    Interrupted result;
    for (std::uint64_t seed = 750000; seed < 750030; ++seed) {
        const auto ground = ground_of(seed, roughness);
        PlanarCourse course(ground, {}, seed);
        Rig rig(ground);
        for (int i = 0; i < 200; ++i) rig.step(course.next());
        const double before_cm = rig.fixed_cm() - course.position_cm();
        action(rig, course);
        int cycles = 0;
        do {
            rig.step(course.next());
            ++cycles;
        } while (rig.fixed.mode != SlipMode::tracking && cycles < 300);
        result.cycles.push_back(cycles);
        result.error_cm.push_back(std::abs(rig.fixed_cm() - course.position_cm() - before_cm));
    }
    std::sort(result.error_cm.begin(), result.error_cm.end());
    std::sort(result.cycles.begin(), result.cycles.end());
    const std::size_t runs = result.cycles.size();
    std::printf(
        "roughness %.3f: tracks again after %d cycles in the median, %d in 90 %%, %d at "
        "most; off by %.1f cm in the median, %.1f in 90 %%\n",
        roughness, result.cycles[runs / 2], result.cycles[runs * 9 / 10], result.cycles.back(),
        result.error_cm[runs / 2], result.error_cm[runs * 9 / 10]);
    return result;
}

// The first 10 cycles drive up to measured ground.
TEST(MapGrid, TracksAgainWithin80CyclesAfterTurningOrBeingMoved) {
    for (const double roughness : {0.005, 0.02, 0.08}) {
        for (const CycleMotion motion : {CycleMotion::turn, CycleMotion::moved}) {
            const Interrupted result = interrupt(roughness, [&](Rig& rig, PlanarCourse&) {
                rig.step_motion(motion, 0);
                EXPECT_EQ(rig.fixed.mode,
                          motion == CycleMotion::turn ? SlipMode::turning : SlipMode::moved);
                EXPECT_FALSE(rig.fixed.has_map);
                EXPECT_EQ(rig.fixed.advance_q6_bin, 0);
            });
            EXPECT_LE(*std::max_element(result.cycles.begin(), result.cycles.end()), 80);
            EXPECT_LE(result.error_cm[15], 5);
        }
    }
}

TEST(MapGrid, TracksAgainWithin80CyclesAfterTheLinkageDropsOutFor1To20) {
    for (int length = 1; length <= 20; ++length) {
        const Interrupted result = interrupt(0.02, [&](Rig& rig, PlanarCourse& course) {
            const auto sigma_before = position_sigma_q4_mm(rig.fixed);
            for (int i = 0; i < length; ++i) {
                rig.step(course.next(), false);
                EXPECT_EQ(rig.fixed.mode, SlipMode::odometry_only);
                EXPECT_FALSE(rig.fixed.sinkage_valid);
                EXPECT_GT(rig.fixed.advance_q6_bin, 0);  // the learned mean
            }
            EXPECT_GT(position_sigma_q4_mm(rig.fixed), sigma_before);
        });
        EXPECT_LE(*std::max_element(result.cycles.begin(), result.cycles.end()), 80) << length;
        EXPECT_LE(result.error_cm[15], 8) << length;
    }
}

TEST(MapGrid, TracksNotBeforeTheCostHasFallenAfterOneCycleWithoutLinkage) {
    const auto ground = ground_of(760003, 0.02);
    PlanarCourse course(ground, {}, 760003);
    Rig rig(ground);
    for (int i = 0; i < 100; ++i) rig.step(course.next());
    rig.step(course.next(), false);
    rig.fixed.match_cost_q10 = 2 * 1024;  // after one cycle it is 1.75 at least
    rig.step(course.next());
    EXPECT_EQ(rig.fixed.mode, SlipMode::reacquiring);
}

TEST(MapGrid, ReversingFollowsTheOdometerAndSaysSo) {
    const auto ground = ground_of(760000, 0.02);
    PlanarCourse course(ground, {}, 760000);
    Rig rig(ground);
    for (int i = 0; i < 100; ++i) rig.step(course.next());
    const S32 before = rig.fixed.travelled_q6_bin;
    const auto sigma_before = position_sigma_q4_mm(rig.fixed);
    for (int i = 0; i < 10; ++i) {
        rig.step_motion(CycleMotion::reverse, -6);
        EXPECT_EQ(rig.fixed.mode, SlipMode::reversing);
        EXPECT_EQ(rig.fixed.advance_q6_bin, -154);
    }
    EXPECT_EQ(rig.fixed.travelled_q6_bin, before - 1540);
    EXPECT_GT(position_sigma_q4_mm(rig.fixed), sigma_before);
    EXPECT_TRUE(rig.fixed.has_map);  // 60 cm back: still worth keeping
}

TEST(MapGrid, ReversingFarDropsTheMap) {
    const auto ground = ground_of(760001, 0.02);
    PlanarCourse course(ground, {}, 760001);
    Rig rig(ground);
    for (int i = 0; i < 100; ++i) rig.step(course.next());
    for (int i = 0; i < 70; ++i) rig.step_motion(CycleMotion::reverse, -6);  // 4.2 m
    EXPECT_FALSE(rig.fixed.has_map);
}

// Back by 30 cm and forth over the same ground: the map is known, and tracking returns.
TEST(MapGrid, TracksAgainAfterAShortReverse) {
    int tracking = 0;
    for (std::uint64_t seed = 760010; seed < 760030; ++seed) {
        const auto ground = ground_of(seed, 0.02);
        PlanarCourse course(ground, {}, seed);
        Rig rig(ground);
        for (int i = 0; i < 100; ++i) rig.step(course.next());
        for (int i = 0; i < 3; ++i) rig.step_motion(CycleMotion::reverse, -6);
        for (int i = 0; i < 80; ++i) rig.step(course.next());
        tracking += rig.fixed.mode == SlipMode::tracking ? 1 : 0;
    }
    EXPECT_GE(tracking, 18);  // of 20: a loss of lock for another reason may fall on the 80th cycle
}

TEST(MapGrid, ACycleBeyondTheSearchIsDeadReckoned) {
    const auto ground = ground_of(760002, 0.02);
    PlanarCourse course(ground, {}, 760002);
    Rig rig(ground);
    for (int i = 0; i < 100; ++i) rig.step(course.next());
    MapGridInput input;
    input.linkage = true;
    input.odometer_q6_bin = 300;  // 11.7 cm in one cycle
    input.middle_height_q4_mm = 10;
    input.front_height_q4_mm = 20;
    const int mean_q6 = rig.fixed.mean_q12_bin / 64;
    map_grid_step(rig.fixed, input);
    EXPECT_NEAR(rig.fixed.advance_q6_bin, mean_q6 + 300 - 153.6, 2);
    EXPECT_EQ(rig.fixed.mode, SlipMode::reacquiring);
}

TEST(MapGrid, AFoldedLinkageCountsAsNone) {
    MapGrid map;
    MapGridInput input;
    input.linkage = true;
    input.odometer_q6_bin = 154;
    for (const auto& [middle, front] :
         {std::pair<int, int>{63, 1280}, {705, 1280}, {640, 1409}, {640, 703}}) {
        input.middle_distance_q6_bin = static_cast<U16>(middle);
        input.front_distance_q6_bin = static_cast<U16>(front);
        map_grid_step(map, input);
        EXPECT_EQ(map.mode, SlipMode::odometry_only) << middle << " " << front;
        EXPECT_FALSE(map.has_map);
    }
}

TEST(MapGrid, LossOfLockIsReportedOnceAndRaisesTheSlipAlarm) {
    int losses = 0;
    for (std::uint64_t seed = 770000; seed < 770020; ++seed) {
        const auto ground = ground_of(seed, 0.02);
        host_sim::CourseOptions options;
        options.onset = host_sim::SlipOnset{1000, 0.5, 0};  // digging in
        PlanarCourse course(ground, options, seed);
        Rig rig(ground);
        bool reacquiring = false;
        for (int i = 0; i < 300 && !course.finished(); ++i) {
            const auto sigma_before = position_sigma_q4_mm(rig.fixed);
            rig.step(course.next());
            if (rig.fixed.lost_lock) {
                ++losses;
                EXPECT_FALSE(reacquiring);  // not twice without lock in between
                EXPECT_TRUE(rig.fixed.slip_alarm);
                EXPECT_EQ(rig.fixed.mode, SlipMode::reacquiring);
                // 5 cm, less what the square root makes of rounding.
                EXPECT_GE(position_sigma_q4_mm(rig.fixed), sigma_before + 790);
            }
            reacquiring = rig.fixed.mode == SlipMode::reacquiring;
        }
    }
    EXPECT_GE(losses, 15);
}

TEST(PositionSigma, IsSpreadPlusDriftRoundedDown) {
    MapGrid map;
    for (uint16_t spread = 0; spread <= slip::kSpreadMaxQ6Bin; spread += 8) {
        map.spread_q6_bin = spread;
        for (const uint32_t drift : {0u, 5000u, 123456u, 400000u}) {
            map.drift_q12_bin = drift;
            // 1/64 bin is 6.25 units of 1/16 mm; the drift is rounded down to it.
            const double sigma = (spread + drift / 64.0) * 6.25;
            if (sigma > 65535) continue;
            ASSERT_LE(position_sigma_q4_mm(map), sigma);
            ASSERT_GE(position_sigma_q4_mm(map), sigma - 6.25 - 1);
        }
    }
    map.drift_q12_bin = 0xFFFFFFFF;
    EXPECT_EQ(position_sigma_q4_mm(map), 65535);
}

}  // namespace
