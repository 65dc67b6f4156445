// profile.cpp - measured profiles: reading, resampling, joining, roughness.
#include "host_sim/world/profile.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "host_sim/world/paper_statistics.hpp"
#include "host_sim/world/text_file.hpp"

namespace host_sim {

namespace {

constexpr double kLongestM = 10000.0;
constexpr double kGridM = kTerrainSpacingCm / 100.0;

// Heights every spacing_m from the beginning, linear between the points.
std::vector<double> resampled(const Profile& profile, double spacing_m) {
    const auto count = static_cast<std::size_t>(profile.length_m() / spacing_m + 1e-9) + 1;
    std::vector<double> heights_m(count);
    std::size_t right = 1;
    for (std::size_t i = 0; i < count; ++i) {
        const double at_m = profile.distance_m.front() + static_cast<double>(i) * spacing_m;
        while (right + 1 < profile.distance_m.size() && profile.distance_m[right] < at_m) ++right;
        const double from_m = profile.distance_m[right - 1];
        const double share = std::min(1.0, (at_m - from_m) / (profile.distance_m[right] - from_m));
        heights_m[i] = profile.height_m[right - 1] +
                       share * (profile.height_m[right] - profile.height_m[right - 1]);
    }
    return heights_m;
}

struct Line {
    double mean;
    double slope;  // per sample
};

Line fitted_line(const double* heights, std::size_t count) {
    const double middle = 0.5 * static_cast<double>(count - 1);
    const double mean = std::accumulate(heights, heights + count, 0.0) / static_cast<double>(count);
    double product = 0;
    double square = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double place = static_cast<double>(i) - middle;
        product += place * heights[i];
        square += place * place;
    }
    return {mean, product / square};
}

// Weight of the later profile: 0 to 1 with zero slope at both ends.
double smoothstep(double share) {
    return share * share * (3.0 - 2.0 * share);
}

Seam join(std::vector<double>& course, std::vector<double> next, std::size_t blend_steps) {
    const std::size_t overlap = blend_steps + 1;
    const std::size_t begin = course.size() - overlap;
    const Line before = fitted_line(course.data() + begin, overlap);
    const Line after = fitted_line(next.data(), overlap);
    Seam seam;
    seam.begin_m = static_cast<double>(begin) * kGridM;
    seam.end_m = static_cast<double>(course.size() - 1) * kGridM;
    seam.level_shift_m = before.mean - after.mean;
    seam.slope_difference = (after.slope - before.slope) / kGridM;
    double squares = 0;
    for (double& height : next) height += seam.level_shift_m;
    for (std::size_t i = 0; i < overlap; ++i) {
        const double difference = next[i] - course[begin + i];
        squares += difference * difference;
        const double share = static_cast<double>(i) / static_cast<double>(blend_steps);
        course[begin + i] += smoothstep(share) * difference;
    }
    seam.rms_difference_m = std::sqrt(squares / static_cast<double>(overlap));
    course.insert(course.end(), next.begin() + static_cast<std::ptrdiff_t>(overlap), next.end());
    return seam;
}

}  // namespace

Profile parse_profile(std::string_view csv_text, const std::string& file_name) {
    CsvRows rows(csv_text, file_name);
    const std::size_t distance = rows.column("distance_m");
    const std::size_t height = rows.column("height_m");
    Profile profile;
    const std::size_t slash = file_name.find_last_of('/');
    profile.name = slash == std::string::npos ? file_name : file_name.substr(slash + 1);
    while (rows.next()) {
        const double distance_m = rows.number(distance);
        const double height_m = rows.number(height);
        if (!profile.distance_m.empty() && distance_m <= profile.distance_m.back()) {
            throw rows.wrong("distance_m does not increase; sort the rows and remove repeats");
        }
        if (!profile.distance_m.empty() && distance_m - profile.distance_m.front() > kLongestM) {
            throw rows.wrong("the profile is longer than 10 km; cut it");
        }
        if (std::abs(height_m) > kLongestM) throw rows.wrong("height_m is beyond 10 km");
        profile.distance_m.push_back(distance_m);
        profile.height_m.push_back(height_m);
    }
    if (profile.distance_m.size() < 2) throw rows.wrong("a profile needs two rows or more");
    if (profile.length_m() < kGridM) throw rows.wrong("the profile is shorter than 2.5 mm");
    return profile;
}

Profile load_profile(const std::string& path) {
    return parse_profile(read_text_file(path), path);
}

Terrain profile_terrain(const Profile& profile) {
    std::vector<double> heights = resampled(profile, kGridM);
    for (double& height : heights) height *= 100.0;
    return Terrain(0.0, kTerrainSpacingCm, std::move(heights));
}

Course stitch(const std::vector<Profile>& profiles, double min_length_m, double blend_m) {
    if (profiles.empty()) throw InputError("stitch: no profiles");
    if (!(min_length_m > 0) || min_length_m > kLongestM) {
        throw InputError("stitch: the course must be above 0 and at most 10 km long");
    }
    double shortest_m = kLongestM;
    for (const Profile& profile : profiles) shortest_m = std::min(shortest_m, profile.length_m());
    if (!(blend_m >= 0.05) || !(blend_m <= 0.5 * shortest_m)) {
        throw InputError("stitch: the blend must be from 0.05 m to half the shortest profile");
    }
    const auto blend_steps = static_cast<std::size_t>(std::floor(blend_m / kGridM + 1e-9));
    std::vector<double> heights_m = resampled(profiles.front(), kGridM);
    Course course;
    std::string previous = profiles.front().name;
    for (std::size_t used = 1;
         static_cast<double>(heights_m.size() - 1) * kGridM < min_length_m - 1e-9; ++used) {
        const Profile& profile = profiles[used % profiles.size()];
        const bool reversed = used / profiles.size() % 2 == 1;
        std::vector<double> next = resampled(profile, kGridM);
        if (reversed) std::reverse(next.begin(), next.end());
        Seam seam = join(heights_m, std::move(next), blend_steps);
        seam.before = std::exchange(previous, profile.name);
        seam.after = profile.name;
        seam.after_reversed = reversed;
        course.seams.push_back(std::move(seam));
    }
    course.profile.name = "stitched course";
    for (std::size_t i = 0; i < heights_m.size(); ++i) {
        course.profile.distance_m.push_back(static_cast<double>(i) * kGridM);
    }
    course.profile.height_m = std::move(heights_m);
    return course;
}

Roughness roughness_of(const std::vector<Profile>& profiles, double bin_cm) {
    const double row = bin_cm / 0.25 - 1.0;
    if (!(row >= 0) || row > 30 || row != std::floor(row)) {
        throw InputError("roughness: the bin must be 0.25, 0.50, ... 7.75 cm");
    }
    const TerrainStatistics paper = kPaperTerrainStatistics[static_cast<std::size_t>(row)];
    double step_squares = 0;
    double projection_squares = 0;
    std::size_t projections = 0;
    Roughness result;
    result.bin_cm = bin_cm;
    for (const Profile& profile : profiles) {
        const std::vector<double> heights_m = resampled(profile, bin_cm / 100.0);
        if (heights_m.size() < 3) continue;
        const double slope_m = fitted_line(heights_m.data(), heights_m.size()).slope;
        for (std::size_t i = 1; i < heights_m.size(); ++i) {
            const double step_m = heights_m[i] - heights_m[i - 1];
            step_squares += (step_m - slope_m) * (step_m - slope_m);
            if (i < 2) continue;
            const double error_m = step_m - (heights_m[i - 1] - heights_m[i - 2]);
            projection_squares += error_m * error_m;
            ++projections;
        }
        result.steps += heights_m.size() - 1;
    }
    if (projections == 0) throw InputError("roughness: no profile spans three bins");
    result.rms_step_cm = 100.0 * std::sqrt(step_squares / static_cast<double>(result.steps));
    result.rms_projection_cm =
        100.0 * std::sqrt(projection_squares / static_cast<double>(projections));
    result.by_step = result.rms_step_cm / paper.rms_step_cm;
    result.by_projection = result.rms_projection_cm / paper.rms_projection_cm;
    return result;
}

}  // namespace host_sim
