// stack_guard.hpp - bytes below the stack that nobody writes unless it has grown too far.
// Depends on   <stdint.h>.
// Design note  docs/design/boot.md     Tests  tests/firmware/boot/stack_guard_test.cpp
#pragma once

#include <stdint.h>

namespace rover {

inline constexpr uint8_t kStackGuardSize = 4;
inline constexpr uint8_t kStackGuardByte = 0xB7;  ///< no value that a pushed address begins with

/// @param guard  the kStackGuardSize bytes below the stack
template <class Byte>
void set_stack_guard(Byte* guard) {
    for (uint8_t left = kStackGuardSize; left != 0; --left) *guard++ = kStackGuardByte;
}

template <class Byte>
bool stack_guard_holds(const Byte* guard) {
    for (uint8_t left = kStackGuardSize; left != 0; --left) {
        if (*guard++ != kStackGuardByte) return false;
    }
    return true;
}

}  // namespace rover
