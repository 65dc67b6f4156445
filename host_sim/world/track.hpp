// track.hpp - the ground under one side of the vehicle: undisturbed y, and the load-bearing surface
// y - s that the wheels roll on.
// Source   Wilcox 1994, "Assumptions": the front wheel compresses the soil, the others follow.
// Sinkage  either a field s(x), known beforehand, or a rut that the front wheel makes as it comes:
//          s = static + law(slip of the previous cycle), carried over one contact patch.
// Depends  host_sim/world/terrain.hpp, soil.hpp.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "host_sim/world/soil.hpp"
#include "host_sim/world/terrain.hpp"

namespace host_sim {

/// Distance over which a change of sinkage develops: the contact patch, a third of a wheel radius.
inline constexpr double kContactPatchCm = 2.0;

class Track {
public:
    /// Level ground without sinkage.
    Track() : Track(Terrain(), SinkageField()) {}

    /// Ground with a sinkage field.
    Track(const Terrain& ground, const SinkageField& sinkage);

    /// Ground on which the front wheel makes a rut.
    /// @param static_cm  depth at slip 0, >= 0
    Track(const Terrain& ground, double static_cm, const SinkageLaw& law);

    /// The same track with level, firm ground from -length_cm to 0, and a little behind that.
    [[nodiscard]] Track with_ramp(double length_cm) const;

    [[nodiscard]] const Terrain& ground() const { return ground_; }
    [[nodiscard]] double ground_cm(double x_cm) const { return ground_.height_cm(x_cm); }

    /// The load-bearing surface. Ahead of the rut: as if the front wheel rolled there now.
    [[nodiscard]] double bearing_cm(double x_cm) const {
        return makes_rut_ ? ground_.height_cm(x_cm) - rut_cm(x_cm) : bearing_.height_cm(x_cm);
    }
    [[nodiscard]] double sinkage_cm(double x_cm) const {
        return ground_cm(x_cm) - bearing_cm(x_cm);
    }

    /// Tells the slip of the cycle just ended; the rut ahead tends to the depth that belongs to it.
    void set_slip(double slip);

    /// The front wheel has come to x_cm; the rut is settled up to its next sample and will not
    /// change there again.
    void roll_to(double x_cm);

private:
    [[nodiscard]] double rut_cm(double x_cm) const;

    Terrain ground_;
    Terrain bearing_;  // with a field
    bool makes_rut_ = false;
    double static_cm_ = 0;
    // Wheels do not sink before this place.
    double firm_before_cm_ = -std::numeric_limits<double>::infinity();
    SinkageLaw law_;
    double wanted_cm_ = 0;             // depth that the present slip leads to
    double decay_ = 0;                 // of the distance from it, per sample
    std::vector<double> rut_;          // depth every kTerrainSpacingCm, settled part only
    std::size_t settled_samples_ = 1;  // the last of them lies at the front contact or ahead of it
};

}  // namespace host_sim
