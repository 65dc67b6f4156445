// synthetic_swing.hpp - readings of a potentiometer that is swung by hand, with known truth.
// Modelled   12-bit converter, 16 conversions summed; noise per conversion and per reading; arms
//            that move at a hand's pace, hit a stop, compress it, bounce back and settle; rests
//            half-way; stops that repeat with a scatter.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "hal/io.hpp"
#include "host_sim/calibration/swing.hpp"

namespace host_sim::test {

struct SwingTruth {
    double zero_q4_count = 32760;
    double gain_q16 = 16384;
    double stop_deg = 30;
    bool inverted = false;
    double conversion_noise_codes = 0.5;
    double reading_noise_q4_count = 3;
    double stop_scatter_q4_count = 0;  ///< sigma of a stop from visit to visit
    double bounce_deg = 2;
    int visits = 5;
    double dwell_s = 1.6;
    bool rest_halfway = true;
    std::uint64_t seed = 1;
};

class SyntheticSwing {
public:
    explicit SyntheticSwing(const SwingTruth& truth) : truth_(truth), random_(truth.seed) {}

    /// The whole recording: `visits` to each stop.
    std::vector<Reading> record() {
        hold(3, 1.0);
        for (int visit = 0; visit < truth_.visits; ++visit) {
            visit_stop(-1);
            if (truth_.rest_halfway && visit % 2 == 0) {
                move_to(7 + visit, 1.5);
                hold(7 + visit, 1.2);
            }
            visit_stop(+1);
        }
        move_to(-2, 1.5);
        hold(-2, 1.0);
        return readings_;
    }

    void move_to(double angle_deg, double duration_s) {
        const double from_deg = angle_deg_;
        for (double t = 0.1; t < duration_s; t += 0.1) {
            const double share = (1 - std::cos(std::numbers::pi * t / duration_s)) / 2;
            add(from_deg + (angle_deg - from_deg) * share);
        }
        angle_deg_ = angle_deg;
    }

    void hold(double angle_deg, double duration_s) {
        angle_deg_ = angle_deg;
        for (double t = 0; t < duration_s; t += 0.1) add(angle_deg);
    }

    /// Moves to a stop, compresses it, bounces, settles, dwells.
    void visit_stop(int side) {
        const double scatter_deg =
            normal_(random_) * truth_.stop_scatter_q4_count * truth_.gain_q16 / 65536 * 360 / 65536;
        const double stop_deg = side * truth_.stop_deg + scatter_deg;
        move_to(stop_deg, 1.2 + 0.3 * std::abs(normal_(random_)));
        for (double t = 0; t < 0.6; t += 0.1) {
            add(stop_deg + side * truth_.bounce_deg * std::exp(-t / 0.1) * std::cos(9 * t));
        }
        hold(stop_deg, truth_.dwell_s + 0.3 * std::abs(normal_(random_)));
    }

    void add(double angle_deg) {
        const double angle_brad = angle_deg * 65536 / 360 * (truth_.inverted ? -1 : 1);
        // The floor of the converter takes half a code; the zero is where the mean sum is.
        const double mean_q4 = truth_.zero_q4_count + 8 + angle_brad * 65536 / truth_.gain_q16 +
                               truth_.reading_noise_q4_count * normal_(random_);
        unsigned sum = 0;
        for (int i = 0; i < 16; ++i) {
            const double code = mean_q4 / 16 + truth_.conversion_noise_codes * normal_(random_);
            sum += static_cast<unsigned>(std::clamp(std::floor(code), 0.0, 4095.0));
        }
        time_ms_ += 100;
        readings_.push_back({time_ms_, static_cast<std::uint16_t>(sum)});
    }

    std::vector<Reading>& readings() { return readings_; }

    /// Standard deviation of a reading at rest.
    static double reading_sigma_q4_count(const SwingTruth& truth) {
        const double conversion =
            4 *
            std::sqrt(truth.conversion_noise_codes * truth.conversion_noise_codes * 16 * 16 +
                      16.0 * 16 / 12) /
            16;
        return std::hypot(conversion, truth.reading_noise_q4_count);
    }

private:
    SwingTruth truth_;
    std::mt19937_64 random_;
    std::normal_distribution<double> normal_;
    std::vector<Reading> readings_;
    std::uint32_t time_ms_ = 0;
    double angle_deg_ = 0;
};

}  // namespace host_sim::test
