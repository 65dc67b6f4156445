// kernel_table.cpp - figures as tables for people.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tests/bench/kernel_figures.hpp"

namespace bench {

std::optional<Figure> find(const Figures& figures, const std::string& kernel,
                           const std::string& level) {
    for (const Figure& row : figures.rows) {
        if (row.kernel == kernel && row.level == level) return row;
    }
    return std::nullopt;
}

namespace {

/// 1234567 as 1,234,567.
std::string grouped(uint64_t value) {
    std::string text = std::to_string(value);
    for (std::size_t at = text.size(); at > 3;) {
        at -= 3;
        text.insert(at, 1, ',');
    }
    return text;
}

/// Ratios to one column, multiplied up.
class Mean {
public:
    std::string add(uint64_t ours, uint64_t theirs) {
        if (theirs == 0) return "-";
        const double ratio = static_cast<double>(ours) / static_cast<double>(theirs);
        logarithms_ += std::log(ratio);
        worst_ = std::max(worst_, ratio);
        ++count_;
        return fmt::format("{:.2f}", ratio);
    }
    [[nodiscard]] std::string mean() const {
        return count_ == 0 ? "-" : fmt::format("{:.3f}", std::exp(logarithms_ / count_));
    }
    [[nodiscard]] std::string worst() const { return fmt::format("{:.2f}", worst_); }

private:
    double logarithms_ = 0;
    double worst_ = 0;
    int count_ = 0;
};

/// Both sets of instructions, both levels that people use.
std::string table_of_both(const std::vector<Kernel>& kernels, const Figures& figures) {
    std::string text =
        "\nWith undocumented instructions (`--cpu=8085u`), T-states and own bytes; the means leave "
        "out crc32:\n\n| kernel | O2 | O2, 8085u | ratio | bytes | Os | Os, 8085u | ratio | bytes "
        "|\n|---|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const Kernel& kernel : kernels) {
        text += fmt::format("| {} |", kernel.name);
        for (const char* level : {"O2", "Os"}) {
            const auto plain = find(figures, kernel.name, level);
            const auto with = find(figures, kernel.name, std::string(level) + "u");
            if (!plain || !with) {
                text += " - | - | - | - |";
                continue;
            }
            text += fmt::format(
                " {} | {} | {:.3f} | {} to {} |", grouped(plain->t_states), grouped(with->t_states),
                static_cast<double>(with->t_states) / static_cast<double>(plain->t_states),
                plain->own_bytes, with->own_bytes);
        }
        text += "\n";
    }
    return text + fmt::format("| geometric mean | | | {:.3f} | | | | {:.3f} | |\n",
                              mean_ratio(kernels, figures, "O2u", "O2"),
                              mean_ratio(kernels, figures, "Osu", "Os"));
}

}  // namespace

double mean_ratio(const std::vector<Kernel>& kernels, const Figures& figures,
                  const std::string& level, const std::string& to) {
    double logarithms = 0;
    int count = 0;
    for (const Kernel& kernel : kernels) {
        const auto one = find(figures, kernel.name, level);
        const auto other = find(figures, kernel.name, to);
        if (!one || !other || kernel.best_t == 0) continue;
        logarithms +=
            std::log(static_cast<double>(one->t_states) / static_cast<double>(other->t_states));
        ++count;
    }
    return count == 0 ? 0 : std::exp(logarithms / count);
}

std::string table(const std::vector<Kernel>& kernels, const Figures& figures) {
    std::string text =
        "T-states:\n\n| kernel | O0 | O1 | O2 | Os | best existing | ratio O0 | O1 | "
        "O2 | Os | SDCC Z80 | ratio Os |\n"
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    std::array<Mean, kDocumentedLevels> means;
    Mean z80;
    for (const Kernel& kernel : kernels) {
        std::string ours;
        std::string ratios;
        std::string z80_ratio = "-";
        for (std::size_t i = 0; i < kDocumentedLevels; ++i) {
            const auto figure = find(figures, kernel.name, kLevels[i].name);
            const uint64_t t = figure ? figure->t_states : 0;
            ours += fmt::format(" {} |", figure ? grouped(t) : "-");
            ratios += fmt::format(" {} |", figure ? means[i].add(t, kernel.best_t) : "-");
            if (figure && i + 1 == kDocumentedLevels) z80_ratio = z80.add(t, kernel.z80_t);
        }
        text += fmt::format("| {} |{} {} |{} {} | {} |\n", kernel.name, ours,
                            kernel.best_t == 0 ? "-" : grouped(kernel.best_t), ratios,
                            kernel.z80_t == 0 ? "-" : grouped(kernel.z80_t), z80_ratio);
    }
    text +=
        fmt::format("| geometric mean | | | | | | {} | {} | {} | {} | | {} |\n", means[0].mean(),
                    means[1].mean(), means[2].mean(), means[3].mean(), z80.mean());
    text += fmt::format("| worst | | | | | | {} | {} | {} | {} | | {} |\n", means[0].worst(),
                        means[1].worst(), means[2].worst(), means[3].worst(), z80.worst());
    text +=
        "\nBytes of code, own / with runtime routines:\n\n"
        "| kernel | O0 | O1 | O2 | Os |\n|---|--:|--:|--:|--:|\n";
    for (const Kernel& kernel : kernels) {
        text += fmt::format("| {} |", kernel.name);
        for (std::size_t i = 0; i < kDocumentedLevels; ++i) {
            const auto figure = find(figures, kernel.name, kLevels[i].name);
            text +=
                figure ? fmt::format(" {} / {} |", figure->own_bytes, figure->total_bytes) : " - |";
        }
        text += "\n";
    }
    text += table_of_both(kernels, figures);
    return text + fmt::format("\nFront end: clang {}.\n", figures.clang);
}

}  // namespace bench
