// byte_ring.hpp - bytes between an interrupt and the main line: one producer, one consumer.
// Depends on   core/arith.hpp.
// Safe         without disabling interrupts: each index has one writer and is one byte, so it is
//              read and written at once; a byte is stored before the index that shows it.
// Bounds       kSize bytes, of which 256 hold 255.
// Design note  docs/design/executive.md     Tests  tests/firmware/link/byte_ring_test.cpp
#pragma once

#include "firmware/core/arith.hpp"

namespace rover {

/// @tparam kSize  a power of two, [2, 256]
template <uint16_t kSize>
struct ByteRing {
    static_assert(kSize >= 2 && kSize <= 256 && kSize % 2 == 0 && 256 % kSize == 0);
    static constexpr uint8_t kMask = static_cast<uint8_t>(kSize - 1);
    static constexpr uint8_t kCapacity = kSize == 256 ? uint8_t{255} : static_cast<uint8_t>(kSize);

    volatile uint8_t written = 0;   ///< modulo 2^8; the producer's
    volatile uint8_t taken = 0;     ///< modulo 2^8; the consumer's
    volatile uint16_t dropped = 0;  ///< bytes that a full ring refused; the producer's
    volatile uint8_t bytes[kSize] = {};

    /// Bytes in the ring.
    [[nodiscard]] uint8_t count() const { return sub_wrap(uint8_t{written}, uint8_t{taken}); }
    [[nodiscard]] bool empty() const { return written == taken; }
    [[nodiscard]] uint8_t room() const { return sub_wrap(kCapacity, count()); }

    /// @context  the producer alone
    void push(uint8_t byte) {
        const uint8_t place = written;
        if (sub_wrap(place, uint8_t{taken}) == kCapacity) {
            dropped = add_wrap(uint16_t{dropped}, uint16_t{1});
            return;
        }
        bytes[bit_and(place, kMask)] = byte;
        written = add_wrap(place, uint8_t{1});
    }

    /// @pre      not empty
    /// @context  the consumer alone
    uint8_t pop() {
        const uint8_t place = taken;
        const uint8_t byte = bytes[bit_and(place, kMask)];
        taken = add_wrap(place, uint8_t{1});
        return byte;
    }
};

}  // namespace rover
