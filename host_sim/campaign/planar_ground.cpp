#include "host_sim/campaign/planar_ground.hpp"

#include <utility>
#include <vector>

namespace host_sim {

namespace {

Terrain resample(const Terrain& terrain, double spacing_cm) {
    const auto last = static_cast<std::size_t>(terrain.end_cm() / spacing_cm + 1e-9);
    std::vector<double> heights_cm(last + 1);
    for (std::size_t i = 0; i <= last; ++i) {
        heights_cm[i] = terrain.height_cm(static_cast<double>(i) * spacing_cm);
    }
    return {0.0, spacing_cm, std::move(heights_cm)};
}

}  // namespace

PlanarGround PlanarGround::resampled(double spacing_cm) const {
    return {resample(ground_, spacing_cm), SinkageField(resample(sinkage_.curve(), spacing_cm))};
}

PlanarGround make_planar_ground(TerrainKind kind, std::uint64_t seed, double length_cm) {
    const TerrainSpan span{.behind_cm = 0, .length_cm = length_cm, .ahead_cm = 200};
    return {make_terrain(kind, seed, span), make_sinkage(kind, seed, span)};
}

}  // namespace host_sim
