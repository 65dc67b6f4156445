// byte_ring.hpp - bytes between an interrupt and the main line: one producer, one consumer.
// Depends on   core/arith.hpp.
// Two kinds    ByteRing for anything; PageRing where the consumer's T-states count.
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

/// The ring towards an interrupt that must be quick: 256 bytes at a page, so that the address of a
/// byte is the page and the index, and one compare tells whether more is there.
/// @pre  the object is aligned to 256, and begin() came first
struct PageRing {
    volatile uint8_t bytes[256] = {};
    volatile uint8_t* next = nullptr;  ///< where the consumer takes; its low byte is the index
    volatile uint8_t written = 0;      ///< index; the producer's

    void begin() { next = bytes; }

    /// Bytes that it can take. Room for one stays free, or full would look like empty.
    [[nodiscard]] uint8_t room() const {
        const uint8_t taken = *reinterpret_cast<const volatile uint8_t*>(&next);
        return sub_wrap(sub_wrap(taken, uint8_t{written}), uint8_t{1});
    }
    [[nodiscard]] bool empty() const { return room() == 255; }

    /// @pre      room() is not 0
    /// @context  the producer alone
    void push(uint8_t byte) {
        bytes[written] = byte;
        written = add_wrap(uint8_t{written}, uint8_t{1});
    }

    /// Many bytes; the consumer sees them all at once, behind the last.
    /// @pre      room() is at least `count`
    /// @context  the producer alone
    /// @cost     38 T a byte
    void push_all(const volatile uint8_t* from, uint8_t count) {
        if (count == 0) return;
        constexpr uintptr_t kIndex = 0xFF;
        auto at = reinterpret_cast<uintptr_t>(bytes) | written;
        do {
            *reinterpret_cast<volatile uint8_t*>(at) = *from++;
            at = (at & ~kIndex) | ((at + 1) & kIndex);
        } while (--count != 0);
        written = static_cast<uint8_t>(at);
    }

    /// @param write  gets the oldest byte
    /// @return   whether that was the last
    /// @pre      not empty
    /// @context  the consumer alone
    template <class Write>
    bool pop(Write write) {
        const volatile uint8_t* const place = next;
        write(*place);
        const auto index = static_cast<uint8_t>(reinterpret_cast<uintptr_t>(place) + 1);
        *reinterpret_cast<volatile uint8_t*>(&next) = index;  // little endian, here and there
        return index == written;
    }
};

}  // namespace rover
