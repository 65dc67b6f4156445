// counted_word.hpp - an integer that counts what is done to it.
// Depends on   the plain helpers, which do the arithmetic.
// Threads      each thread has its own tally.
// Tests        tests/tools/opcount/counted_test.cpp
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <type_traits>

#include "firmware/core/units.hpp"

namespace rover {

enum class Operation : uint8_t { add_sub, compare, multiply, divide, shift, logic, table_lookup };
inline constexpr std::size_t kOperationCount = 7;
inline constexpr std::array<const char*, kOperationCount> kOperationNames = {
    "add_sub", "compare", "multiply", "divide", "shift", "logic", "table_lookup"};

/// Operations by category since the last reset.
struct OperationTally {
    std::array<uint64_t, kOperationCount> count{};

    uint64_t operator[](Operation operation) const {
        return count[static_cast<std::size_t>(operation)];
    }
    [[nodiscard]] uint64_t total() const {
        uint64_t sum = 0;
        for (const uint64_t one : count) sum += one;
        return sum;
    }
    bool operator==(const OperationTally&) const = default;
};

/// The tally of this thread: read it, or assign {} to start again.
inline OperationTally& operation_tally() {
    thread_local OperationTally tally;
    return tally;
}

/// Adds to the tally; nothing while the compiler evaluates a constant.
constexpr void note(Operation operation, uint64_t times = 1) {
    if (!std::is_constant_evaluated()) {
        operation_tally().count[static_cast<std::size_t>(operation)] += times;
    }
}

/// A T that counts. Implicit from T, so that constants need no ceremony; back only by native().
template <class T>
struct Counted {
    T value = 0;

    constexpr Counted() = default;
    constexpr Counted(T initial) : value(initial) {}

    friend constexpr bool operator==(Counted a, Counted b) {
        note(Operation::compare);
        return a.value == b.value;
    }
    friend constexpr std::strong_ordering operator<=>(Counted a, Counted b) {
        note(Operation::compare);
        return a.value <=> b.value;
    }
};

using U8 = Counted<uint8_t>;
using S8 = Counted<int8_t>;
using U16 = Counted<uint16_t>;
using S16 = Counted<int16_t>;
using U32 = Counted<uint32_t>;
using S32 = Counted<int32_t>;

template <class T>
inline constexpr bool kIsCounted = false;
template <class T>
inline constexpr bool kIsCounted<Counted<T>> = true;
/// At least one argument counts; plain integers may stand beside it.
template <class... A>
concept AnyCounted = (kIsCounted<A> || ...);

template <class T>
constexpr T bare(Counted<T> word) {
    return word.value;
}
template <Word T>
constexpr T bare(T word) {
    return word;
}
/// Calls the plain helper on the plain values and wraps its result.
template <class Helper, class... A>
constexpr auto forward_bare(Helper helper, A... words) {
    return Counted{helper(bare(words)...)};
}
template <Operation kOperation, class Helper, class... A>
constexpr auto forward_counted(Helper helper, A... words) {
    note(kOperation);
    return forward_bare(helper, words...);
}

}  // namespace rover
