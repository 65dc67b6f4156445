// map_grid_state.hpp - state and inputs of the flying slip-and-sinkage estimator.
// Depends on   slip_tuning.hpp, estimates.hpp (SlipMode).
// Bounds       MapGrid is a plain value of less than 400 bytes; no pointers.
// Places       u16 in 1/64 bin of 25 mm along the track, modulo 2^16 (25.6 m); only differences
//              count. Heights are s16 mm Q4, modulo 2^16, so hills of any height are fine.
#pragma once

#include "firmware/config/slip_tuning.hpp"
#include "firmware/core/arith.hpp"
#include "firmware/core/ring.hpp"
#include "firmware/executive/estimates.hpp"
#include "firmware/executive/pose.hpp"

namespace rover {

/// What the vehicle did since the last cycle.
enum class CycleMotion : uint8_t { forward, reverse, turn, moved };

inline constexpr uint8_t kLookAheadMax = 2;

/// One cycle's measurements, made by the kinematics from raw counts.
struct MapGridInput {
    CycleMotion motion = CycleMotion::forward;
    bool linkage = false;             ///< the four fields below `odometer` are valid
    S16 odometer_q6_bin{0};           ///< rim travel since the last cycle, forward positive
    S16 middle_height_q4_mm{0};       ///< z(1), above the rear contact
    S16 front_height_q4_mm{0};        ///< z(2)
    U16 middle_distance_q6_bin{640};  ///< horizontal, ahead of the rear contact; [64, 960]
    U16 front_distance_q6_bin{1280};  ///< [middle + 64, 1408]
    uint8_t ahead_count = 0;          ///< [0, kLookAheadMax]
    S16 ahead_height_q4_mm[kLookAheadMax] = {};
    U16 ahead_distance_q6_bin[kLookAheadMax] = {};
};

/// Ground seen ahead, one sample a bin: that of bin n lives at n modulo 32.
struct GroundAhead {
    S16 height_q4_mm[slip::kNodeCount] = {};
    U8 fraction_q8[slip::kNodeCount] = {};  ///< of the bin, lowest bit set; 0: no sample
};

/// They come first in the map, 160 bytes. Where it begins a page of memory, as in the image, the
/// 8085 adds a subscript to the low byte of the address alone.
struct MapRings {
    /// Load-bearing surface L = y - s at whole bins; node n lives at n modulo 32.
    S16 surface_q4_mm[slip::kNodeCount] = {};
    GroundAhead ahead{};
};

struct MapGrid : MapRings, Pose {
    bool has_map = false;
    bool measured = false;        ///< the rear wheel stands on ground that the front wheel measured
    U16 lowest_q6_bin{0};         ///< place of the oldest node that is still in the ring
    U16 measured_from_q6_bin{0};  ///< before this place the map is interpolated
    U16 front_place_q6_bin{0};    ///< last sample of the front wheel
    S16 front_height_q4_mm{0};
    S16 front_height_before_q4_mm{0};

    U16 place_q6_bin{0};    ///< rear contact
    S16 advance_q6_bin{0};  ///< of the last cycle
    U16 rough_q8_mm{slip::kInitialRoughQ8Mm};
    U16 match_cost_q10{slip::kInitialCostQ10};
    uint8_t rough_count = 0;
    bool matched = false;  ///< in this cycle, with the two that follow
    U8 cost_q3{0};         ///< of the match, squared sigmas
    U16 added_variance_q12{0};

    U16 spread_q6_bin{0};    ///< root of the variance, rounded down
    U16 spread_rest_q12{0};  ///< what the root leaves of the variance

    bool front_is_new = false;   ///< the front wheel got to new ground in this cycle
    U8 passed_bin{0};            ///< bins before this one have been passed by the front wheel
    bool has_behind = false;     ///< `behind` is the last sample that the front wheel passed
    U16 behind_place_q8_bin{0};  ///< modulo 256 bins
    S16 behind_height_q4_mm{0};
    uint8_t sinkage_count = 0;
    bool sinkage_valid = false;
    S16 sinkage_smooth_q5_mm{0};
    S16 sinkage_size_q11_mm{0};  ///< mean of |smooth|, at most 16 mm
    S16 sinkage_q4_mm{0};

    SlipMode mode = SlipMode::odometry_only;
    bool slip_alarm = false, sinkage_alarm = false, lost_lock = false;
};

/// b - a for places modulo 2^16: positive when b is ahead.
constexpr S16 ahead_of(U16 a_q6_bin, U16 b_q6_bin) {
    return narrow_wrap_s16(sub_wrap(b_q6_bin, a_q6_bin));
}

}  // namespace rover
