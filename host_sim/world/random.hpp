// random.hpp - the one source of chance in the simulated world.
// Generator    xoshiro256++ (Blackman and Vigna 2019), its state filled by SplitMix64 from a seed
// and
//              the name of a sub-stream, so that adding a consumer never shifts another's numbers.
// Transforms   our own: the distributions of the standard library differ between implementations.
// Bounds       no global state, nothing shared between threads.
#pragma once

#include <cstdint>
#include <string_view>

namespace host_sim {

/// SplitMix64: one step of a 64-bit counter through a mixing function. Bijective in `state`.
constexpr std::uint64_t splitmix64(std::uint64_t& state) {
    state += 0x9E3779B97F4A7C15u;
    std::uint64_t mixed = state;
    mixed = (mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9u;
    mixed = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBu;
    return mixed ^ (mixed >> 31);
}

class Random {
public:
    explicit constexpr Random(std::uint64_t seed) {
        for (std::uint64_t& word : state_) word = splitmix64(seed);
    }

    /// 64 random bits (xoshiro256++).
    constexpr std::uint64_t bits() {
        const std::uint64_t result = rotate(state_[0] + state_[3], 23) + state_[0];
        const std::uint64_t shifted = state_[1] << 17;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= shifted;
        state_[3] = rotate(state_[3], 45);
        return result;
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    constexpr double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

    /// Uniform in [low, high).
    constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /// Standard normal deviate, by the ziggurat method with 256 layers (Marsaglia and Tsang 2000;
    /// layer and value from separate bits, Doornik 2005).
    double normal();

private:
    static constexpr std::uint64_t rotate(std::uint64_t word, unsigned left) {
        return (word << left) | (word >> (64u - left));
    }
    double normal_slow(unsigned layer, double value);

    std::uint64_t state_[4] = {};
};

/// The sub-stream `name` of `seed`: a generator independent of every other name's.
/// The name is hashed with FNV-1a; the same seed and name always give the same sequence.
constexpr Random stream(std::uint64_t seed, std::string_view name) {
    std::uint64_t hash = 0xCBF29CE484222325u;
    for (const char letter : name) {
        hash = (hash ^ static_cast<std::uint8_t>(letter)) * 0x100000001B3u;
    }
    std::uint64_t mixed = seed;
    return Random(splitmix64(mixed) ^ hash);
}

/// Shapes of the 256 ziggurat layers of the normal density exp(-x^2 / 2).
struct NormalLayers {
    double edge[257];     ///< right edge of layer i, falling; edge[256] = 0
    double density[257];  ///< exp(-edge^2 / 2)
    NormalLayers();
    static const NormalLayers& instance();
};

inline double Random::normal() {
    const NormalLayers& layers = NormalLayers::instance();
    const std::uint64_t word = bits();
    const auto layer = static_cast<unsigned>(word & 0xFF);
    const double value = (static_cast<double>(word >> 11) * 0x1p-52 - 1.0) * layers.edge[layer];
    if (value < layers.edge[layer + 1] && -value < layers.edge[layer + 1]) return value;
    return normal_slow(layer, value);
}

}  // namespace host_sim
