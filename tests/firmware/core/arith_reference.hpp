// arith_reference.hpp - what the helpers of firmware/core should give, in 64 bit integers and
// double. Inputs   8 bits: every pair; 16 bits: every value with every 257th; 32 bits: corners with
// corners
//          and a fixed-seed random set, whose seed is printed on failure.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "firmware/core/arith.hpp"

namespace reference {

template <class T>
inline constexpr int64_t kMin = std::numeric_limits<T>::min();
template <class T>
inline constexpr int64_t kMax = std::numeric_limits<T>::max();
template <class T>
inline constexpr int kWidth = static_cast<int>(sizeof(T)) * 8;

/// `value` modulo 2^width, as a T.
template <class T>
int64_t wrap(int64_t value) {
    const int64_t modulus = int64_t{1} << kWidth<T>;
    int64_t rest = value % modulus;
    if (rest < 0) rest += modulus;
    return rest > kMax<T> ? rest - modulus : rest;
}

template <class T>
int64_t saturate(int64_t value) {
    return value < kMin<T> ? kMin<T> : value > kMax<T> ? kMax<T> : value;
}
template <class T>
int64_t saturate(double value) {
    return value < static_cast<double>(kMin<T>)   ? kMin<T>
           : value > static_cast<double>(kMax<T>) ? kMax<T>
                                                  : static_cast<int64_t>(value);
}

/// floor(a / b + offset) in double, which is exact enough: quotients of 32 bit integers differ from
/// an integer or a half by 2^-33 of their size or not at all. Division by zero as documented.
template <class T>
int64_t quotient(int64_t a, int64_t b, double offset) {
    if (b == 0) return a == 0 ? 0 : a < 0 ? kMin<T> : kMax<T>;
    return saturate<T>(std::floor(static_cast<double>(a) / static_cast<double>(b) + offset));
}

inline constexpr unsigned kSeed = 20260101;

/// Values near every power of two and near zero, and random ones of every magnitude.
template <class T>
std::vector<T> wide_values() {
    std::vector<T> values;
    for (int bit = 0; bit <= 32; ++bit) {
        for (int64_t offset = -2; offset <= 2; ++offset) {
            values.push_back(static_cast<T>(wrap<T>((int64_t{1} << bit) + offset)));
            values.push_back(static_cast<T>(wrap<T>(-(int64_t{1} << bit) + offset)));
        }
    }
    std::mt19937 random(kSeed);
    for (int i = 0; i < 700; ++i) {
        values.push_back(static_cast<T>(random() >> (random() % 32)));
    }
    return values;
}

/// Every value of 8 and 16 bits; wide_values of 32.
template <class T>
std::vector<T> values(int64_t step = 1) {
    if constexpr (sizeof(T) == 4) {
        return wide_values<T>();
    } else {
        std::vector<T> all;
        for (int64_t value = kMin<T>; value <= kMax<T>; value += step) {
            all.push_back(static_cast<T>(value));
        }
        return all;
    }
}

/// Compares got(a) with want(a) for every value of A; reports the first difference.
template <class A, class Got, class Want>
void compare(Got got, Want want) {
    for (const A a : values<A>()) {
        const int64_t result = got(a);
        const int64_t expected = want(static_cast<int64_t>(a));
        if (result != expected) {
            FAIL() << "argument " << int64_t{a} << ": got " << result << ", expected " << expected
                   << " (seed " << kSeed << ")";
        }
    }
}

/// Compares got(a, b) with want(a, b); B strided so that every low and every high byte occurs.
template <class A, class B, class Got, class Want>
void compare_pairs(Got got, Want want) {
    const std::vector<A> firsts = values<A>();
    const std::vector<B> seconds = values<B>(sizeof(B) == 2 && sizeof(A) > 1 ? 257 : 1);
    for (const A a : firsts) {
        for (const B b : seconds) {
            const int64_t result = got(a, b);
            const int64_t expected = want(static_cast<int64_t>(a), static_cast<int64_t>(b));
            if (result != expected) {
                FAIL() << "arguments " << int64_t{a} << ", " << int64_t{b} << ": got " << result
                       << ", expected " << expected << " (seed " << kSeed << ")";
            }
        }
    }
}

}  // namespace reference
