// map_paper_estimator.cpp - map_paper, integer and double, as a SlipEstimator.
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "firmware/estimation/map_paper.hpp"
#include "host_sim/bind/slip_estimators.hpp"
#include "host_sim/reference/map_paper_double.hpp"

namespace host_sim {

namespace {

class PaperDouble final : public SlipEstimator {
public:
    explicit PaperDouble(const SlipEstimatorOptions& options)
        : bin_cm_(options.bin_cm),
          estimator_({.bin_cm = options.bin_cm,
                      .prior_mean_cm = options.prior_mean_cm,
                      .prior_sigma_cm = options.prior_sigma_cm}) {}

    void reset(const PlanarGround& ground) override {
        std::vector<double> ground_cm;
        std::vector<double> sinkage_cm;
        for (int bin = 0; bin <= estimator_.ground_last(); ++bin) {
            ground_cm.push_back(ground.ground_cm(bin * bin_cm_));
        }
        for (int bin = 0; bin <= estimator_.sinkage_last(); ++bin) {
            sinkage_cm.push_back(ground.sinkage_cm(bin * bin_cm_));
        }
        estimator_.reset(ground_cm, sinkage_cm);
    }
    double step(const CycleInputs& inputs) override {
        return estimator_.step({.middle = inputs.middle_cm,
                                .front = inputs.front_cm,
                                .near_ahead = inputs.near_cm,
                                .far_ahead = inputs.far_cm});
    }
    [[nodiscard]] double sinkage_cm() const override { return estimator_.sinkage_cm(); }

private:
    double bin_cm_;
    MapPaperDouble estimator_;
};

rover::MapPaperPrior prior_of(const SlipEstimatorOptions& options) {
    if (!(options.prior_mean_cm >= 0 && options.prior_mean_cm <= 50)) {
        throw std::invalid_argument("map_paper: prior mean must lie in [0, 50] cm");
    }
    if (!(options.prior_sigma_cm >= 0.01 && options.prior_sigma_cm <= 20)) {
        throw std::invalid_argument("map_paper: prior sigma must lie in [0.01, 20] cm");
    }
    return {.mean_q4_mm = static_cast<std::uint16_t>(std::lround(options.prior_mean_cm * 160)),
            .sigma_q8_mm = static_cast<std::uint16_t>(std::lround(options.prior_sigma_cm * 2560))};
}

template <std::uint8_t kBinQuarterCm>
class PaperFixed final : public SlipEstimator {
    using Estimator = rover::MapPaper<kBinQuarterCm>;
    using Layout = typename Estimator::Layout;

public:
    explicit PaperFixed(const SlipEstimatorOptions& options) : prior_(prior_of(options)) {}

    void reset(const PlanarGround& ground) override {
        constexpr double kBinCm = 0.25 * kBinQuarterCm;
        const double rear_cm = ground.surface_cm(0);
        std::int16_t ground_q4_mm[Layout::kFarAhead + 1u];
        std::int16_t sinkage_q4_mm[Layout::kFront + 1u];
        for (std::uint16_t bin = 0; bin <= Layout::kFarAhead; ++bin) {
            ground_q4_mm[bin] = height_q4_mm(ground.ground_cm(bin * kBinCm) - rear_cm);
        }
        for (std::uint16_t bin = 0; bin <= Layout::kFront; ++bin) {
            sinkage_q4_mm[bin] = height_q4_mm(ground.sinkage_cm(bin * kBinCm));
        }
        estimator_.reset(ground_q4_mm, sinkage_q4_mm, prior_);
    }
    double step(const CycleInputs& inputs) override {
        const rover::MapPaperHeights heights{.middle_q4_mm = height_q4_mm(inputs.middle_cm),
                                             .front_q4_mm = height_q4_mm(inputs.front_cm),
                                             .near_ahead_q4_mm = height_q4_mm(inputs.near_cm),
                                             .far_ahead_q4_mm = height_q4_mm(inputs.far_cm)};
        return estimator_.step(heights) / 160.0;
    }
    [[nodiscard]] double sinkage_cm() const override { return estimator_.sinkage_q4_mm() / 160.0; }

private:
    rover::MapPaperPrior prior_;
    Estimator estimator_{};
};

using Maker = std::unique_ptr<SlipEstimator> (*)(const SlipEstimatorOptions&);

template <std::uint8_t kBinQuarterCm>
std::unique_ptr<SlipEstimator> make_fixed(const SlipEstimatorOptions& options) {
    return std::make_unique<PaperFixed<kBinQuarterCm>>(options);
}

template <std::size_t... kIndex>
constexpr std::array<Maker, sizeof...(kIndex)> fixed_makers(std::index_sequence<kIndex...>) {
    return {make_fixed<static_cast<std::uint8_t>(kIndex + 1)>...};
}

}  // namespace

std::unique_ptr<SlipEstimator> make_map_paper_double(const SlipEstimatorOptions& options) {
    return std::make_unique<PaperDouble>(options);
}

std::unique_ptr<SlipEstimator> make_map_paper_fixed(const SlipEstimatorOptions& options) {
    static constexpr auto kMakers = fixed_makers(std::make_index_sequence<32>());
    const double quarters = options.bin_cm * 4;
    if (!(quarters >= 1 && quarters <= 32) || quarters != std::floor(quarters)) {
        throw std::invalid_argument(
            "map_paper in fixed arithmetic has bins of 0.25, 0.5, ... 8 cm");
    }
    return kMakers[static_cast<std::size_t>(quarters) - 1](options);
}

}  // namespace host_sim
