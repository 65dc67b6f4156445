// terrain.hpp - ground as a height curve, and the paper's random terrain and sinkage.
// Source   Wilcox 1994, "The simulation model for y(x) and s(x)" and the bottom of Table 1.
// Model    sum of 20 sines, wavelengths 1.0 * 1.3^i cm. "Roughness" k is amplitude / wavelength.
//          Made once at roughness 1; `scaled(k)` shares the samples, so a sweep over roughness and
//          bin size runs on one and the same ground, as in the paper.
// Depends  host_sim/world/random.hpp.      Design note  docs/design/world.md
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace host_sim {

inline constexpr double kTerrainSpacingCm = 0.25;
inline constexpr double kCourseLengthCm = 6250.0;  ///< the paper's 62.5 m
inline constexpr int kSineCount = 20;
inline constexpr double kSinkageShare = 0.2;  ///< roughness of s(x) as a share of that of y(x)

/// Amplitude / wavelength of the paper's own terrain at roughness 1, recovered from its table of
/// terrain statistics; wavelengths 1.0, 1.3, ... 146 cm.
inline constexpr std::array<double, kSineCount> kWilcox1994AmplitudePerWavelength = {
    0.127, 0.636, 0.777, 0.841, 0.093, 0.593, 0.275, 0.282, 0.0,   0.0,
    0.346, 0.308, 0.294, 0.509, 0.529, 0.426, 0.360, 0.470, 0.662, 0.855};

/// Heights on a uniform grid, linear between samples. A value: copies share the samples.
class Terrain {
public:
    /// Level ground at height 0.
    Terrain();

    /// @param begin_cm    place of the first sample
    /// @param spacing_cm  distance between samples, > 0
    /// @param heights_cm  at least two samples, finite
    /// @errors  std::invalid_argument when one of these does not hold
    Terrain(double begin_cm, double spacing_cm, std::vector<double> heights_cm);

    /// Height at x. Outside [begin_cm(), end_cm()] the height of the nearer end; at NaN of the
    /// first.
    [[nodiscard]] double height_cm(double x_cm) const {
        const double place = (x_cm - begin_cm_) * samples_per_cm_;
        if (!(place > 0)) return scale_ * first_[0];
        if (place >= last_place_) return scale_ * first_[static_cast<std::size_t>(last_place_)];
        const auto index = static_cast<std::size_t>(place);
        const double fraction = place - static_cast<double>(index);
        return scale_ * (first_[index] + fraction * (first_[index + 1] - first_[index]));
    }

    /// The same ground with all heights multiplied by `factor` (finite). Shares the samples.
    [[nodiscard]] Terrain scaled(double factor) const;

    [[nodiscard]] double begin_cm() const { return begin_cm_; }
    [[nodiscard]] double end_cm() const { return begin_cm_ + last_place_ * spacing_cm_; }
    [[nodiscard]] double spacing_cm() const { return spacing_cm_; }
    [[nodiscard]] std::size_t sample_count() const { return samples_->size(); }
    [[nodiscard]] double sample_x_cm(std::size_t index) const {
        return begin_cm_ + static_cast<double>(index) * spacing_cm_;
    }
    [[nodiscard]] double sample_cm(std::size_t index) const { return scale_ * (*samples_)[index]; }

private:
    std::shared_ptr<const std::vector<double>> samples_;
    const double* first_ = nullptr;
    double begin_cm_ = 0;
    double spacing_cm_ = 1;
    double samples_per_cm_ = 1;
    double last_place_ = 1;  // index of the last sample
    double scale_ = 1;
};

/// Depth to which wheels sink at x, never negative.
class SinkageField {
public:
    /// No sinkage anywhere.
    SinkageField() = default;

    /// Negative samples of `depth` are clipped to 0.
    explicit SinkageField(const Terrain& depth);

    [[nodiscard]] double depth_cm(double x_cm) const { return depth_.height_cm(x_cm); }

    /// All depths multiplied by `factor`.
    /// @errors  std::invalid_argument if factor < 0
    [[nodiscard]] SinkageField scaled(double factor) const;

    [[nodiscard]] const Terrain& curve() const { return depth_; }

private:
    Terrain depth_;
};

enum class TerrainKind {
    fractal,    ///< amplitude uniform in [0, wavelength]
    wilcox1994  ///< amplitudes of the paper's own terrain
};

/// The stretch of ground to make: [-behind_cm, length_cm + ahead_cm].
/// Neither margin changes the ground between 0 and length_cm.
struct TerrainSpan {
    double behind_cm = 0;
    double length_cm = kCourseLengthCm;
    double ahead_cm = 200;
};

/// Random ground at roughness 1, from the sub-stream "terrain" of `seed`.
Terrain make_terrain(TerrainKind kind, std::uint64_t seed, const TerrainSpan& span = {});

/// Random sinkage that belongs to ground of roughness 1: an independent sum of the same kind from
/// the sub-stream "sinkage", times kSinkageShare, clipped at 0.
SinkageField make_sinkage(TerrainKind kind, std::uint64_t seed, const TerrainSpan& span = {});

/// An independent ground at roughness 1 from the sub-stream `name` (a second wheel track, say).
Terrain make_terrain(TerrainKind kind, std::uint64_t seed, const TerrainSpan& span,
                     const char* name);

/// The load-bearing surface y - s on y's grid.
Terrain load_bearing(const Terrain& ground, const SinkageField& sinkage);

/// The two columns of the paper's table of terrain statistics, for one bin size.
struct TerrainStatistics {
    double rms_step_cm = 0;        ///< RMS bin-to-bin elevation change
    double rms_projection_cm = 0;  ///< RMS error of continuing the last bin-to-bin line to the next
};

/// Statistics of `terrain` between from_cm and to_cm, sampled every bin_cm (linear between
/// samples). NaN when fewer than three bins fit.
TerrainStatistics terrain_statistics(const Terrain& terrain, double bin_cm, double from_cm,
                                     double to_cm);
TerrainStatistics terrain_statistics(const Terrain& terrain, double bin_cm);

/// RMS height of the samples between from_cm and to_cm about their mean.
double rms_height_cm(const Terrain& terrain, double from_cm, double to_cm);

}  // namespace host_sim
