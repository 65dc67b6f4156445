#include "tools/tablegen/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/core/atan2.hpp"
#include "firmware/core/isqrt.hpp"
#include "firmware/core/sine.hpp"

namespace tablegen {
namespace {

constexpr double kBradPerRadian = 65536.0 / (2.0 * std::numbers::pi);
constexpr int32_t kS16Min = -32768;
constexpr int32_t kS16Max = 32767;

void add(Accuracy& row, double error) {
    ++row.count;
    row.max_error = std::max(row.max_error, std::abs(error));
    row.mean_error += (std::abs(error) - row.mean_error) / static_cast<double>(row.count);
}

Accuracy sine_accuracy(const char* name, bool cosine) {
    Accuracy row{name, "s16 Q14", "all angles", 0, 0.0, 0.0, 1.1};
    for (int32_t angle = kS16Min; angle <= kS16Max; ++angle) {
        const auto brad = static_cast<int16_t>(angle);
        const double radian = angle / kBradPerRadian;
        const double real = 16384.0 * (cosine ? std::cos(radian) : std::sin(radian));
        add(row, (cosine ? rover::cosine_q14(brad) : rover::sine_q14(brad)) - real);
    }
    return row;
}

/// Distance of two angles the short way round.
double angle_error_brad(double a, double b) {
    return std::remainder(a - b, 65536.0);
}

Accuracy atan2_accuracy() {
    Accuracy row{"atan2_brad", "s16 brad", "all y, every 257th x", 0, 0.0, 0.0, 1.0};
    for (int32_t y = kS16Min; y <= kS16Max; ++y) {
        for (int32_t x = kS16Min; x <= kS16Max; x += 257) {
            const auto result = rover::atan2_brad(static_cast<int16_t>(y), static_cast<int16_t>(x));
            add(row, angle_error_brad(result, std::atan2(y, x) * kBradPerRadian));
        }
    }
    return row;
}

Accuracy isqrt16_accuracy() {
    Accuracy row{"isqrt(u16)", "u8", "all", 0, 0.0, 0.0, 0.0};
    for (uint32_t value = 0; value <= 0xFFFF; ++value) {
        add(row, rover::isqrt(static_cast<uint16_t>(value)) - std::floor(std::sqrt(value)));
    }
    return row;
}

Accuracy isqrt32_accuracy() {
    Accuracy row{"isqrt(u32)", "u16", "every 4099th", 0, 0.0, 0.0, 0.0};
    for (uint64_t value = 0; value <= 0xFFFF'FFFF; value += 4099) {
        const double real = std::floor(std::sqrt(static_cast<double>(value)));
        add(row, rover::isqrt(static_cast<uint32_t>(value)) - real);
    }
    return row;
}

}  // namespace

std::vector<Accuracy> measure_accuracy() {
    return {sine_accuracy("sine_q14", false), sine_accuracy("cosine_q14", true), atan2_accuracy(),
            isqrt16_accuracy(), isqrt32_accuracy()};
}

std::string accuracy_table(const std::vector<Accuracy>& rows) {
    std::string text =
        "| function | result | arguments | tried | max error | mean error | bound |\n"
        "|---|---|---|---:|---:|---:|---:|\n";
    for (const Accuracy& row : rows) {
        text +=
            fmt::format("| {} | {} | {} | {} | {:.3f} | {:.3f} | {} |\n", row.function, row.result,
                        row.inputs, row.count, row.max_error, row.mean_error, row.bound);
    }
    return text;
}

}  // namespace tablegen
