// vehicle_test.cpp - the constants of the image against the vehicle's description and each other.
#include "firmware/config/vehicle.hpp"

#include <gtest/gtest.h>

#include "firmware/config/controller_tuning.hpp"
#include "firmware/config/slip_tuning.hpp"
#include "hal/calibration.hpp"
#include "host_sim/world/vehicle.hpp"

namespace {

constexpr double kQ4PerCm = 160.0;
constexpr double kQ6BinPerCm = 64 / 2.5;

TEST(Vehicle, ConstantsAreThoseOfTheDescription) {
    const host_sim::Vehicle vehicle = host_sim::rocky32();
    using namespace rover::vehicle;
    EXPECT_EQ(kRockerQ4Mm, vehicle.rocker_cm * kQ4PerCm);
    EXPECT_EQ(kRockerQ6Bin, vehicle.rocker_cm * kQ6BinPerCm);
    EXPECT_EQ(kBogieArmQ4Mm, vehicle.bogie_arm_cm * kQ4PerCm);
    EXPECT_EQ(kBogieArmQ6Bin, vehicle.bogie_arm_cm * kQ6BinPerCm);
    EXPECT_EQ(kBodyReferenceQ4Mm, vehicle.body_reference_cm * kQ4PerCm);
    ASSERT_EQ(kLookAheadCount, vehicle.range_sample_cm.size());
    for (std::size_t i = 0; i < kLookAheadCount; ++i) {
        const double ahead_cm = vehicle.range_sample_cm[i] - vehicle.body_reference_cm;
        EXPECT_EQ(kLookAheadQ4Mm[i], ahead_cm * kQ4PerCm);
    }
}

TEST(Vehicle, NominalCalibrationIsThatOfTheDescription) {
    const hal::Calibration described = host_sim::nominal_calibration(host_sim::rocky32());
    const hal::Calibration nominal;
    for (std::size_t i = 0; i < hal::kAngleChannelCount; ++i) {
        EXPECT_EQ(nominal.angle[i].gain_q16, described.angle[i].gain_q16);
        EXPECT_EQ(nominal.angle[i].inverted, described.angle[i].inverted);
    }
    EXPECT_EQ(nominal.wheel_radius_q4_mm, described.wheel_radius_q4_mm);
    EXPECT_EQ(nominal.tach_counts_per_turn, described.tach_counts_per_turn);
    EXPECT_EQ(nominal.tach_q16_mm_per_count, described.tach_q16_mm_per_count);
}

TEST(ControllerTuning, ACycleIsSixCentimetresInEveryUnit) {
    EXPECT_EQ(rover::kCycleTravelQ4Mm, 60 * 16);
    // The estimator's no-slip advance is the same length in 1/4096 bin of 25 mm, rounded.
    EXPECT_NEAR(rover::slip::kMeanNoSlipQ12Bin, 60.0 / 25 * 4096, 0.5);
}

TEST(ControllerTuning, LimitsKeepTheOdometersSumsInRange) {
    // Two sides, each a pulse count and a lead, are added in 16 bits.
    EXPECT_LE(2 * (rover::kTachStepMaxCount + 2 * rover::kTachLeadMaxCount), 32767);
    EXPECT_LT(rover::kScanFreshSteps, rover::kScanStaleSteps);
}

}  // namespace
