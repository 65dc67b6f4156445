// map_grid_rig.hpp - integer and double estimator side by side on one course.
#pragma once

#include <cmath>

#include "firmware/estimation/map_grid.hpp"
#include "host_sim/bind/slip_estimators.hpp"
#include "host_sim/campaign/planar_course.hpp"
#include "host_sim/reference/map_grid_double.hpp"

namespace map_grid_rig {

struct Rig {
    rover::MapGrid fixed;
    host_sim::MapGridDouble floating;
    int cycles = 0;

    explicit Rig(const host_sim::PlanarGround& ground) {
        rover::S16 surface_q4_mm[rover::slip::kKnownNodes];
        for (int node = 0; node < rover::slip::kKnownNodes; ++node) {
            surface_q4_mm[node] =
                host_sim::height_q4_mm(ground.surface_cm(2.5 * node) - ground.surface_cm(0));
        }
        rover::slip::start_on_known_ground(fixed, surface_q4_mm);
        floating.start_on_known_ground([&](double x_cm) { return ground.surface_cm(x_cm); });
    }

    /// One cycle of both.
    void step(const host_sim::CycleInputs& seen, bool linkage = true) {
        // 153.6 units of odometer a cycle: 153 and 154 in turns that sum up exactly.
        const auto odometer = static_cast<rover::S16>(std::lround((cycles + 1) * 153.6) -
                                                      std::lround(cycles * 153.6));
        ++cycles;
        rover::MapGridInput input;
        input.linkage = linkage;
        input.odometer_q6_bin = odometer;
        input.middle_height_q4_mm = host_sim::height_q4_mm(seen.middle_cm);
        input.front_height_q4_mm = host_sim::height_q4_mm(seen.front_cm);
        input.ahead_count = 2;
        input.ahead_height_q4_mm[0] = host_sim::height_q4_mm(seen.near_cm);
        input.ahead_height_q4_mm[1] = host_sim::height_q4_mm(seen.far_cm);
        input.ahead_distance_q6_bin[0] = 1536;
        input.ahead_distance_q6_bin[1] = 2048;
        rover::map_grid_step(fixed, input);
        host_sim::MapGridInput real{.odometer_cm = 6,
                                    .z1_cm = seen.middle_cm,
                                    .z2_cm = seen.front_cm,
                                    .linkage = linkage,
                                    .ahead_height_cm = {seen.near_cm, seen.far_cm},
                                    .ahead_distance_cm = {60, 80},
                                    .ahead_count = 2};
        floating.step(real);
    }
    /// The same special motion to both.
    void step_motion(rover::CycleMotion motion, double odometer_cm) {
        rover::MapGridInput input;
        input.motion = motion;
        input.odometer_q6_bin = static_cast<rover::S16>(std::lround(odometer_cm * 25.6));
        rover::map_grid_step(fixed, input);
        host_sim::MapGridInput real;
        real.motion = static_cast<host_sim::CycleMotion>(motion);
        real.odometer_cm = odometer_cm;
        floating.step(real);
    }
    [[nodiscard]] double fixed_cm() const { return fixed.travelled_q6_bin * 2.5 / 64; }
};

}  // namespace map_grid_rig
