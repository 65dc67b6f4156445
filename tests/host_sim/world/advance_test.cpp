// advance_test.cpp - moments of the paper's distributions.
#include "host_sim/world/advance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace host_sim {
namespace {

constexpr int kDraws = 200000;

struct Moments {
    double mean = 0;
    double sigma = 0;
    double low = 1e9;
    double high = -1e9;
};

Moments moments_of(const AdvanceModel& model, double slope, double sinkage_cm) {
    Random random = stream(1, "advance");
    Moments moments;
    double squares = 0;
    for (int i = 0; i < kDraws; ++i) {
        const double advance = draw_advance_cm(model, slope, sinkage_cm, random);
        moments.mean += advance / kDraws;
        squares += advance * advance / kDraws;
        moments.low = std::min(moments.low, advance);
        moments.high = std::max(moments.high, advance);
    }
    moments.sigma = std::sqrt(squares - moments.mean * moments.mean);
    return moments;
}

TEST(DrawAdvance, GaussianHasMeanAndSigma) {
    const Moments found = moments_of({AdvanceKind::gaussian, 5, 1, 2}, 0.5, 3);
    EXPECT_NEAR(found.mean, 5, 0.012);
    EXPECT_NEAR(found.sigma, 1, 0.01);
    EXPECT_GT(found.high, 8.5);
}

TEST(DrawAdvance, UniformFillsItsInterval) {
    const Moments found = moments_of({AdvanceKind::uniform, 5, 1, 2}, 0.5, 3);
    EXPECT_NEAR(found.mean, 5, 0.015);
    EXPECT_NEAR(found.sigma, 2 / std::sqrt(3.0), 0.01);
    EXPECT_NEAR(found.low, 3, 0.01);
    EXPECT_NEAR(found.high, 7, 0.01);
}

TEST(DrawAdvance, ConstantIsTheMean) {
    const Moments found = moments_of({AdvanceKind::constant, 4.5, 1, 2}, 0.5, 3);
    EXPECT_EQ(found.low, 4.5);
    EXPECT_EQ(found.high, 4.5);
}

// Wilcox 1994: a 60 % grade stops the vehicle, as does sinkage of 5 cm; the uniform distribution is
// clipped at zero advance.
TEST(DrawAdvance, SlopeAndSinkageLowerTheMeanLinearlyDownToZero) {
    const AdvanceModel model{AdvanceKind::slope_sinkage, 5, 1, 2};
    EXPECT_NEAR(moments_of(model, 0, 0).mean, 5, 0.015);
    EXPECT_NEAR(moments_of(model, 0.12, 0).mean, 4, 0.015);
    EXPECT_NEAR(moments_of(model, 0, 1.0).mean, 4, 0.015);
    EXPECT_NEAR(moments_of(model, 0.12, 1.0).mean, 3, 0.015);
    EXPECT_NEAR(moments_of(model, -0.5, 0).mean, 5, 0.015);  // downhill does not push
    // Mean 0 before clipping: half of the draws are zero, the others uniform up to 2: mean 0.5.
    const Moments stopped = moments_of(model, 0.6, 0);
    EXPECT_EQ(stopped.low, 0);
    EXPECT_NEAR(stopped.mean, 0.5, 0.01);
    EXPECT_EQ(moments_of(model, 5.0, 5.0).high, 0);
}

TEST(DrawAdvance, EveryKindTakesOneNumberFromTheStream) {
    std::uint64_t next[4];
    for (int kind = 0; kind < 4; ++kind) {
        Random random = stream(1, "advance");
        for (int i = 0; i < 1000; ++i) {
            draw_advance_cm({static_cast<AdvanceKind>(kind), 5, 1, 2}, 0, 0, random);
        }
        next[kind] = random.bits();
    }
    EXPECT_EQ(next[0], next[1]);
    EXPECT_EQ(next[0], next[2]);
    EXPECT_EQ(next[0], next[3]);
}

}  // namespace
}  // namespace host_sim
