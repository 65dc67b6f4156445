// soil_test.cpp - known laws, damaged tables, the sand data set.
#include "host_sim/world/soil.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

namespace host_sim {
namespace {

const std::string kData = ROVER_SOURCE_DIR "/../shared/data/sand-single-wheel/steady_state.csv";

// Columns in another order than the data set's, and one that is not needed.
std::string table(const std::string& rows) {
    return "slip,wheel,extra,slip_angle_cmd_deg,vwheel_cmd_mm_s,z_mean_mm\n" + rows;
}

std::string row(double slip, const char* wheel, double angle, double speed, double z) {
    return std::to_string(slip) + "," + wheel + ",0," + std::to_string(angle) + "," +
           std::to_string(speed) + "," + std::to_string(z) + "\n";
}

TEST(SinkageLaw, IsZeroAtRollingAndHoldsItsEnds) {
    const SinkageLaw law{20, 1.5};
    EXPECT_EQ(law.depth_mm(0), 0);
    EXPECT_EQ(law.depth_mm(-0.7), 0);
    EXPECT_EQ(law.depth_mm(std::nan("")), 0);
    EXPECT_DOUBLE_EQ(law.depth_mm(1), 20);
    EXPECT_DOUBLE_EQ(law.depth_mm(7), 20);
    EXPECT_NEAR(law.depth_mm(0.25), 20 * 0.125, 1e-12);
}

TEST(FitSinkage, RecoversAKnownLawFromItsOwnTrialsOnly) {
    std::string rows;
    rows += row(0.001, "smooth", 0, 10, -11.5) + row(-0.001, "smooth", 0, 10, -12.5);
    for (const double slip : {0.1, 0.2, 0.4, 0.6, 0.8, 0.9}) {
        rows += row(slip, "smooth", 0, 10 / (1 - slip), -12 - 17 * std::pow(slip, 0.9));
        rows += row(slip, "grouser", 0, 10 / (1 - slip), -99);
        rows += row(slip, "smooth", 15, 10 / (1 - slip), -77);
    }
    rows += row(-0.5, "smooth", 0, 5, -50);
    const SinkageFit fit = fit_sinkage(table(rows), "t.csv", WheelKind::smooth);
    EXPECT_EQ(fit.trials.size(), 8u);
    EXPECT_NEAR(fit.law.scale_mm, 17, 1e-3);
    EXPECT_NEAR(fit.law.exponent, 0.9, 1e-3);
    // Only the two rolling trials, half a millimetre off each, remain.
    EXPECT_NEAR(fit.rms_mm, std::sqrt(2 * 0.25 / 8), 1e-3);
}

TEST(FitSinkage, RefusesDamagedTablesWithTheLine) {
    const std::string good = row(0, "smooth", 0, 10, 0) + row(0.2, "smooth", 0, 12, -1) +
                             row(0.5, "smooth", 0, 20, -2) + row(0.7, "smooth", 0, 33, -3);
    EXPECT_NO_THROW(fit_sinkage(table(good), "t.csv", WheelKind::smooth));
    const struct {
        std::string text;
        const char* expected;
    } cases[] = {
        {"", "t.csv: is empty"},
        {"slip,wheel\n", "t.csv:1: column 'slip_angle_cmd_deg' is missing"},
        {"slip,slip,wheel,slip_angle_cmd_deg,vwheel_cmd_mm_s,z_mean_mm\n", "appears twice"},
        {table(good + "0.1,smooth,0,0,10\n"), "t.csv:6: has 5 fields, the header 6"},
        {table(good + "0.1,round,0,0,10,0\n"), "t.csv:6: wheel must be"},
        {table(good + "0.1,smooth,0,0,10,deep\n"), "t.csv:6: 'deep' in column 'z_mean_mm'"},
        {table(good + "0.1,smooth,0,0,10,nan\n"), "t.csv:6: 'nan'"},
        {table(good + "2,smooth,0,0,10,0\n"), "t.csv:6: slip must be"},
        {table(row(0.2, "smooth", 0, 12, -1)), "needs a rolling trial"},
        {table(row(0, "smooth", 0, 10, -1)), "needs a rolling trial"},
    };
    for (const auto& one : cases) {
        try {
            fit_sinkage(one.text, "t.csv", WheelKind::smooth);
            ADD_FAILURE() << one.text;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(one.expected), std::string::npos)
                << error.what();
        }
    }
    EXPECT_THROW(fit_sinkage_file("/no/such.csv", WheelKind::smooth), InputError);
}

// The data set's own description: 10 mm at slip 0.5, 17 at 0.75 and 26 at 0.9 with grousers; 8, 11
// and 11 mm smooth; about 30 s^1.7 and 13 s^0.8.
TEST(SandData, FitsAreThePublishedLawsAndTheBuiltInOnes) {
    if (!std::filesystem::exists(kData)) GTEST_SKIP() << kData << " is not there";
    const SinkageFit grouser = fit_sinkage_file(kData, WheelKind::grouser);
    const SinkageFit smooth = fit_sinkage_file(kData, WheelKind::smooth);
    std::printf("grouser %.2f slip^%.3f mm, residual %.2f mm, %zu trials\n", grouser.law.scale_mm,
                grouser.law.exponent, grouser.rms_mm, grouser.trials.size());
    std::printf("smooth  %.2f slip^%.3f mm, residual %.2f mm, %zu trials\n", smooth.law.scale_mm,
                smooth.law.exponent, smooth.rms_mm, smooth.trials.size());
    EXPECT_NEAR(grouser.law.scale_mm, 30, 1);
    EXPECT_NEAR(grouser.law.exponent, 1.7, 0.05);
    EXPECT_NEAR(smooth.law.scale_mm, 13, 0.5);
    EXPECT_NEAR(smooth.law.exponent, 0.8, 0.05);
    EXPECT_NEAR(grouser.law.depth_mm(0.5), 10, 2);
    EXPECT_NEAR(grouser.law.depth_mm(0.75), 17, 2);
    EXPECT_NEAR(grouser.law.depth_mm(0.9), 26, 2);
    EXPECT_NEAR(smooth.law.depth_mm(0.5), 8, 1);
    EXPECT_NEAR(smooth.law.depth_mm(0.9), 11, 1.2);
    for (const auto& [fit, kind] :
         {std::pair{grouser, WheelKind::grouser}, std::pair{smooth, WheelKind::smooth}}) {
        const SinkageLaw built_in = built_in_sinkage_law(kind);
        EXPECT_NEAR(built_in.scale_mm, fit.law.scale_mm, 0.01);
        EXPECT_NEAR(built_in.exponent, fit.law.exponent, 0.001);
    }
}

}  // namespace
}  // namespace host_sim
