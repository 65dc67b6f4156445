// The kernels give their checksums on the 8085 at every optimisation level and cost exactly what
// kernel_figures.csv says; the page shows these figures. A faster or smaller kernel fails, too:
// `kernel_benchmark --update`, and a look at the difference. Expected checksums: a host build.
#include "tests/bench/kernel_figures.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
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

TEST(KernelPage, ShowsTheFigures) {
    EXPECT_EQ(read_page(kRoot + "/docs/design/compiler-figures.md"),
              table(read_kernels(kRoot + "/tests/bench/kernels.csv"), expected()));
}

}  // namespace
}  // namespace bench
