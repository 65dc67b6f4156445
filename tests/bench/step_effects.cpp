// step_effects.cpp - prints what each step of optimisation brings: everything compiled without it.
// Usage   step_effects [--update] [STEP...]
//         steps as `i85cc --without` names them, all by default; needs ../shared/kernels beside the
//         repository. --update writes the tables of docs/design/optimisations.md.
// Counts  kernels at -O2; bytes of the image; T-states of the control step over random drives,
// whose
//         every command and state are compared with the host's: code must be right without any
//         step.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/config/eeprom_layout.hpp"
#include "tests/bench/kernel_figures.hpp"
#include "tests/bench/kernel_page.hpp"
#include "tests/target/controller_comparison.hpp"

namespace {

using toolchain::Step;
using toolchain::StepName;
using toolchain::Steps;

const std::string kRoot = ROVER_SOURCE_DIR;
constexpr uint64_t kCycles = 1000;  ///< of slip and sinkage
constexpr uint64_t kSeed = 1;

struct Cost {
    double kernels = 0;  ///< geometric mean of ratios to the best existing compiler's
    uint64_t bytes = 0;
    uint64_t worst_t = 0;
    uint64_t mean_t = 0;
};

double kernel_ratio(bool undocumented, const Steps& steps) {
    double logarithms = 0;
    int count = 0;
    for (const bench::Kernel& kernel : bench::read_kernels(kRoot + "/tests/bench/kernels.csv")) {
        if (kernel.best_t == 0) continue;
        const bench::Figure figure = bench::measure(kernel,
                                                    {.level = toolchain::ir::Optimisation::more,
                                                     .name = "O2",
                                                     .undocumented = undocumented,
                                                     .steps = steps},
                                                    kRoot + "/../shared/kernels");
        logarithms +=
            std::log(static_cast<double>(figure.t_states) / static_cast<double>(kernel.best_t));
        ++count;
    }
    return std::exp(logarithms / count);
}

/// The image behind its loader, as firmware/app/CMakeLists.txt compiles it.
uint64_t image_bytes(bool undocumented, const Steps& steps) {
    toolchain::driver::Request request;
    request.undocumented = undocumented;
    request.steps = steps;
    request.small_runtime = true;
    request.vector_base = rover::loader::kApplicationFirst;
    request.rom = {rover::loader::kApplicationFirst, rover::loader::kApplicationLast};
    request.front_end = {"-I" + kRoot, "-I" + kRoot + "/firmware/config/native"};
    request.sources = {{.path = kRoot + "/firmware/app/main.cpp"}};
    const auto program = toolchain::driver::compile_program(request).program;
    uint64_t bytes = program.data_image.size;
    for (const auto& section : program.sections) {
        if (in_rom(section.section.kind)) bytes += section.size;
    }
    return bytes;
}

void add_step_times(bool undocumented, const Steps& steps, Cost& cost) {
    auto request =
        target_test::firmware_request({toolchain::ir::Optimisation::size, "Os", undocumented});
    request.steps = steps;
    const auto program = toolchain::driver::compile_program(request).program;
    target_test::ImageMailbox target(program, undocumented ? host_sim::InstructionSet::all
                                                           : host_sim::InstructionSet::documented);
    uint64_t sum = 0;
    const auto result = target_test::compare(target, kSeed, kCycles, [&](bool) {
        sum += target.step_t();
        cost.worst_t = std::max(cost.worst_t, target.step_t());
    });
    if (!result.difference.empty()) throw std::runtime_error(result.difference);
    cost.mean_t = sum / std::max<uint64_t>(result.steps, 1);
}

Cost measure(bool undocumented, const Steps& steps) {
    Cost cost;
    cost.kernels = kernel_ratio(undocumented, steps);
    cost.bytes = image_bytes(undocumented, steps);
    add_step_times(undocumented, steps, cost);
    return cost;
}

std::string row(const StepName& name, const Cost& with, const Cost& without) {
    const auto more = [](auto a, auto b) {
        return static_cast<long long>(a) - static_cast<long long>(b);
    };
    return fmt::format("| `{}` | {} | `{}` | {} | {} | {} | {} |\n", name.name, name.what,
                       name.where, std::lround(1000 * (without.kernels - with.kernels)),
                       more(without.bytes, with.bytes), more(without.worst_t, with.worst_t),
                       more(without.mean_t, with.mean_t));
}

/// The steps with and without undocumented instructions.
std::string table(bool undocumented, const std::vector<StepName>& steps) {
    const Cost with = measure(undocumented, {});
    std::string text = fmt::format(
        "\nWith {}: kernels {:.3f}, image {} bytes, control step {} T at most, {} T on average. "
        "Without one step, how much more:\n\n"
        "| step | what it does | source | kernels | bytes | most T | mean T |\n"
        "|---|---|---|--:|--:|--:|--:|\n",
        undocumented ? "the undocumented instructions" : "documented instructions", with.kernels,
        with.bytes, with.worst_t, with.mean_t);
    for (const StepName& name : steps) {
        if (name.undocumented != undocumented) continue;
        Steps rest;
        rest.leave_out(name.step);
        const auto begin = std::chrono::steady_clock::now();
        text += row(name, with, measure(undocumented, rest));
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
        fmt::print(stderr, "without {}: {:.0f} s\n", name.name, passed.count());
    }
    return text;
}

int run(bool update, const std::vector<std::string>& wanted) {
    std::vector<StepName> steps;
    for (const std::string& name : wanted) {
        const auto step = toolchain::step_named(name);
        if (!step) throw std::runtime_error(name + ": no such step: see i85cc --without help");
        steps.push_back(*std::ranges::find(toolchain::step_names(), *step, &StepName::step));
    }
    if (wanted.empty()) {
        const auto all = toolchain::step_names();
        steps.assign(all.begin(), all.end());
    }
    std::string text;
    for (const bool undocumented : {false, true}) {
        const bool any = std::ranges::any_of(
            steps, [&](const StepName& name) { return name.undocumented == undocumented; });
        if (any) text += table(undocumented, steps);
    }
    fmt::print("{}", text);
    if (update) bench::write_page(kRoot + "/docs/design/optimisations.md", "step_effects", text);
    return 0;
}

}  // namespace

int main(int count, char** arguments) {
    std::vector<std::string> steps(arguments + 1, arguments + count);
    const bool update = std::erase(steps, "--update") > 0;
    try {
        if (update && !steps.empty()) {
            throw std::runtime_error("--update writes all steps: name none");
        }
        return run(update, steps);
    } catch (const std::exception& error) {
        fmt::print(stderr, "step_effects: {}\n", error.what());
        return 1;
    }
}
