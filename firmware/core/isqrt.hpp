// isqrt.hpp - integer square roots.
// Depends on   arith.hpp; rover_words.hpp chooses plain or counting integers.
// Bounds       8 or 16 passes of one subtraction and shifts; no multiplication, no table.
// Tests        tests/firmware/core/isqrt_test.cpp      Design note  docs/design/fixed-point.md
#pragma once

#include "firmware/core/arith.hpp"
#include "rover_words.hpp"

namespace rover {

/// The next digit of a root, and what is left behind it.
/// @param rest  what is left in the upper byte, digits to come behind it, two bits each
constexpr void next_digit(U16& rest, U8& root) {
    const U16 trial = add_wrap(shift_left_wrap<8>(widen_u16(root)), U16{0x40});
    root = shift_left_wrap<1>(root);
    if (rest >= trial) {
        rest = sub_wrap(rest, trial);
        root = add_wrap(root, U8{1});
    }
    rest = shift_left_wrap<2>(rest);
}

/// Square root rounded down.
/// @param value  u16, any
/// @return       u8, [0, 255]; the root of 0 is 0
/// @accuracy     exact floor (Isqrt.OfU16IsTheExactFloor)
constexpr U8 isqrt(SameAs<U16> auto value) {
    // What is left stands in the upper byte of 24 bits, where it fits for six digits, and the
    // digits to come behind it.
    U32 rest = widen_u32(value);
    U8 trial{1};  // four times the root so far, and one
    for (uint8_t pass = 0; pass < 6; ++pass) {
        rest = bit_and(shift_left_wrap<2>(rest), U32{0xFF'FFFF});
        const U8 doubled = shift_left_wrap<1>(trial);
        if (narrow_wrap_u8(shift_floor<16>(rest)) >= trial) {
            rest = sub_wrap(rest, shift_left_wrap<16>(widen_u32(trial)));
            trial = add_wrap(doubled, U8{3});
        } else {
            trial = sub_wrap(doubled, U8{1});
        }
    }
    U8 root = shift_floor<2>(trial);
    U16 last = narrow_wrap_u16(shift_floor<8>(rest));
    next_digit(last, root);
    next_digit(last, root);
    return root;
}

/// Square root rounded down.
/// @param value  u32, any
/// @return       u16, [0, 65535]
/// @accuracy     exact floor (Isqrt.OfU32IsTheExactFloor...)
[[gnu::noinline]] constexpr U16 isqrt(SameAs<U32> auto value) {
    // Two bits of the value for each bit of the root.
    U32 rest = value;
    U32 digit{0x4000'0000};
    U32 root{0};
    for (uint8_t pass = 0; pass < 16; ++pass) {
        const U32 trial = add_wrap(root, digit);
        root = halve_floor(root);
        if (rest >= trial) {
            rest = sub_wrap(rest, trial);
            root = add_wrap(root, digit);
        }
        digit = shift_floor<2>(digit);
    }
    return narrow_wrap_u16(root);
}

}  // namespace rover
