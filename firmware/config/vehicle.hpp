// vehicle.hpp - geometry of the vehicle that this firmware drives: Rocky 3.2.
// Depends on   <stdint.h>.
// Source       host_sim/vehicles/rocky32.toml; checked against it in tests/firmware/config.
// Units        lengths in mm Q4 (1/16 mm) and in 1/64 bin of 25 mm (q6_bin).
#pragma once

#include <stdint.h>

namespace rover::vehicle {

inline constexpr uint16_t kRockerQ4Mm = 6000;         ///< 375 mm: rear axle to bogie pivot
inline constexpr uint16_t kRockerQ6Bin = 960;         ///< the same
inline constexpr uint16_t kBogieArmQ4Mm = 2000;       ///< 125 mm: bogie pivot to either axle
inline constexpr uint16_t kBogieArmQ6Bin = 320;       ///< the same
inline constexpr uint16_t kBodyReferenceQ4Mm = 3000;  ///< 187.5 mm: rear axle to body pivot

/// Range samples look at these distances ahead of the body pivot, along the body.
inline constexpr uint8_t kLookAheadCount = 2;
inline constexpr uint16_t kLookAheadQ4Mm[kLookAheadCount] = {6600, 9800};  ///< 412.5, 612.5 mm

}  // namespace rover::vehicle
