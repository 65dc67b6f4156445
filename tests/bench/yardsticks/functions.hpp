// functions.hpp - four functions of the firmware with their operands at fixed places, to be
// compared with the same by hand in functions.s85. The host calls them too, for what they should
// give.
// Depends on   firmware/estimation/map_grid_match.hpp, firmware/core.
#pragma once

#include "firmware/core/atan2.hpp"
#include "firmware/core/isqrt.hpp"
#include "firmware/core/multiply.hpp"
#include "firmware/core/ring.hpp"
#include "firmware/estimation/map_grid_match.hpp"

namespace yardstick {

inline constexpr uint8_t kItems = 32;

/// In the 8085's memory without gaps; functions.s85 has the same.
struct Cells {
    rover::Ring<int16_t, kItems> ring;
    rover::slip::Match match;
    uint8_t first;     ///< candidate: 0, 2 or 4
    int8_t off;        ///< [-31, 32]
    uint8_t whole;     ///< bins that the ring moves by, [0, 30]
    uint8_t fraction;  ///< and 1/256 of one
    uint8_t root;
    uint16_t square;
    int16_t y;
    int16_t x;
    int16_t angle_brad;
};

/// The weighted sum of squares of nine candidates and its first minimum.
constexpr void wss_search(Cells& cells) {
    rover::slip::find_minimum(cells.first, cells.off, cells.match);
}

/// A histogram moved on: each bin lies between two of the old ones (Wilcox 1994, step 3).
constexpr void ring_update(Cells& cells) {
    cells.ring.advance(cells.whole);
    const auto known = static_cast<uint8_t>(kItems - 1 - cells.whole);
    for (uint8_t bin = 0; bin < known; ++bin) {
        const auto next = static_cast<uint8_t>(bin + 1);
        cells.ring.at(bin) =
            rover::lerp_q8(cells.ring.at(bin), cells.ring.at(next), cells.fraction);
    }
}

/// Rounded down.
constexpr void square_root(Cells& cells) {
    cells.root = rover::isqrt(cells.square);
}

/// From the x axis towards the y axis.
constexpr void arctangent(Cells& cells) {
    cells.angle_brad = rover::atan2_brad(cells.y, cells.x);
}

}  // namespace yardstick
