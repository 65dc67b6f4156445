// probe.hpp - what a probe group needs: deterministic inputs and a checksum of the results.
// Both are computed in u32 by named helpers, hence the same on every target.
// Adding a group   write a function (Inputs&, Checksum&) and call it with run() from a file that
//                  CMakeLists.txt lists and run_groups() calls.
#pragma once

#include "firmware/core/arith.hpp"

namespace probe {

/// FNV-1a over the bytes of the results, low byte first.
class Checksum {
public:
    template <rover::Word T>
    void add(T value) {
        auto bits = rover::narrow_wrap_u32(value);
        for (uint8_t byte = 0; byte < sizeof(T); ++byte) {
            value_ = rover::mul_wrap(rover::bit_xor(value_, rover::bit_and(bits, uint32_t{0xFF})),
                                     uint32_t{16777619});
            bits = rover::shift_floor<8>(bits);
        }
    }
    [[nodiscard]] uint32_t value() const { return value_; }

private:
    uint32_t value_ = 2166136261;
};

/// Corners of every width, then a xorshift sequence of every magnitude. Never ends.
class Inputs {
public:
    template <rover::Word T>
    T next() {
        return rover::convert_wrap<T>(next_bits());
    }

private:
    uint32_t next_bits() {
        state_ = rover::bit_xor(state_, rover::shift_left_wrap<13>(state_));
        state_ = rover::bit_xor(state_, rover::shift_floor<17>(state_));
        state_ = rover::bit_xor(state_, rover::shift_left_wrap<5>(state_));
        // A quarter of the values are next to a power of two or to its negative, a quarter small.
        const auto kind = rover::narrow_wrap_u8(rover::bit_and(state_, uint32_t{3}));
        const auto count =
            rover::narrow_wrap_u8(rover::bit_and(rover::shift_floor<2>(state_), uint32_t{31}));
        if (kind == 0) {
            const auto power = rover::shift_left_wrap(uint32_t{1}, count);
            const auto offset = rover::bit_and(rover::shift_floor<7>(state_), uint32_t{3});
            const auto corner = rover::sub_wrap(rover::add_wrap(power, offset), uint32_t{2});
            return rover::bit_and(state_, uint32_t{0x8000}) != 0 ? rover::neg_wrap(corner) : corner;
        }
        if (kind == 1) return rover::shift_floor(state_, count);
        return state_;
    }
    uint32_t state_ = 0x1234'5678;
};

/// Prints one line, "probe name checksum"; provided by the target.
void report(const char* name, uint32_t checksum);

/// One group: `rounds` calls with fresh inputs, one line of output.
template <class Check>
void run(const char* name, uint16_t rounds, Check check) {
    Inputs inputs;
    Checksum sum;
    for (uint16_t round = 0; round < rounds; ++round) check(inputs, sum);
    report(name, sum.value());
}

/// The groups of each part; the same on every target.
void run_core_groups();
void run_estimation_groups();
void run_controller_groups();

inline void run_groups() {
    run_core_groups();
    run_estimation_groups();
    run_controller_groups();
}

}  // namespace probe
