// profile.hpp - measured ground: profiles from CSV, a long course stitched from short ones, and how
// rough they are in the paper's terms.
// Depends  host_sim/world/terrain.hpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host_sim/world/input_error.hpp"
#include "host_sim/world/terrain.hpp"

namespace host_sim {

/// Ground heights along a straight line.
struct Profile {
    std::string name;
    std::vector<double> distance_m;  ///< strictly increasing, two or more
    std::vector<double> height_m;
    [[nodiscard]] double length_m() const { return distance_m.back() - distance_m.front(); }
};

/// Reads CSV whose header names `distance_m` and `height_m`; other columns are ignored.
/// @errors  InputError with file and line: missing column, not a finite number, wrong number of
///          fields, distance not increasing, fewer than two rows, longer than 10 km
Profile parse_profile(std::string_view csv_text, const std::string& file_name);
Profile load_profile(const std::string& path);

/// The profile on the terrain grid (0.25 cm), from 0, linear between its points.
Terrain profile_terrain(const Profile& profile);

/// Where two profiles of a course meet and what was done there.
struct Seam {
    double begin_m = 0;  ///< the blend, in the course's distance
    double end_m = 0;
    std::string before;
    std::string after;
    bool after_reversed = false;  ///< the later profile runs backwards
    double level_shift_m = 0;     ///< added to the later profile's heights
    double slope_difference = 0;  ///< later minus earlier, of lines fitted over the blend
    double rms_difference_m = 0;  ///< of the two profiles over the blend, after the shift
};

struct Course {
    Profile profile;
    std::vector<Seam> seams;
};

/// Joins profiles in the given order into a course of at least min_length_m. When they are used up
/// they follow again, reversed, and so on. Neighbours overlap by blend_m: the later one is shifted
/// to the same mean height there and the weight moves over with zero slope at both ends, so height
/// and slope are continuous. Nothing is tilted: each profile keeps its own slopes.
/// @param blend_m  [0.05, half the shortest profile]
/// @errors  InputError: no profiles, a length or blend out of range
Course stitch(const std::vector<Profile>& profiles, double min_length_m, double blend_m);

/// Roughness of ground in the paper's terms at one bin size.
struct Roughness {
    double bin_cm = 0;
    double rms_step_cm = 0;  ///< mean slope of each profile removed
    double rms_projection_cm = 0;
    double by_step = 0;        ///< rms_step_cm / that of the paper's terrain at roughness 1
    double by_projection = 0;  ///< the same of rms_projection_cm
    std::size_t steps = 0;     ///< bin steps that entered
};

/// Pooled over the profiles, each sampled every bin_cm from its beginning.
/// @param bin_cm  a row of the paper's table: 0.25, 0.50, ... 7.75
/// @errors  InputError when the bin is none of these or no profile spans three bins
Roughness roughness_of(const std::vector<Profile>& profiles, double bin_cm);

}  // namespace host_sim
