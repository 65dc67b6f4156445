#include "host_sim/bind/slip_estimators.hpp"

#include <stdexcept>

namespace host_sim {

std::unique_ptr<SlipEstimator> make_slip_estimator(const SlipEstimatorOptions& options) {
    const bool fixed = options.arithmetic == Arithmetic::fixed;
    switch (options.kind) {
        case EstimatorKind::map_paper:
            return fixed ? make_map_paper_fixed(options) : make_map_paper_double(options);
        case EstimatorKind::map_grid:
            return fixed ? make_map_grid_fixed(options) : make_map_grid_double(options);
    }
    throw std::invalid_argument("unknown estimator");
}

}  // namespace host_sim
