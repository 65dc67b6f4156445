// slip_tuning.hpp - every constant of the flying slip-and-sinkage estimator, with unit and range.
// Depends on   rover_words.hpp.
// Source       docs/design/slip-and-sinkage.md, "Tuning"; the same values in double precision are
//              host_sim::MapGridTuning (checked against these in map_grid_test.cpp).
// Units        a bin is 25 mm; "q6_bin" is 1/64 bin (0.39 mm); heights are mm Q4.
#pragma once

#include "rover_words.hpp"

namespace rover::slip {

// -- Geometry of the map --------------------------------------------------------------------------
inline constexpr uint8_t kBinMm = 25;
inline constexpr uint8_t kNodeCount = 32;         ///< ring of surface heights: 80 cm of ground
inline constexpr uint8_t kKnownNodes = 21;        ///< 0 to 50 cm: what a start from a ramp needs
inline constexpr uint8_t kHalfBinCandidates = 9;  ///< around the expected place, 1.25 cm apart
inline constexpr uint16_t kBeyondQ6Bin = 160;     ///< last candidate beyond the expected place
inline constexpr uint16_t kReachQ6Bin = 256;      ///< 10 cm: a longer cycle is not matched
inline constexpr uint16_t kGapMaxQ6Bin = 640;     ///< 25 cm: a longer hole is not bridged
inline constexpr uint16_t kMiddleMinQ6Bin = 64;   ///< 2.5 cm
inline constexpr uint16_t kMiddleMaxQ6Bin = 704;  ///< 27.5 cm
inline constexpr uint16_t kFrontMaxQ6Bin = 1408;  ///< 55 cm
inline constexpr uint16_t kForgetBehindQ6Bin = 8192;  ///< 3.2 m behind the map: it is dropped

// -- Matching -------------------------------------------------------------------------------------
// Squares are looked up at 16 steps per sigma and stored in 1/64 of a squared sigma.
inline constexpr uint8_t kPriorShift = 7;            ///< q12_bin -> 16 steps per 1.25 cm
inline constexpr uint16_t kPriorVarianceQ12 = 1024;  ///< (1.25 cm)^2 in (1/64 bin)^2
inline constexpr uint8_t kSigmaPerRoughShift = 2;    ///< residual sigma = rough / 4
inline constexpr uint16_t kSigmaFloorQ8Mm = 26;      ///< 0.10 mm
inline constexpr uint8_t kWidenPerCostQ8 = 179;      ///< 0.70
inline constexpr uint16_t kWidenMaxQ8 = 768;         ///< 3.0
inline constexpr int16_t kMisfitMaxQ4Mm = 2047;      ///< 128 mm: beyond, misfits are all the same
/// Roughness from which on sigma counts as 16 mm (64 mm / sqrt 2 / 1.04, over what widens it), by
/// quarters of the running cost.
inline constexpr uint8_t kRoughOf16MmQ1[17] = {87, 87, 87, 87, 87, 87, 76, 66, 58,
                                               52, 47, 43, 40, 37, 34, 32, 31};
inline constexpr uint8_t kCostCapQ3 = 128;           ///< 16
inline constexpr uint16_t kReacquireCostQ10 = 4096;  ///< 4: above it matching has failed
inline constexpr uint16_t kTrackingCostQ10 = 1536;   ///< 3/2: below it lock is back
inline constexpr uint16_t kAfterLossCostQ10 = 2048;  ///< 2: running cost restarts here
inline constexpr uint16_t kInitialCostQ10 = 1024;    ///< 1
inline constexpr uint8_t kCredibleFitQ3 = 200;       ///< 25: five sigma at the edge is no match

// -- Learned prior --------------------------------------------------------------------------------
inline constexpr int16_t kMeanNoSlipQ12Bin = 9830;     ///< 6.0 cm
inline constexpr int16_t kMeanMinQ12Bin = 1638;        ///< 1.0 cm
inline constexpr int16_t kMeanReacquireQ12Bin = 8192;  ///< 5.0 cm
inline constexpr uint8_t kLearnSteps = 24;
/// 256 / (n + 8), n = 0 ... 24: a mean that starts quickly and ends at gain 1/32.
inline constexpr uint8_t kLearnGainQ8[kLearnSteps + 1] = {
    32, 28, 26, 23, 21, 20, 18, 17, 16, 15, 14, 13, 13, 12, 12, 11, 11, 10, 10, 9, 9, 9, 9, 8, 8};

// -- Roughness ------------------------------------------------------------------------------------
inline constexpr uint16_t kInitialRoughQ8Mm = 768;  ///< 3 mm
inline constexpr uint16_t kBendMaxQ4Mm = 2047;      ///< 128 mm
inline constexpr uint16_t kRoughMaxQ8Mm = kBendMaxQ4Mm * 16u;

// -- Sinkage --------------------------------------------------------------------------------------
inline constexpr uint8_t kSampleReach = 31;      ///< bins ahead of the front wheel's
inline constexpr uint8_t kSearchBins = 8;        ///< 20 cm: no sample so far ahead is waited for
inline constexpr uint16_t kSpanMaxQ8Bin = 4096;  ///< 40 cm between samples: nothing is known
inline constexpr uint8_t kNoiseFloorQ4Mm = 10;   ///< 0.378 x 0.82 x 2 mm
inline constexpr uint16_t kSizeMaxQ5Mm = 511;    ///< 16 mm
inline constexpr uint8_t kSizeSteps = 31;
/// 256 / (n + 1), n = 0 ... 31.
inline constexpr uint8_t kSizeGainQ8[kSizeSteps + 1] = {
    255, 128, 85, 64, 51, 43, 37, 32, 28, 26, 23, 21, 20, 18, 17, 16,
    15,  14,  13, 13, 12, 12, 11, 11, 10, 10, 9,  9,  9,  9,  8,  8};

// -- Position uncertainty -------------------------------------------------------------------------
inline constexpr uint16_t kSpreadStepQ6Bin = 8;        ///< 3.1 mm
inline constexpr uint8_t kSpreadStepsMax = 2;          ///< a cycle
inline constexpr uint16_t kSpreadMaxQ6Bin = 4000;      ///< 1.6 m; 16 times that fit in a word
inline constexpr uint16_t kDriftPerLossQ12Bin = 8192;  ///< 5 cm for each loss of lock
inline constexpr uint16_t kDriftPerMoveQ12Bin = 4096;  ///< 2.5 cm when moved by hand
inline constexpr uint16_t kDriftPerTurnQ12Bin = 819;   ///< 0.5 cm per turning cycle
inline constexpr uint16_t kBendInformedQ3 = 19;  ///< below: 0.85 of the prior's variance or more
/// Variance 2^14 / bend of a parabola in quarters of (1/64 bin)^2, by sixteenths of the bend.
inline constexpr uint8_t kVarianceQ10[32] = {
    0,  164, 102, 73, 57, 47, 39, 34, 30, 27, 24, 22, 20, 19, 18, 17,
    16, 15,  14,  13, 12, 12, 11, 11, 10, 10, 10, 9,  9,  9,  8,  8,
};

// -- Alarms ---------------------------------------------------------------------------------------
inline constexpr uint16_t kSlipAlarmCostQ10 = 3840;  ///< 3.75
inline constexpr int8_t kSlipAlarmPercent = 30;
inline constexpr uint16_t kPercentPerMeanQ16 = 667;  ///< 100 / 9830 in Q16
/// Below it the slip of the learned mean, in whole percent, is above kSlipAlarmPercent.
inline constexpr int16_t kSlipAlarmMeanQ12Bin =
    ((100L - kSlipAlarmPercent) * 65536 - 32768 + kPercentPerMeanQ16 - 1) / kPercentPerMeanQ16;
static_assert(kSlipAlarmMeanQ12Bin == 6829);
inline constexpr int16_t kSinkageAlarmQ4Mm = 480;  ///< 30 mm

static_assert(kNodeCount * kBinMm >= 500 + 100 + 4 * kBinMm, "the ring spans wheelbase and search");
static_assert(kTrackingCostQ10 < kAfterLossCostQ10 && kAfterLossCostQ10 < kReacquireCostQ10);
static_assert(kMeanMinQ12Bin < kMeanReacquireQ12Bin && kMeanReacquireQ12Bin < kMeanNoSlipQ12Bin);

}  // namespace rover::slip
