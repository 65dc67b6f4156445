// pose.hpp - where the rover is and what it has learned: all that outlives a reset.
// Depends on   config/slip_tuning.hpp; rover_words.hpp chooses plain or counting integers.
// Place        the base of MapGrid, so the estimator works on it and a checkpoint is one copy.
// Layout       that of a checkpoint's content, docs/spec/memory-map.md (normative): 24 bytes,
//              without padding, on host and target.
#pragma once

#include "firmware/config/slip_tuning.hpp"
#include "rover_words.hpp"

namespace rover {

/// Another layout or meaning gets another number: a record of an older image is then refused.
inline constexpr uint8_t kPoseFormat = 1;

struct Pose {
    S32 travelled_q6_bin{0};                    ///< rear contact at the last match, never wrapped
    S32 odometer_q4_mm{0};                      ///< wheel odometry; as of the last checkpoint
    U32 variance_q12{0};                        ///< of the position, (1/64 bin)^2
    U32 drift_q12_bin{0};                       ///< systematic part of the position uncertainty
    S16 since_cycle_q4_mm{0};                   ///< odometry that no match has measured, likewise
    S16 turn_q4_mm{0};                          ///< turn since the last cycle, likewise
    S16 mean_q12_bin{slip::kMeanNoSlipQ12Bin};  ///< learned advance of a 6 cm cycle
    uint8_t learned = 0;                        ///< cycles behind it, [0, slip::kLearnSteps]
    uint8_t format = kPoseFormat;
};

}  // namespace rover
