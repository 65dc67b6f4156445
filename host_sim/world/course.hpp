// course.hpp - ready-made drives: the paper's random ground and measured ground.
// Depends  host_sim/world/drive.hpp, profile.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "host_sim/world/drive.hpp"
#include "host_sim/world/profile.hpp"

namespace host_sim {

/// "fractal" or "wilcox1994"; anything else gives nothing.
std::optional<TerrainKind> terrain_kind(std::string_view name);

/// The paper's traverse with the true linkage: random ground and sinkage of this roughness under
/// both sides, advance N(5, 1) cm a cycle, default sensors. The ground reaches 1.5 m behind the
/// start and 2 m beyond the end.
/// @errors  InputError when roughness or length is out of range
DriveOptions random_course(const Vehicle& vehicle, TerrainKind kind, double roughness,
                           double length_m, std::uint64_t seed);

/// Puts a level, firm exit ramp before x = 0, as long as said, and starts the drive on it: on it
/// wheels neither slip nor sink (Wilcox 1994: the vehicle leaves the lander on a ramp of known
/// geometry). The course grows by the ramp.
/// @errors  InputError when ramp_cm is not from 0 to 1000
void add_exit_ramp(DriveOptions& options, double ramp_cm);

/// Measured ground with the rut of a real wheel in sand: sinkage = static + law(slip of the
/// previous cycle), potentiometer noise as on Spirit. As long as the look-ahead samples have
/// ground.
/// @param static_cm  sinkage of the wheel that does not slip
/// @errors  InputError when the profile is shorter than the vehicle's view
DriveOptions profile_course(const Vehicle& vehicle, const Profile& profile, const SinkageLaw& law,
                            double static_cm, std::uint64_t seed);

}  // namespace host_sim
