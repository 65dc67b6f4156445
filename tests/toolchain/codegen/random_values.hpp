// random_values.hpp - chance, and values that a function being made by chance can use.
// Depends on   toolchain/codegen/builder.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "tests/toolchain/codegen/random_functions.hpp"
#include "toolchain/codegen/builder.hpp"

namespace codegen_test {

/// An address in `data`, and the range its offset is in.
struct Pointer {
    toolchain::codegen::Bytes address;
    unsigned most;
};

/// What is defined at a point of a function.
struct Scope {
    std::vector<toolchain::codegen::Bytes> values;
    std::vector<Pointer> pointers;
};

class ValueMaker {
protected:
    ValueMaker(toolchain::codegen::Module& module, std::mt19937_64& random)
        : module_(module), random_(random) {
        function_.blocks.emplace_back();
    }

    // -- Chance ----------------------------------------------------------------------------------
    unsigned chance(unsigned below) { return static_cast<unsigned>(random_() % below); }
    bool one_in(unsigned count) { return chance(count) == 0; }
    std::size_t size() {
        static constexpr std::array<std::size_t, 16> kSizes = {1, 1, 1, 1, 1, 2, 2, 2,
                                                               2, 2, 2, 3, 4, 4, 5, 8};
        return kSizes[chance(kSizes.size())];
    }
    template <typename T>
    const T& any(const std::vector<T>& from) {
        return from[chance(static_cast<unsigned>(from.size()))];
    }

    // -- Values ----------------------------------------------------------------------------------
    toolchain::codegen::Bytes data(unsigned offset) {
        return builder_.address(module_.intern("data"), static_cast<int32_t>(offset));
    }

    uint64_t number() {
        static constexpr std::array<uint64_t, 12> kCorners = {
            0, 1, 2, 3, 0x7F, 0x80, 0xFF, 0x100, 0x7FFF, 0x8000, 0xFFFF, UINT64_MAX};
        if (one_in(3)) return random_();
        const uint64_t corner = kCorners[chance(kCorners.size())];
        return one_in(4) ? 0 - corner : corner;
    }

    toolchain::codegen::ByteId byte() {
        if (scope_.values.empty() || one_in(12)) return builder_.constant_byte(uint8_t(number()));
        return any(any(scope_.values));
    }

    /// A value of that size: an earlier one, a number, or bytes of several.
    toolchain::codegen::Bytes value(std::size_t bytes) {
        if (one_in(7)) return builder_.constant(number(), bytes);
        if (!one_in(5)) {
            for (unsigned i = 0; i < 6 && !scope_.values.empty(); ++i) {
                // The latest are the likeliest.
                const auto count = static_cast<unsigned>(scope_.values.size());
                const unsigned back = std::min(chance(count), chance(count));
                const toolchain::codegen::Bytes& found = scope_.values[count - 1 - back];
                if (found.size() == bytes) return found;
                if (found.size() > bytes && one_in(2)) {
                    const auto from = static_cast<std::ptrdiff_t>(
                        chance(static_cast<unsigned>(found.size() - bytes + 1)));
                    return {found.begin() + from,
                            found.begin() + from + static_cast<std::ptrdiff_t>(bytes)};
                }
                if (found.size() < bytes && one_in(3)) {
                    return one_in(2) ? builder_.zero_extended(found, bytes)
                                     : builder_.sign_extended(found, bytes);
                }
            }
        }
        toolchain::codegen::Bytes result;
        for (std::size_t i = 0; i < bytes; ++i) result.push_back(byte());
        return result;
    }

    void keep(toolchain::codegen::Bytes value) {
        if (!value.empty()) scope_.values.push_back(std::move(value));
    }

    // -- Addresses -------------------------------------------------------------------------------
    static constexpr unsigned kLargest = 8;  ///< bytes that a load or store reaches behind it

    void new_pointer() {
        static constexpr unsigned kMask = 0x3F;
        const unsigned from = chance(64);
        const toolchain::codegen::Bytes index = builder_.bitwise(
            toolchain::codegen::Opcode::bit_and, {byte()}, builder_.constant(kMask, 1));
        const toolchain::codegen::Bytes word = builder_.zero_extended(index, 2);
        const toolchain::codegen::Bytes address =
            one_in(2) ? builder_.add(word, data(from)) : builder_.add(data(from), word);
        scope_.pointers.push_back({address, from + kMask});
    }

    Pointer pointer() {
        if (scope_.pointers.empty() || one_in(6)) {
            if (one_in(2)) return {data(chance(100)), 100};
            new_pointer();
        }
        Pointer result = any(scope_.pointers);
        const unsigned step = chance(5);
        if (step != 0 && result.most + step + kLargest < kDataBytes && one_in(2)) {
            result.address = builder_.add(result.address, builder_.constant(step, 2));
            result.most += step;
            scope_.pointers.push_back(result);
        }
        return result;
    }

    toolchain::codegen::Module& module_;
    std::mt19937_64& random_;
    toolchain::codegen::Function function_;
    toolchain::codegen::Builder builder_{function_};
    Scope scope_;
};

}  // namespace codegen_test
