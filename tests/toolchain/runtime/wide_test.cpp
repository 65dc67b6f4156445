// wide_test.cpp - 64-bit products, quotients and comparisons against host arithmetic.
#include <gtest/gtest.h>

#include "tests/toolchain/runtime/runtime_machine.hpp"

namespace runtime_test {
namespace {

constexpr unsigned kRandom = 60'000;

class Wide : public ::testing::Test {
protected:
    /// Calls with operands in the cells; the result is in a_ and b_.
    Registers call(Calls& routine, uint64_t a, uint64_t b) {
        runtime().write(kA, 8, a);
        runtime().write(kB, 8, b);
        const Registers out = routine({});
        a_ = runtime().read(kA, 8);
        b_ = runtime().read(kB, 8);
        return out;
    }

    const uint16_t kA = runtime().address("__wide.a");
    const uint16_t kB = runtime().address("__wide.b");
    uint64_t a_ = 0;
    uint64_t b_ = 0;
};

template <typename Check>
void with_pairs(unsigned random, Check check) {
    const auto values = corners(64);
    auto& source = random_source();
    for (const uint64_t a : values) {
        for (int i = 0; i < 40; ++i) {
            ASSERT_NO_FATAL_FAILURE(check(a, values[source() % values.size()]));
        }
    }
    for (unsigned i = 0; i < random; ++i) {
        const uint64_t a = lumpy(source, 64);
        ASSERT_NO_FATAL_FAILURE(check(a, lumpy(source, 64)));
    }
}

/// FFH in the bytes up to the dividend's highest that is not 0.
uint64_t quotient_by_0(uint64_t dividend) {
    uint64_t quotient = 0;
    while (quotient < dividend) quotient = quotient << 8 | 0xFF;
    return quotient;
}

TEST_F(Wide, Multiply) {
    Calls mul64("__mul64");
    const auto check = [&](uint64_t a, uint64_t b) {
        (void)call(mul64, a, b);
        ASSERT_EQ(a_, a * b) << a << " * " << b;
        ASSERT_EQ(b_, b);
    };
    with_pairs(kRandom, check);
    ASSERT_NO_FATAL_FAILURE(check(~uint64_t{0}, ~uint64_t{0}));
    mul64.expect_stated();
}

TEST_F(Wide, DivideUnsigned) {
    Calls udiv64("__udiv64");
    const auto check = [&](uint64_t a, uint64_t b) {
        (void)call(udiv64, a, b);
        if (b == 0) {
            ASSERT_EQ(a_, quotient_by_0(a)) << a;
            ASSERT_EQ(b_, a);
            return;
        }
        ASSERT_EQ(a_, a / b) << a << " / " << b;
        ASSERT_EQ(b_, a % b) << a << " / " << b;
    };
    with_pairs(kRandom / 2, check);
    ASSERT_NO_FATAL_FAILURE(check(~uint64_t{0}, 0));
    // Every step takes its longest way: the remainder equals the divisor in all bytes.
    ASSERT_NO_FATAL_FAILURE(check(~uint64_t{0}, 1));
    udiv64.expect_stated();
}

TEST_F(Wide, DivideSigned) {
    Calls sdiv64("__sdiv64");
    const auto check = [&](uint64_t a, uint64_t b) {
        (void)call(sdiv64, a, b);
        if (b == 0) {
            const bool negative = a >> 63 != 0;
            const uint64_t quotient = quotient_by_0(negative ? 0 - a : a);
            ASSERT_EQ(a_, negative ? 0 - quotient : quotient) << a;
            ASSERT_EQ(b_, a);
            return;
        }
        const bool wraps = a == uint64_t{1} << 63 && b == ~uint64_t{0};
        const auto dividend = static_cast<int64_t>(a);
        const auto divisor = static_cast<int64_t>(b);
        ASSERT_EQ(a_, wraps ? a : static_cast<uint64_t>(dividend / divisor)) << a << " / " << b;
        ASSERT_EQ(b_, wraps ? 0 : static_cast<uint64_t>(dividend % divisor)) << a << " / " << b;
    };
    with_pairs(kRandom / 2, check);
    constexpr uint64_t kLargest = ~uint64_t{0} >> 1;
    for (const uint64_t a : {kLargest, 0 - kLargest, uint64_t{1} << 63}) {
        for (const uint64_t b : {uint64_t{1}, ~uint64_t{0}}) {
            ASSERT_NO_FATAL_FAILURE(check(a, b));
        }
    }
    for (const uint64_t a : corners(64)) ASSERT_NO_FATAL_FAILURE(check(a, 0));
    sdiv64.expect_stated();
}

TEST_F(Wide, Compare) {
    Calls ucmp64("__ucmp64");
    Calls scmp64("__scmp64");
    const auto check = [&](uint64_t a, uint64_t b) {
        const auto flags = [](bool less, bool equal) {
            return (less ? 1 : 0) | (equal ? 0x40 : 0);
        };
        constexpr int kLooked = 0x41;  // Z and CY
        ASSERT_EQ(call(ucmp64, a, b).flags & kLooked, flags(a < b, a == b)) << a << ' ' << b;
        const bool less = static_cast<int64_t>(a) < static_cast<int64_t>(b);
        ASSERT_EQ(call(scmp64, a, b).flags & kLooked, flags(less, a == b)) << a << ' ' << b;
        ASSERT_EQ(a_, a);
        ASSERT_EQ(b_, b);
    };
    with_pairs(kRandom, check);
    for (const uint64_t a : corners(64)) {
        for (unsigned bit = 0; bit < 64; ++bit) {
            ASSERT_NO_FATAL_FAILURE(check(a, a ^ uint64_t{1} << bit));
        }
        ASSERT_NO_FATAL_FAILURE(check(a, a));
    }
    ucmp64.expect_stated();
    scmp64.expect_stated();
}

}  // namespace
}  // namespace runtime_test
