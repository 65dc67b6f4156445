// planar_ground.hpp - ground and sinkage of the paper's planar model, at the paper's resolution.
// Source       Wilcox 1994: the terrain is "created once and then resampled" at the bin size.
// Model        both curves are linear between samples that lie `spacing_cm` apart from x = 0 on.
// Depends on   host_sim/world/terrain.hpp.
#pragma once

#include <cstdint>
#include <utility>

#include "host_sim/world/terrain.hpp"

namespace host_sim {

class PlanarGround {
public:
    PlanarGround(Terrain ground, SinkageField sinkage)
        : ground_(std::move(ground)), sinkage_(std::move(sinkage)) {}

    /// Undisturbed ground y(x), cm.
    [[nodiscard]] double ground_cm(double x_cm) const { return ground_.height_cm(x_cm); }
    /// Sinkage s(x), cm, >= 0.
    [[nodiscard]] double sinkage_cm(double x_cm) const { return sinkage_.depth_cm(x_cm); }
    /// Load-bearing surface y - s: what the wheels touch.
    [[nodiscard]] double surface_cm(double x_cm) const {
        return ground_cm(x_cm) - sinkage_cm(x_cm);
    }
    [[nodiscard]] const Terrain& ground() const { return ground_; }
    /// Ground and sinkage multiplied by `roughness` >= 0. Shares the samples.
    [[nodiscard]] PlanarGround scaled(double roughness) const {
        return {ground_.scaled(roughness), sinkage_.scaled(roughness)};
    }
    /// Sampled anew every spacing_cm from x = 0 to the end.
    [[nodiscard]] PlanarGround resampled(double spacing_cm) const;

private:
    Terrain ground_;
    SinkageField sinkage_;
};

/// The paper's ground at unit roughness on its finest grid; the course and 2 m beyond it.
PlanarGround make_planar_ground(TerrainKind kind, std::uint64_t seed, double length_cm);

}  // namespace host_sim
