// sample_figures.hpp - small figures made up by hand.
#pragma once

#include "tools/budget/tables.hpp"

namespace budget_test {

/// Modules control and arithmetic, one interrupt, four steps of a log "<short>".
inline rover_budget::Figures sample_figures() {
    using rover_budget::ModuleKind;
    rover_budget::Figures figures;
    figures.identity = "rover85 0.1.0 sources 1a2b3c4d";
    figures.logs = {{"<short>", 4}};
    figures.rom_bytes = 1000;
    figures.ram_bytes = 300;
    figures.frame_bytes = 60;
    figures.stack_bytes = 40;
    figures.modules = {{"control", ModuleKind::step},
                       {"arithmetic", ModuleKind::library},
                       {"other", ModuleKind::step}};
    figures.placement.bytes = {{600, 200, 12}, {100, 0, 2}, {0, 0, 0}};
    rover_budget::ProfileFigures& profile = figures.profile;
    profile.steps = 4;
    profile.total_t = 4000;
    profile.main_line = {1600, 4, 500, {"<short>", 2}};
    profile.interrupts = {200, 4, 60, {"<short>", 1}};
    profile.modules = {{1600, 4, 500, {"<short>", 2}}, {}, {}};
    profile.inputs[1] = {4, 200, 60, 70};
    profile.stack_bytes = 30;
    figures.operations = rover_budget::Operations{2, 1056, 554};
    return figures;
}

/// The same, reviewed; one limit broken, one held, one not measured.
inline rover_budget::Review sample_review() {
    rover_budget::Review review;
    review.figures = sample_figures();
    review.numbers = rover_budget::numbers_of(review.figures);
    review.limits = rover_budget::parse_limits(
        "step.t_states_worst,499,worst step\nimage.rom_bytes,1000,ROM\nmodule.map.x,1,absent\n",
        "l");
    review.reviewed = review.numbers;
    return review;
}

}  // namespace budget_test
