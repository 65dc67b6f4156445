// isqrt.hpp - integer square roots.
// Depends on   arith.hpp; rover_words.hpp chooses plain or counting integers.
// Bounds       8 or 16 passes of one subtraction and shifts; no multiplication, no table.
// Tests        tests/firmware/core/isqrt_test.cpp      Design note  docs/design/fixed-point.md
#pragma once

#include "firmware/core/arith.hpp"
#include "rover_words.hpp"

namespace rover {

/// Digit by digit, two bits of the argument for each bit of the root.
template <class W>
constexpr W isqrt_digits(W value, W digit, uint8_t passes) {
    W root{0};
    for (uint8_t pass = 0; pass < passes; ++pass) {
        const W trial = add_wrap(root, digit);
        root = halve_floor(root);
        if (value >= trial) {
            value = sub_wrap(value, trial);
            root = add_wrap(root, digit);
        }
        digit = shift_floor<2>(digit);
    }
    return root;
}

/// Square root rounded down.
/// @param value  u16, any
/// @return       u8, [0, 255]; the root of 0 is 0
/// @accuracy     exact floor (Isqrt.OfU16IsTheExactFloor)
constexpr U8 isqrt(SameAs<U16> auto value) {
    return narrow_wrap_u8(isqrt_digits(value, U16{0x4000}, 8));
}

/// Square root rounded down.
/// @param value  u32, any
/// @return       u16, [0, 65535]
/// @accuracy     exact floor (Isqrt.OfU32IsTheExactFloor...)
[[gnu::noinline]] constexpr U16 isqrt(SameAs<U32> auto value) {
    return narrow_wrap_u16(isqrt_digits(value, U32{0x4000'0000}, 16));
}

}  // namespace rover
