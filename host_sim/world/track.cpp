#include "host_sim/world/track.hpp"

#include <algorithm>
#include <cmath>

namespace host_sim {

Track::Track(const Terrain& ground, const SinkageField& sinkage)
    : ground_(ground), bearing_(load_bearing(ground, sinkage)) {}

Track::Track(const Terrain& ground, double static_cm, const SinkageLaw& law)
    : ground_(ground),
      makes_rut_(true),
      static_cm_(static_cm),
      law_(law),
      wanted_cm_(static_cm),
      settled_x_cm_(ground.begin_cm()),
      settled_depth_cm_(static_cm),
      rut_(ground.sample_count(), static_cm) {
    if (!(static_cm >= 0) || !std::isfinite(static_cm)) {
        throw InputError("sinkage: the static depth must not be negative");
    }
}

double Track::rut_cm(double x_cm) const {
    if (!(x_cm > ground_.begin_cm())) return rut_.front();
    if (x_cm >= settled_x_cm_) {
        const double patches = (x_cm - settled_x_cm_) / kContactPatchCm;
        return wanted_cm_ + (settled_depth_cm_ - wanted_cm_) * std::exp(-patches);
    }
    const double place = (x_cm - ground_.begin_cm()) / ground_.spacing_cm();
    const auto index = std::min(static_cast<std::size_t>(place), settled_samples_ - 1);
    const double from_cm = ground_.sample_x_cm(index);
    const bool last = index + 1 >= settled_samples_;
    const double to_cm = last ? settled_x_cm_ : ground_.sample_x_cm(index + 1);
    const double to_depth_cm = last ? settled_depth_cm_ : rut_[index + 1];
    if (!(to_cm > from_cm)) return rut_[index];
    return rut_[index] + (x_cm - from_cm) / (to_cm - from_cm) * (to_depth_cm - rut_[index]);
}

void Track::set_slip(double slip) {
    wanted_cm_ = static_cm_ + 0.1 * law_.depth_mm(slip);
}

void Track::roll_to(double x_cm) {
    if (!makes_rut_) return;
    x_cm = std::min(x_cm, ground_.end_cm());
    if (!(x_cm > settled_x_cm_)) return;
    while (settled_samples_ < rut_.size() && ground_.sample_x_cm(settled_samples_) <= x_cm) {
        // Samples at or behind the settled end get its depth: the first one, at the beginning.
        const double at_cm = std::max(settled_x_cm_, ground_.sample_x_cm(settled_samples_));
        rut_[settled_samples_] = rut_cm(at_cm);
        ++settled_samples_;
    }
    settled_depth_cm_ = rut_cm(x_cm);
    settled_x_cm_ = x_cm;
}

}  // namespace host_sim
