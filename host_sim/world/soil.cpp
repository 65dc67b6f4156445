// soil.cpp - least-squares fit of the sinkage law.
#include "host_sim/world/soil.hpp"

#include <algorithm>
#include <cmath>

#include "host_sim/world/text_file.hpp"

namespace host_sim {

namespace {

constexpr double kCarriageMmPerS = 10.0;  // of the test bed, from the data set's description
constexpr double kRollingSlip = 0.01;

struct Trial {
    double slip;
    double height_mm;
};

// For a given exponent the best scale is linear least squares.
double best_scale(const std::vector<SinkageTrial>& trials, double exponent) {
    double product = 0;
    double square = 0;
    for (const SinkageTrial& trial : trials) {
        const double power = trial.slip > 0 ? std::pow(trial.slip, exponent) : 0.0;
        product += power * trial.depth_mm;
        square += power * power;
    }
    return product / square;
}

double rms_residual(const std::vector<SinkageTrial>& trials, const SinkageLaw& law) {
    double squares = 0;
    for (const SinkageTrial& trial : trials) {
        const double miss = trial.depth_mm - law.depth_mm(trial.slip);
        squares += miss * miss;
    }
    return std::sqrt(squares / static_cast<double>(trials.size()));
}

// Golden-section search over the exponent; the residual has one minimum there.
SinkageLaw fit_law(const std::vector<SinkageTrial>& trials) {
    const double golden = (std::sqrt(5.0) - 1.0) / 2.0;
    const auto law_of = [&](double exponent) {
        return SinkageLaw{best_scale(trials, exponent), exponent};
    };
    double low = 0.05;
    double high = 6.0;
    for (int i = 0; i < 80; ++i) {
        const double left = high - golden * (high - low);
        const double right = low + golden * (high - low);
        if (rms_residual(trials, law_of(left)) < rms_residual(trials, law_of(right))) {
            high = right;
        } else {
            low = left;
        }
    }
    return law_of(0.5 * (low + high));
}

}  // namespace

double SinkageLaw::depth_mm(double slip) const {
    if (!(slip > 0)) return 0;
    return scale_mm * std::pow(std::min(slip, 1.0), exponent);
}

SinkageFit fit_sinkage(std::string_view csv_text, const std::string& file_name, WheelKind kind) {
    const std::string wanted = kind == WheelKind::grouser ? "grouser" : "smooth";
    CsvRows rows(csv_text, file_name);
    const std::size_t wheel = rows.column("wheel");
    const std::size_t angle = rows.column("slip_angle_cmd_deg");
    const std::size_t speed = rows.column("vwheel_cmd_mm_s");
    const std::size_t height = rows.column("z_mean_mm");
    const std::size_t slip = rows.column("slip");
    double rolling_sum_mm = 0;
    double rolling_count = 0;
    std::vector<Trial> trials;
    while (rows.next()) {
        if (rows.text(wheel) != "grouser" && rows.text(wheel) != "smooth") {
            throw rows.wrong("wheel must be 'grouser' or 'smooth'");
        }
        if (rows.text(wheel) != wanted || rows.number(angle) != 0.0) continue;
        const double slip_here = rows.number(slip);
        if (slip_here < -1.0 || slip_here > 1.0) throw rows.wrong("slip must be from -1 to 1");
        const double height_mm = rows.number(height);
        if (rows.number(speed) == kCarriageMmPerS && std::abs(slip_here) < kRollingSlip) {
            rolling_sum_mm += height_mm;
            rolling_count += 1;
            trials.push_back({0.0, height_mm});
        } else if (slip_here >= 0) {
            trials.push_back({slip_here, height_mm});
        }
    }
    if (rolling_count == 0 || static_cast<double>(trials.size()) < rolling_count + 3) {
        throw InputError(file_name + ": needs a rolling trial and three others of the " + wanted +
                         " wheel at side angle 0");
    }
    SinkageFit fit;
    for (const Trial& trial : trials) {
        fit.trials.push_back({trial.slip, rolling_sum_mm / rolling_count - trial.height_mm});
    }
    fit.law = fit_law(fit.trials);
    fit.rms_mm = rms_residual(fit.trials, fit.law);
    return fit;
}

SinkageFit fit_sinkage_file(const std::string& path, WheelKind kind) {
    return fit_sinkage(read_text_file(path), path, kind);
}

SinkageLaw built_in_sinkage_law(WheelKind kind) {
    return kind == WheelKind::grouser ? SinkageLaw{30.41, 1.700} : SinkageLaw{13.02, 0.774};
}

}  // namespace host_sim
