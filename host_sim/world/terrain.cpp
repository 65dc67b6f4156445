// terrain.cpp - sums of sines by rotation, statistics.
#include "host_sim/world/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "host_sim/world/random.hpp"

namespace host_sim {

namespace {

struct Sine {
    double amplitude_cm;
    double radian_per_cm;
    double phase;
};

std::array<Sine, kSineCount> draw_sines(TerrainKind kind, Random random) {
    std::array<Sine, kSineCount> sines{};
    double wavelength_cm = 1.0;
    for (std::size_t i = 0; i < sines.size(); ++i) {
        // Both kinds draw amplitude and phase, so their phases agree for one seed.
        const double share = random.uniform();
        const double phase = 2.0 * std::numbers::pi * random.uniform();
        const double per_wavelength =
            kind == TerrainKind::fractal ? share : kWilcox1994AmplitudePerWavelength[i];
        sines[i] = {per_wavelength * wavelength_cm, 2.0 * std::numbers::pi / wavelength_cm, phase};
        wavelength_cm *= 1.3;
    }
    return sines;
}

// Adds a sine to the samples by rotating a unit vector. kLanes independent vectors, kLanes samples
// apart, keep the arithmetic units busy; every block starts anew from sin and cos, so that rounding
// stays below 1e-12 of the amplitude.
void add_sine(const Sine& sine, double begin_cm, double spacing_cm, std::vector<double>& samples) {
    constexpr std::size_t kLanes = 8;
    constexpr std::size_t kBlock = 1024;
    if (sine.amplitude_cm == 0.0) return;
    const double turn = sine.radian_per_cm * spacing_cm * static_cast<double>(kLanes);
    const double turn_cos = std::cos(turn);
    const double turn_sin = std::sin(turn);
    for (std::size_t block = 0; block < samples.size(); block += kBlock) {
        std::array<double, kLanes> along{};
        std::array<double, kLanes> across{};
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const double x_cm = begin_cm + static_cast<double>(block + lane) * spacing_cm;
            const double angle = sine.radian_per_cm * x_cm + sine.phase;
            along[lane] = sine.amplitude_cm * std::cos(angle);
            across[lane] = sine.amplitude_cm * std::sin(angle);
        }
        const std::size_t end = std::min(block + kBlock, samples.size());
        for (std::size_t i = block; i < end; i += kLanes) {
            const std::size_t lanes = std::min(kLanes, end - i);
            for (std::size_t lane = 0; lane < lanes; ++lane) samples[i + lane] += across[lane];
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                const double old_along = along[lane];
                along[lane] = turn_cos * old_along - turn_sin * across[lane];
                across[lane] = turn_sin * old_along + turn_cos * across[lane];
            }
        }
    }
}

}  // namespace

Terrain::Terrain() : Terrain(0.0, 1.0, {0.0, 0.0}) {}

Terrain::Terrain(double begin_cm, double spacing_cm, std::vector<double> heights_cm)
    : begin_cm_(begin_cm), spacing_cm_(spacing_cm), samples_per_cm_(1.0 / spacing_cm) {
    if (!std::isfinite(begin_cm)) throw std::invalid_argument("terrain: begin is not finite");
    if (!(spacing_cm > 0) || !std::isfinite(spacing_cm)) {
        throw std::invalid_argument("terrain: spacing must be above 0");
    }
    if (heights_cm.size() < 2) throw std::invalid_argument("terrain: needs two samples or more");
    if (!std::all_of(heights_cm.begin(), heights_cm.end(),
                     [](double height) { return std::isfinite(height); })) {
        throw std::invalid_argument("terrain: a height is not finite");
    }
    last_place_ = static_cast<double>(heights_cm.size() - 1);
    samples_ = std::make_shared<const std::vector<double>>(std::move(heights_cm));
    first_ = samples_->data();
}

Terrain Terrain::scaled(double factor) const {
    if (!std::isfinite(factor)) throw std::invalid_argument("terrain: factor is not finite");
    Terrain result = *this;
    result.scale_ *= factor;
    return result;
}

SinkageField::SinkageField(const Terrain& depth) {
    std::vector<double> clipped(depth.sample_count());
    for (std::size_t i = 0; i < clipped.size(); ++i) {
        clipped[i] = std::max(0.0, depth.sample_cm(i));
    }
    depth_ = Terrain(depth.begin_cm(), depth.spacing_cm(), std::move(clipped));
}

SinkageField SinkageField::scaled(double factor) const {
    if (!(factor >= 0)) throw std::invalid_argument("sinkage: factor must not be negative");
    SinkageField result;
    result.depth_ = depth_.scaled(factor);
    return result;
}

Terrain make_terrain(TerrainKind kind, std::uint64_t seed, const TerrainSpan& span,
                     const char* name) {
    if (!(span.behind_cm >= 0) || !(span.length_cm > 0) || !(span.ahead_cm >= 0) ||
        !(span.behind_cm + span.length_cm + span.ahead_cm <= 1e7)) {
        throw std::invalid_argument("terrain: length must be above 0 and at most 100 km in all");
    }
    const double behind_samples = std::ceil(span.behind_cm / kTerrainSpacingCm);
    const double ahead_samples = std::ceil((span.length_cm + span.ahead_cm) / kTerrainSpacingCm);
    const double begin_cm = -behind_samples * kTerrainSpacingCm;
    std::vector<double> heights_cm(static_cast<std::size_t>(behind_samples + ahead_samples) + 1);
    for (const Sine& sine : draw_sines(kind, stream(seed, name))) {
        add_sine(sine, begin_cm, kTerrainSpacingCm, heights_cm);
    }
    return Terrain(begin_cm, kTerrainSpacingCm, std::move(heights_cm));
}

Terrain make_terrain(TerrainKind kind, std::uint64_t seed, const TerrainSpan& span) {
    return make_terrain(kind, seed, span, "terrain");
}

SinkageField make_sinkage(TerrainKind kind, std::uint64_t seed, const TerrainSpan& span) {
    return SinkageField(make_terrain(kind, seed, span, "sinkage")).scaled(kSinkageShare);
}

Terrain load_bearing(const Terrain& ground, const SinkageField& sinkage) {
    std::vector<double> heights_cm(ground.sample_count());
    for (std::size_t i = 0; i < heights_cm.size(); ++i) {
        heights_cm[i] = ground.sample_cm(i) - sinkage.depth_cm(ground.sample_x_cm(i));
    }
    return Terrain(ground.begin_cm(), ground.spacing_cm(), std::move(heights_cm));
}

TerrainStatistics terrain_statistics(const Terrain& terrain, double bin_cm, double from_cm,
                                     double to_cm) {
    constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
    if (!(bin_cm > 0) || !(to_cm - from_cm >= 2.0 * bin_cm)) return {kNotANumber, kNotANumber};
    const auto last = static_cast<std::size_t>((to_cm - from_cm) / bin_cm + 1e-9);
    double step_squares = 0;
    double projection_squares = 0;
    double before = 0;
    double here = terrain.height_cm(from_cm);
    for (std::size_t i = 1; i <= last; ++i) {
        const double next = terrain.height_cm(from_cm + static_cast<double>(i) * bin_cm);
        step_squares += (next - here) * (next - here);
        if (i >= 2) {
            const double error = next - (here + (here - before));
            projection_squares += error * error;
        }
        before = here;
        here = next;
    }
    return {std::sqrt(step_squares / static_cast<double>(last)),
            std::sqrt(projection_squares / static_cast<double>(last - 1))};
}

TerrainStatistics terrain_statistics(const Terrain& terrain, double bin_cm) {
    return terrain_statistics(terrain, bin_cm, terrain.begin_cm(), terrain.end_cm());
}

double rms_height_cm(const Terrain& terrain, double from_cm, double to_cm) {
    double count = 0;
    double sum = 0;
    double squares = 0;
    for (std::size_t i = 0; i < terrain.sample_count(); ++i) {
        const double x_cm = terrain.sample_x_cm(i);
        if (x_cm < from_cm || x_cm > to_cm) continue;
        const double height = terrain.sample_cm(i);
        count += 1;
        sum += height;
        squares += height * height;
    }
    if (count == 0) return std::numeric_limits<double>::quiet_NaN();
    const double mean = sum / count;
    return std::sqrt(std::max(0.0, squares / count - mean * mean));
}

}  // namespace host_sim
