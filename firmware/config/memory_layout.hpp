// memory_layout.hpp - which RAM the image may use; its build is checked against it.
// Depends on   hal/board/rb85.hpp.
// Normative    docs/spec/memory-map.md
#pragma once

#include "hal/board/rb85.hpp"

namespace rover {

inline constexpr uint16_t kRamInUseLast = 0x87FF;  ///< frames and variables end before
inline constexpr uint16_t kStackFirst = 0xFE00;    ///< 256 bytes up to the checkpoint area
inline constexpr uint16_t kStackLast = hal::rb85::kCheckpointFirst - 1;
inline constexpr uint16_t kStackGuardFirst = kStackFirst - 4;
static_assert(kStackLast == kStackFirst + 255);

}  // namespace rover
