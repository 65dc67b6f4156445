// track.cpp - the rut: depth settles sample by sample as the front wheel comes.
#include "host_sim/world/track.hpp"

#include <algorithm>
#include <cmath>

namespace host_sim {

namespace {

std::size_t rut_sample_count(const Terrain& ground) {
    const double samples = (ground.end_cm() - ground.begin_cm()) / kTerrainSpacingCm;
    return static_cast<std::size_t>(std::ceil(samples)) + 1;
}

}  // namespace

Track::Track(const Terrain& ground, const SinkageField& sinkage)
    : ground_(ground), bearing_(load_bearing(ground, sinkage)) {}

Track::Track(const Terrain& ground, double static_cm, const SinkageLaw& law)
    : ground_(ground),
      makes_rut_(true),
      static_cm_(static_cm),
      law_(law),
      wanted_cm_(static_cm),
      decay_(std::exp(-kTerrainSpacingCm / kContactPatchCm)),
      rut_(rut_sample_count(ground), static_cm) {
    if (!(static_cm >= 0) || !std::isfinite(static_cm)) {
        throw InputError("sinkage: the static depth must not be negative");
    }
}

Track Track::with_ramp(double length_cm) const {
    constexpr double kBehindCm = 150;
    const double begin_cm = -length_cm - kBehindCm;
    const auto count =
        static_cast<std::size_t>((ground_.end_cm() - begin_cm) / kTerrainSpacingCm) + 1;
    std::vector<double> heights(count), depths(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double x_cm = begin_cm + static_cast<double>(i) * kTerrainSpacingCm;
        heights[i] = ground_cm(std::max(x_cm, 0.0));
        depths[i] = makes_rut_ || x_cm < 0 ? 0.0 : sinkage_cm(x_cm);
    }
    const Terrain ground(begin_cm, kTerrainSpacingCm, std::move(heights));
    if (!makes_rut_) {
        return Track(ground, SinkageField(Terrain(begin_cm, kTerrainSpacingCm, std::move(depths))));
    }
    Track track(ground, static_cm_, law_);
    track.firm_before_cm_ = 0;
    return track;
}

double Track::rut_cm(double x_cm) const {
    if (x_cm < firm_before_cm_) return 0;
    if (!(x_cm > ground_.begin_cm())) return rut_.front();
    const double place = (x_cm - ground_.begin_cm()) / kTerrainSpacingCm;
    const double last = static_cast<double>(settled_samples_ - 1);
    if (place < last) {
        const auto index = static_cast<std::size_t>(place);
        const double fraction = place - static_cast<double>(index);
        return rut_[index] + fraction * (rut_[index + 1] - rut_[index]);
    }
    // Ahead: what roll_to() would settle there, linear between samples like the settled part.
    const double ahead = std::min(place - last, 1e6);
    const double whole = std::floor(ahead);
    const double near_cm = (rut_[settled_samples_ - 1] - wanted_cm_) * std::pow(decay_, whole);
    return wanted_cm_ + near_cm * (1.0 - (ahead - whole) * (1.0 - decay_));
}

void Track::set_slip(double slip) {
    wanted_cm_ = static_cm_ + 0.1 * law_.depth_mm(slip);
}

void Track::roll_to(double x_cm) {
    if (!makes_rut_) return;
    const double place = (x_cm - ground_.begin_cm()) / kTerrainSpacingCm;
    while (settled_samples_ < rut_.size() && static_cast<double>(settled_samples_ - 1) < place) {
        const double before_cm = rut_[settled_samples_ - 1];
        rut_[settled_samples_] = wanted_cm_ + (before_cm - wanted_cm_) * decay_;
        ++settled_samples_;
    }
}

}  // namespace host_sim
