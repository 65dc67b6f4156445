// map_grid_estimator.cpp - map_grid, integer and double, as a SlipEstimator.
#include <cmath>
#include <stdexcept>

#include "firmware/estimation/map_grid.hpp"
#include "host_sim/bind/slip_estimators.hpp"
#include "host_sim/reference/map_grid_double.hpp"

namespace host_sim {

namespace {

constexpr double kBinCm = rover::slip::kBinMm / 10.0;

void check(const SlipEstimatorOptions& options) {
    if (options.bin_cm != kBinCm) {
        throw std::invalid_argument("map_grid has bins of 2.5 cm; leave out the bin");
    }
    if (options.prior_sigma_cm != MapGridTuning{}.prior_sigma_cm) {
        throw std::invalid_argument(
            "map_grid has a fixed prior sigma (slip_tuning.hpp); leave out the prior sigma");
    }
    if (!(options.prior_mean_cm >= 1 && options.prior_mean_cm <= 6)) {
        throw std::invalid_argument("map_grid: prior mean must lie in [1, 6] cm");
    }
}

class GridDouble final : public SlipEstimator {
public:
    explicit GridDouble(const SlipEstimatorOptions& options) : mean_cm_(options.prior_mean_cm) {
        check(options);
    }

    void reset(const PlanarGround& ground) override {
        estimator_ = MapGridDouble();
        estimator_.set_learned_mean_cm(mean_cm_);
        estimator_.start_on_known_ground([&](double x_cm) { return ground.surface_cm(x_cm); });
    }
    double step(const CycleInputs& inputs) override {
        MapGridInput input{.odometer_cm = inputs.odometer_cm,
                           .z1_cm = inputs.middle_cm,
                           .z2_cm = inputs.front_cm,
                           .d1_cm = kMiddleWheelCm,
                           .d2_cm = kFrontWheelCm};
        input.ahead_count = 2;
        input.ahead_height_cm = {inputs.near_cm, inputs.far_cm};
        input.ahead_distance_cm = {kNearSampleCm, kFarSampleCm};
        const std::uint32_t losses_before = estimator_.lost_lock_count();
        estimator_.step(input);
        lost_lock_ = estimator_.lost_lock_count() != losses_before;
        return estimator_.advance_cm();
    }
    [[nodiscard]] double sinkage_cm() const override { return estimator_.sinkage_cm(); }
    [[nodiscard]] std::optional<double> position_sigma_cm() const override {
        return estimator_.sigma_cm();
    }
    [[nodiscard]] std::optional<SlipLevels> slip_levels() const override {
        return SlipLevels{estimator_.match_cost(),
                          100 * (1 - estimator_.prior_mean_cm() / MapGridTuning{}.prior_mean_cm)};
    }

private:
    double mean_cm_;
    MapGridDouble estimator_;
    bool lost_lock_ = false;
};

/// u16 place in 1/64 bin nearest to a distance in cm.
constexpr std::uint16_t q6_bin(double distance_cm) {
    return static_cast<std::uint16_t>(distance_cm * 64 / kBinCm + 0.5);
}

class GridFixed final : public SlipEstimator {
public:
    explicit GridFixed(const SlipEstimatorOptions& options) : mean_cm_(options.prior_mean_cm) {
        check(options);
    }

    void reset(const PlanarGround& ground) override {
        map_ = rover::MapGrid{};
        map_.mean_q12_bin = static_cast<std::int16_t>(std::lround(mean_cm_ * 4096 / kBinCm));
        std::int16_t surface_q4_mm[rover::slip::kKnownNodes];
        const double rear_cm = ground.surface_cm(0);
        for (int node = 0; node < rover::slip::kKnownNodes; ++node) {
            surface_q4_mm[node] = height_q4_mm(ground.surface_cm(node * kBinCm) - rear_cm);
        }
        rover::slip::start_on_known_ground(map_, surface_q4_mm);
        odometer_cm_ = 0;
        odometer_q6_ = 0;
    }
    double step(const CycleInputs& inputs) override {
        rover::MapGridInput input;
        input.linkage = true;
        // 6 cm are 153.6 units: rounding the sum and not the step keeps the odometer exact.
        odometer_cm_ += inputs.odometer_cm;
        const auto odometer_q6 = std::llround(odometer_cm_ * 64 / kBinCm);
        input.odometer_q6_bin = static_cast<std::int16_t>(odometer_q6 - odometer_q6_);
        odometer_q6_ = odometer_q6;
        input.middle_height_q4_mm = height_q4_mm(inputs.middle_cm);
        input.front_height_q4_mm = height_q4_mm(inputs.front_cm);
        input.ahead_count = 2;
        input.ahead_height_q4_mm[0] = height_q4_mm(inputs.near_cm);
        input.ahead_height_q4_mm[1] = height_q4_mm(inputs.far_cm);
        input.ahead_distance_q6_bin[0] = q6_bin(kNearSampleCm);
        input.ahead_distance_q6_bin[1] = q6_bin(kFarSampleCm);
        rover::map_grid_step(map_, input);
        return map_.advance_q6_bin * kBinCm / 64;
    }
    [[nodiscard]] double sinkage_cm() const override { return map_.sinkage_q4_mm / 160.0; }
    [[nodiscard]] std::optional<double> position_sigma_cm() const override {
        return rover::position_sigma_q4_mm(map_) / 160.0;
    }
    [[nodiscard]] std::optional<SlipLevels> slip_levels() const override {
        return SlipLevels{.match_cost = map_.match_cost_q10 / 1024.0,
                          .slip_percent = static_cast<double>(
                              rover::slip::slip_percent(rover::slip::learned_share_q15(map_))),
                          .lost_lock = map_.lost_lock,
                          .slip_alarm = map_.slip_alarm,
                          .sinkage_alarm = map_.sinkage_alarm};
    }

private:
    double mean_cm_;
    rover::MapGrid map_{};
    double odometer_cm_ = 0;
    long long odometer_q6_ = 0;
};

}  // namespace

std::unique_ptr<SlipEstimator> make_map_grid_double(const SlipEstimatorOptions& options) {
    return std::make_unique<GridDouble>(options);
}

std::unique_ptr<SlipEstimator> make_map_grid_fixed(const SlipEstimatorOptions& options) {
    return std::make_unique<GridFixed>(options);
}

}  // namespace host_sim
