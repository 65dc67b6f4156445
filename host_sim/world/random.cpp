// random.cpp - layers and rare branches of the ziggurat.
#include "host_sim/world/random.hpp"

#include <cmath>

namespace host_sim {

namespace {
// Marsaglia and Tsang's constants for 256 layers of equal area: start of the tail and the area.
constexpr double kTailStart = 3.6541528853610088;
constexpr double kLayerArea = 4.92867323399e-3;

const NormalLayers kNormalLayers;
}  // namespace

NormalLayers::NormalLayers() {
    // Layer 0 is the base strip with the tail; its "edge" is the width of a box of the same area.
    edge[0] = kLayerArea / std::exp(-0.5 * kTailStart * kTailStart);
    edge[1] = kTailStart;
    for (int i = 2; i < 256; ++i) {
        const double below = std::exp(-0.5 * edge[i - 1] * edge[i - 1]);
        edge[i] = std::sqrt(-2.0 * std::log(kLayerArea / edge[i - 1] + below));
    }
    edge[256] = 0;
    for (int i = 0; i < 257; ++i) density[i] = std::exp(-0.5 * edge[i] * edge[i]);
}

const NormalLayers& NormalLayers::instance() {
    return kNormalLayers;
}

double Random::normal_slow(unsigned layer, double value) {
    const NormalLayers& layers = NormalLayers::instance();
    for (;;) {
        if (layer == 0) {
            // Tail beyond kTailStart, Marsaglia 1964: ends at once in 88 % of the cases.
            double beyond = 0;
            double test = 0;
            do {
                beyond = -std::log(1.0 - uniform()) / kTailStart;
                test = -std::log(1.0 - uniform());
            } while (2.0 * test < beyond * beyond);
            return value < 0 ? -(kTailStart + beyond) : kTailStart + beyond;
        }
        const double height =
            layers.density[layer] + uniform() * (layers.density[layer + 1] - layers.density[layer]);
        if (height < std::exp(-0.5 * value * value)) return value;
        const std::uint64_t word = bits();
        layer = static_cast<unsigned>(word & 0xFF);
        value = (static_cast<double>(word >> 11) * 0x1p-52 - 1.0) * layers.edge[layer];
        if (std::abs(value) < layers.edge[layer + 1]) return value;
    }
}

}  // namespace host_sim
