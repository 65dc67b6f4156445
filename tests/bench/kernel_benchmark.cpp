// kernel_benchmark.cpp - prints what the study's kernels cost, beside the best existing compilers.
// Usage   kernel_benchmark [--update] [FOLDER]
//         FOLDER holds the kernels (../shared/kernels beside the repository); --update writes
//         tests/bench/kernel_figures.csv and the tables of docs/design/compiler-figures.md.
#include <fmt/format.h>

#include <exception>
#include <string>

#include "tests/bench/kernel_figures.hpp"
#include "tests/bench/kernel_page.hpp"

namespace {

constexpr const char* kRoot = ROVER_SOURCE_DIR;

int run(bool update, const std::string& folder) {
    const std::string root = kRoot;
    const auto kernels = bench::read_kernels(root + "/tests/bench/kernels.csv");
    bench::Figures figures{.clang = bench::clang_version(), .rows = {}};
    bool failed = false;
    for (const bench::Kernel& kernel : kernels) {
        for (const bench::LevelName& level : bench::kLevels) {
            try {
                figures.rows.push_back(bench::measure(kernel, level, folder));
            } catch (const std::exception& error) {
                fmt::print(stderr, "{} {}: {}\n", kernel.name, level.name, error.what());
                failed = true;
            }
        }
    }
    fmt::print("{}", bench::table(kernels, figures));
    if (failed) return 1;
    if (update) {
        bench::write_figures(root + "/tests/bench/kernel_figures.csv", figures);
        bench::write_page(root + "/docs/design/compiler-figures.md", "kernel_benchmark",
                          bench::table(kernels, figures));
    }
    return 0;
}

}  // namespace

int main(int count, char** arguments) {
    bool update = false;
    std::string folder = std::string(kRoot) + "/../shared/kernels";
    for (int i = 1; i < count; ++i) {
        const std::string argument = arguments[i];
        if (argument == "--update") {
            update = true;
        } else {
            folder = argument;
        }
    }
    try {
        return run(update, folder);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
}
