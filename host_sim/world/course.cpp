// course.cpp - drive options for the two kinds of ground.
#include "host_sim/world/course.hpp"

#include <cmath>

namespace host_sim {

std::optional<TerrainKind> terrain_kind(std::string_view name) {
    if (name == "fractal") return TerrainKind::fractal;
    if (name == "wilcox1994") return TerrainKind::wilcox1994;
    return std::nullopt;
}

DriveOptions random_course(const Vehicle& vehicle, TerrainKind kind, double roughness,
                           double length_m, std::uint64_t seed) {
    if (!(roughness >= 0) || roughness > 1) throw InputError("roughness must be from 0 to 1");
    if (!(length_m > 0) || length_m > 10000) {
        throw InputError("length must be above 0 and at most 10000 m");
    }
    const TerrainSpan span{150, 100 * length_m, 200};
    DriveOptions options;
    options.vehicle = vehicle;
    options.left = Track(make_terrain(kind, seed, span).scaled(roughness),
                         make_sinkage(kind, seed, span).scaled(roughness));
    options.length_cm = 100 * length_m;
    options.seed = seed;
    return options;
}

void add_exit_ramp(DriveOptions& options, double ramp_cm) {
    if (!(ramp_cm >= 0) || ramp_cm > 1000)
        throw InputError("a ramp must be from 0 to 1000 cm long");
    if (ramp_cm == 0) return;
    options.left = options.left.with_ramp(ramp_cm);
    if (options.right) options.right = options.right->with_ramp(ramp_cm);
    options.ramp_cm = ramp_cm;
    options.start_cm = -ramp_cm;
    options.length_cm += ramp_cm;
}

DriveOptions profile_course(const Vehicle& vehicle, const Profile& profile, const SinkageLaw& law,
                            double static_cm, std::uint64_t seed) {
    const Terrain ground = profile_terrain(profile);
    DriveOptions options;
    options.vehicle = vehicle;
    options.length_cm = drivable_length_cm(vehicle, ground, 0);
    if (!(options.length_cm > 0)) {
        throw InputError(profile.name + ": is shorter than the vehicle's view; stitch profiles");
    }
    options.left = Track(ground, static_cm, law);
    options.sensors.potentiometer_noise_rad = kSpiritPotentiometerNoiseRad;
    options.seed = seed;
    return options;
}

}  // namespace host_sim
