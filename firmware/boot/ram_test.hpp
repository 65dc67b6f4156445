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
/// @param wrong  called when they cannot
template <class Byte, class Wrong>
[[gnu::noinline]] void test_cells(Byte* cell, uint8_t count, Wrong wrong) {
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
    if (changed != 0xFF) wrong();
}

/// Are these two cells two? @pre they are @param wrong  called when they are one
template <class Byte, class Wrong>
[[gnu::noinline]] void test_two(Byte* a, Byte* b, Wrong wrong) {
    const uint8_t before_a = *a;
    const uint8_t before_b = *b;
    *a = uint8_t{0x55};
    *b = uint8_t{0xAA};
    const uint8_t seen = *a;
    *b = before_b;
    *a = before_a;
    if (seen != 0x55) wrong();
}

/// The address line below; none below the lowest.
[[gnu::noinline]] constexpr uint16_t line_below(uint16_t line) {
    return shift_floor<1>(line);
}

/// Is every address line connected, to nothing but itself? Compares the cells whose offset has no
/// or one bit set, each with each.
/// @param first  the first cell; offsets below 2 * `highest` exist
/// @param highest  the highest line, a power of two
/// @param wrong  called for every two that are one
template <class Byte, class Wrong>
void test_address_lines(Byte* first, uint16_t highest, Wrong wrong) {
    for (uint16_t line = highest; line != 0; line = line_below(line)) {
        uint16_t other = line;
        do {
            other = line_below(other);
            test_two(first + line, first + other, wrong);
        } while (other != 0);
    }
}

}  // namespace rover
