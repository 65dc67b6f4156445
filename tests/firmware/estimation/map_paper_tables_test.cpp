// map_paper_tables_test.cpp - squares against multiplication, prior costs against double.
#include "firmware/estimation/map_paper_tables.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace {

using rover::MapPaperPrior;

TEST(MapPaperSquare, IsExactForEveryU16) {
    for (std::uint32_t size = 0; size <= 0xFFFF; ++size) {
        ASSERT_EQ(rover::map_paper_square(static_cast<std::uint16_t>(size)), size * size) << size;
    }
}

TEST(MapPaperHeightCost, IsFourSquaresForEveryResidualAndSaturatesOnlyAtTheMostNegative) {
    for (std::int32_t residual = -32767; residual <= 32767; ++residual) {
        const auto exact = 4 * static_cast<std::int64_t>(residual) * residual;
        ASSERT_EQ(rover::map_paper_height_cost(static_cast<std::int16_t>(residual)), exact);
    }
    EXPECT_EQ(rover::map_paper_height_cost(-32768), 0xFFFF'FFFFu);
}

TEST(MapPaperHeightCost, UnitIsTheWheelNoiseOf004Millimetres) {
    const double steps = 0.04 * 16;
    EXPECT_NEAR(rover::kMapPaperCostPerSigmaSquaredQ14 / 16384.0, 4 * steps * steps, 1e-4);
}

// The exact cost is (distance / sigma)^2 in units of the wheel noise.
TEST(MapPaperPriorCost, ErrorIsBelowASixteenthOfItsRootPlusOne) {
    for (std::uint32_t sigma_q8_mm = 26; sigma_q8_mm <= 51200; sigma_q8_mm += 1 + sigma_q8_mm / 7) {
        for (std::uint32_t mean_q4_mm : {0u, 480u, 960u, 8000u}) {
            const MapPaperPrior prior{.mean_q4_mm = static_cast<std::uint16_t>(mean_q4_mm),
                                      .sigma_q8_mm = static_cast<std::uint16_t>(sigma_q8_mm)};
            for (std::uint32_t advance_q4_mm = 0; advance_q4_mm <= 8192; advance_q4_mm += 13) {
                const double distance_mm = (advance_q4_mm - static_cast<double>(mean_q4_mm)) / 16;
                const double sigmas = distance_mm / (sigma_q8_mm / 256.0);
                const double exact = sigmas * sigmas * 1.6384;
                if (std::sqrt(exact) >= 4095) continue;
                const auto cost =
                    rover::map_paper_prior_cost(static_cast<std::uint16_t>(advance_q4_mm), prior);
                ASSERT_LE(std::abs(cost - exact), std::sqrt(exact) / 16 + 1)
                    << "sigma " << sigma_q8_mm << " mean " << mean_q4_mm << " at " << advance_q4_mm;
            }
        }
    }
}

TEST(MapPaperPriorCost, SigmaOfZeroAllowsNothingButTheMean) {
    const MapPaperPrior prior{.mean_q4_mm = 960, .sigma_q8_mm = 0};
    EXPECT_EQ(rover::map_paper_prior_cost(960, prior), 0u);
    EXPECT_GE(rover::map_paper_prior_cost(961, prior), 4095u * 4095u);
    EXPECT_GE(rover::map_paper_prior_cost(0, prior), 4095u * 4095u);
}

TEST(MapPaperPriorCost, SaturatesFarFromTheMean) {
    const MapPaperPrior prior{.mean_q4_mm = 0, .sigma_q8_mm = 1};
    EXPECT_EQ(rover::map_paper_prior_cost(8192, prior), rover::map_paper_prior_cost(8000, prior));
}

}  // namespace
