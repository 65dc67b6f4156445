// ram_test.hpp - RAM test that leaves the contents as they were.
// Depends on   core/arith.hpp.
// Context      interrupts disabled. The byte under test is in a register meanwhile, so the test may
//              also run over its own stack and frame (RamTest on the simulated board shows it).
// Design note  docs/design/boot.md     Tests  tests/firmware/boot/ram_test_test.cpp
#pragma once

#include "firmware/core/arith.hpp"

namespace rover {

/// Can every bit of these cells be 0 and 1, and differ from its neighbours? A bit that holds what
/// was written reads differently behind the two patterns.
/// @tparam Byte  volatile on the target
/// @param count  [1, 256]: 256 is given as 0
template <class Byte>
[[gnu::noinline]] bool cells_hold(Byte* cell, uint8_t count) {
    uint8_t changed = 0xFF;
    do {
        const uint8_t before = *cell;
        *cell = uint8_t{0x55};
        const uint8_t first = *cell;
        *cell = uint8_t{0xAA};
        const uint8_t second = *cell;
        *cell = before;
        changed = bit_and(changed, bit_xor(first, second));
        ++cell;
    } while (--count != 0);
    return changed == 0xFF;
}

/// Are these two cells two? @pre they are
template <class Byte>
[[gnu::noinline]] bool are_apart(Byte* a, Byte* b) {
    const uint8_t before_a = *a;
    const uint8_t before_b = *b;
    *a = uint8_t{0x55};
    *b = uint8_t{0xAA};
    const uint8_t seen = *a;
    *b = before_b;
    *a = before_a;
    return seen == 0x55;
}

/// Is every address line connected, to nothing but itself? Compares the cells whose offset has no
/// or one bit set, each with each.
/// @param first  the first cell; offsets below 2 * `highest` exist
/// @param highest  the highest line, a power of two
template <class Byte>
bool address_lines_hold(Byte* first, uint16_t highest) {
    for (uint16_t line = highest; line != 0; line = shift_floor<1>(line)) {
        uint16_t other = line;
        do {
            other = shift_floor<1>(other);
            if (!are_apart(first + line, first + other)) return false;
        } while (other != 0);
    }
    return true;
}

}  // namespace rover
