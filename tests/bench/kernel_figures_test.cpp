// The kernels give their checksums on the 8085 at every optimisation level and cost exactly what
// kernel_figures.csv says; the page shows these figures. A faster or smaller kernel fails, too:
// `kernel_benchmark --update`, and a look at the difference. Expected checksums: a host build.
#include "tests/bench/kernel_figures.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "tests/bench/kernel_page.hpp"

namespace bench {
/// Names the kernel in the list of tests.
void PrintTo(const Kernel& kernel, std::ostream* out) {
    *out << kernel.name;
}

namespace {

const std::string kRoot = ROVER_SOURCE_DIR;

Figures expected() {
    return read_figures(kRoot + "/tests/bench/kernel_figures.csv");
}

class KernelFigures : public testing::TestWithParam<Kernel> {};

TEST_P(KernelFigures, AreExact) {
    const std::string folder = kRoot + "/../shared/kernels";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "shared/kernels is not there";
    const Figures wanted = expected();
    const bool same_front_end = clang_version() == wanted.clang;
    for (const LevelName& level : kLevels) {
        const Figure seen = measure(GetParam(), level, folder);
        const std::string text = fmt::format("{} {}: {} T, {} / {} bytes", seen.kernel, seen.level,
                                             seen.t_states, seen.own_bytes, seen.total_bytes);
        const bool known = std::ranges::find(wanted.rows, seen) != wanted.rows.end();
        if (same_front_end) {
            EXPECT_TRUE(known) << text << " is not what kernel_figures.csv says";
        } else if (!known) {
            fmt::print("warning: the figures are of clang {}: {}\n", wanted.clang, text);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, KernelFigures,
                         testing::ValuesIn(read_kernels(kRoot + "/tests/bench/kernels.csv")),
                         [](const auto& test) { return test.param.name; });

// Issue 6: half of what the best existing compiler needs on average, none above three quarters.
TEST(KernelPage, TheFiguresAreWithinTheirLimits) {
    const auto kernels = read_kernels(kRoot + "/tests/bench/kernels.csv");
    const Figures figures = expected();
    double logarithms = 0;
    int count = 0;
    for (const Kernel& kernel : kernels) {
        const auto fast = find(figures, kernel.name, "O2");
        const auto small = find(figures, kernel.name, "Os");
        ASSERT_TRUE(fast && small) << kernel.name;
        EXPECT_LE(small->own_bytes, 1.3 * fast->own_bytes) << kernel.name;
        EXPECT_LE(static_cast<double>(small->t_states), 1.3 * static_cast<double>(fast->t_states))
            << kernel.name;
        if (kernel.best_t == 0) continue;
        const double ratio =
            static_cast<double>(fast->t_states) / static_cast<double>(kernel.best_t);
        EXPECT_LE(ratio, 0.75) << kernel.name;
        EXPECT_LT(fast->t_states, kernel.z80_t) << kernel.name;
        logarithms += std::log(ratio);
        ++count;
    }
    EXPECT_LE(std::exp(logarithms / count), 0.50);
}

TEST(KernelPage, UndocumentedInstructionsPay) {
    const auto kernels = read_kernels(kRoot + "/tests/bench/kernels.csv");
    EXPECT_LE(mean_ratio(kernels, expected(), "O2u", "O2"), 0.95);
    for (const Kernel& kernel : kernels) {
        const auto plain = find(expected(), kernel.name, "O2");
        const auto with = find(expected(), kernel.name, "O2u");
        ASSERT_TRUE(plain && with) << kernel.name;
        EXPECT_LE(with->t_states, plain->t_states) << kernel.name;
    }
}

// The bilinear look-ups multiply bytes four times each.
TEST(TableMultiply, PaysWhereAKernelAsksForIt) {
    const std::string folder = kRoot + "/../shared/kernels";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "shared/kernels is not there";
    for (const Kernel& kernel : read_kernels(kRoot + "/tests/bench/kernels.csv")) {
        if (kernel.name != "fuzzy") continue;
        const auto level = toolchain::ir::Optimisation::more;
        const uint64_t usual = measure(kernel, {level, "O2"}, folder).t_states;
        const uint64_t by_table = measure(kernel, {level, "O2", false, true}, folder).t_states;
        EXPECT_LE(static_cast<double>(by_table), 0.92 * static_cast<double>(usual));
        fmt::print("fuzzy: {} T by table, {} T without\n", by_table, usual);
    }
}

TEST(KernelPage, ShowsTheFigures) {
    EXPECT_EQ(read_page(kRoot + "/docs/design/compiler-figures.md", "kernel_benchmark"),
              table(read_kernels(kRoot + "/tests/bench/kernels.csv"), expected()));
}

}  // namespace
}  // namespace bench
