// ring.hpp - a fixed ring of 2^n items with a movable origin; indices are modulo the size.
// Depends on   arith.hpp; rover_words.hpp.
// Bounds       one addition and one mask per access: no division, no branch, no index out of range.
// Tests        tests/firmware/core/ring_test.cpp
#pragma once

#include "firmware/core/arith.hpp"
#include "rover_words.hpp"

namespace rover {

template <bool kWide>
struct RingIndex {
    using Type = U8;
};
template <>
struct RingIndex<true> {
    using Type = U16;
};

/// A plain value: kSize items and the place of item 0.
template <class T, uint16_t kSize>
struct Ring {
    static_assert(kSize >= 2 && kSize <= 0x4000, "a ring has 2 to 16384 items");
    static_assert((kSize & (kSize - 1u)) == 0, "a ring has a power of two of items");
    using Index = typename RingIndex<(kSize > 256)>::Type;
    static constexpr Index kMask{static_cast<decltype(native(Index{}))>(kSize - 1u)};

    T items[kSize] = {};
    Index origin{0};

    /// Item `index` places after the origin, modulo kSize; any index.
    constexpr T& at(Index index) { return items[place(index)]; }
    constexpr const T& at(Index index) const { return items[place(index)]; }

    /// Moves the origin on by `count` items, modulo kSize: at(i) becomes what at(i + count) was.
    constexpr void advance(Index count) { origin = bit_and(add_wrap(origin, count), kMask); }

    /// Overwrites the oldest item, which becomes the newest: at(0) is the oldest, at(kSize - 1) the
    /// newest.
    constexpr void push(T value) {
        at(Index{0}) = value;
        advance(Index{1});
    }

    /// Every item becomes `value`, the origin returns to the start.
    constexpr void fill(T value) {
        for (T& item : items) item = value;
        origin = Index{0};
    }

private:
    constexpr auto place(Index index) const {
        return index_of(bit_and(add_wrap(origin, index), kMask));
    }
};

}  // namespace rover
