// advance.cpp - one draw of the advance per odometer cycle.
#include "host_sim/world/advance.hpp"

#include <algorithm>

namespace host_sim {

double draw_advance_cm(const AdvanceModel& model, double slope, double sinkage_cm, Random& random) {
    // A gaussian deviate takes a varying number of words, so every draw gets a generator of its
    // own.
    Random draw(random.bits());
    switch (model.kind) {
        case AdvanceKind::constant:
            return model.mean_cm;
        case AdvanceKind::gaussian:
            return model.mean_cm + model.sigma_cm * draw.normal();
        case AdvanceKind::uniform:
            return model.mean_cm + draw.uniform(-model.half_width_cm, model.half_width_cm);
        case AdvanceKind::slope_sinkage: {
            const double share =
                1.0 - std::max(0.0, slope) / kStoppingSlope - sinkage_cm / kStoppingSinkageCm;
            const double spread = draw.uniform(-model.half_width_cm, model.half_width_cm);
            return std::max(0.0, model.mean_cm * share + spread);
        }
    }
    return model.mean_cm;
}

}  // namespace host_sim
