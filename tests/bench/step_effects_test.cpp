// Code is right without any one of the steps that make it better, and the page names them all.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "tests/bench/kernel_figures.hpp"
#include "tests/bench/kernel_page.hpp"
#include "tests/target/compile.hpp"

namespace toolchain {
void PrintTo(const StepName& name, std::ostream* out) {  // name from GoogleTest
    *out << name.name;
}
}  // namespace toolchain

namespace {

const std::string kRoot = ROVER_SOURCE_DIR;

class WithoutStep : public testing::TestWithParam<toolchain::StepName> {};

// measure() compares checksums. Four kernels have a little of everything; with sanitizers two.
TEST_P(WithoutStep, KernelsGiveTheirChecksums) {
    const std::string folder = kRoot + "/../shared/kernels";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "shared/kernels is not there";
    toolchain::Steps steps;
    steps.leave_out(GetParam().step);
    for (const bench::Kernel& kernel : bench::read_kernels(kRoot + "/tests/bench/kernels.csv")) {
        const bool slow = kernel.name == "fuzzy" || kernel.name == "isqrt";
        const bool chosen =
            kernel.name == "wss" || kernel.name == "div32" || (slow && !target_test::kSlowBuild);
        if (!chosen) continue;
        EXPECT_NO_THROW((void)bench::measure(kernel,
                                             {.level = toolchain::ir::Optimisation::more,
                                              .name = "O2",
                                              .undocumented = GetParam().undocumented,
                                              .steps = steps},
                                             folder))
            << kernel.name;
    }
}

TEST_P(WithoutStep, ThePageHasItsFigures) {
    const std::string page =
        bench::read_page(kRoot + "/docs/design/optimisations.md", "step_effects");
    EXPECT_NE(page.find("| `" + std::string(GetParam().name) + "` |"), page.npos);
    EXPECT_TRUE(std::filesystem::exists(kRoot + "/toolchain/" + std::string(GetParam().where)));
}

// Figures of other code than this would differ in one of the two.
TEST(StepEffects, ThePageIsOfTheCodeOfTheOtherFigures) {
    const std::string page =
        bench::read_page(kRoot + "/docs/design/optimisations.md", "step_effects");
    const bench::Figures figures = bench::read_figures(kRoot + "/tests/bench/kernel_figures.csv");
    double logarithms = 0;
    int count = 0;
    for (const bench::Kernel& kernel : bench::read_kernels(kRoot + "/tests/bench/kernels.csv")) {
        const auto figure = bench::find(figures, kernel.name, "O2");
        if (!figure || kernel.best_t == 0) continue;
        logarithms +=
            std::log(static_cast<double>(figure->t_states) / static_cast<double>(kernel.best_t));
        ++count;
    }
    std::ifstream file(kRoot + "/tests/budgets/budget.json");
    const std::string budget{std::istreambuf_iterator<char>(file), {}};
    std::smatch image;
    ASSERT_TRUE(std::regex_search(budget, image, std::regex("\"image.rom_bytes\": ([0-9]+)")));
    EXPECT_NE(page.find(fmt::format("documented instructions: kernels {:.3f}, image {} bytes",
                                    std::exp(logarithms / count), image.str(1))),
              page.npos);
}

INSTANTIATE_TEST_SUITE_P(Steps, WithoutStep, testing::ValuesIn(toolchain::step_names()),
                         [](const auto& test) {
                             std::string name(test.param.name);
                             for (char& letter : name) {
                                 if (letter == '-') letter = '_';
                             }
                             return name;
                         });

}  // namespace
