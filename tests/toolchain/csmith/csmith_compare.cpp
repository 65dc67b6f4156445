// csmith_compare.cpp - random C programs: our compiler against avr-gcc on simavr.
// Usage        csmith_compare --seeds FIRST-LAST [--levels 0,1,2,s] [--cpu 8085|8085u] [--jobs N]
//                             [--keep DIR]
//              csmith_compare --program FILE.c [--levels ...] [--define NAME=VALUE]
// Exit         0 nothing wrong, 1 a fault, 2 usage
// Guide        docs/guides/random-testing.md
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>

#include "tests/toolchain/csmith/campaign.hpp"

namespace {

using namespace csmith_test;

constexpr uint64_t kSometimes = 50;  // programs between two lines of a log

void show(const Summary& summary, uint64_t seed, const Finding& finding, uint64_t all) {
    const bool terminal = isatty(STDERR_FILENO) != 0;
    if (finding.verdict != Verdict::agreed) {
        if (terminal) fmt::print(stderr, "\r\033[K");
        fmt::print("seed {} {}: {}\n", seed, name_of(finding.verdict), finding.text);
        std::fflush(stdout);
    }
    if (!terminal && summary.done() % kSometimes == 0) {
        fmt::print("{} of {}: {}\n", summary.done(), all, counts_text(summary));
        std::fflush(stdout);
    }
    if (terminal) fmt::print(stderr, "\r{} of {}: {} ", summary.done(), all, counts_text(summary));
}

int run_seeds(const Campaign& campaign, const CompareOptions& options) {
    const uint64_t all = campaign.last - campaign.first + 1;
    const Summary summary = run_campaign(
        campaign, [&](uint64_t seed) { return compare_seed(seed, options); },
        [&](const Summary& so_far, uint64_t seed, const Finding& finding) {
            show(so_far, seed, finding, all);
        });
    if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\r\033[K");
    fmt::print("seeds {} to {}: {}\n", campaign.first, campaign.last, counts_text(summary));
    for (std::size_t i = 1; i < kVerdicts; ++i) {
        const auto verdict = static_cast<Verdict>(i);
        if (summary.count(verdict) == 0) continue;
        fmt::print("{}:", name_of(verdict));
        for (const auto& [seed, finding] : summary.findings) {
            if (finding.verdict == verdict) fmt::print(" {}", seed);
        }
        fmt::print("\n");
    }
    return summary.has_fault() ? 1 : 0;
}

int run_one(const Program& program, const CompareOptions& options) {
    const Finding finding = compare(program, options);
    fmt::print("{}: {} {}\n", program.source.string(), name_of(finding.verdict), finding.text);
    return is_fault(finding.verdict) ? 1 : 0;
}

bool parse_seeds(const std::string& text, Campaign& campaign) {
    unsigned long long first = 0;
    unsigned long long last = 0;
    const int read = std::sscanf(text.c_str(), "%llu-%llu", &first, &last);
    if (read < 1) return false;
    campaign.first = first;
    campaign.last = read == 2 ? last : first;
    return campaign.first <= campaign.last;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app{"Random C programs: our compiler against avr-gcc on simavr"};
    std::string seeds;
    Program program;
    Campaign campaign;
    CompareOptions options;
    std::string keep;
    app.add_option("--seeds", seeds, "FIRST-LAST, or one number");
    app.add_option("--program", program.source, "a C source instead of seeds")
        ->check(CLI::ExistingFile);
    app.add_option("--levels", options.levels, "of 0,1,2,s; all by default")->delimiter(',');
    std::string cpu = "8085";
    app.add_option("--cpu", cpu, "8085, or 8085u: with undocumented instructions")
        ->check(CLI::IsMember({"8085", "8085u"}));
    std::vector<std::string> left_out;
    app.add_option("--without", left_out, "a step of optimisation, as i85cc names it");
    app.add_option("--jobs", campaign.jobs, "processes at a time")->check(CLI::Range(1, 256));
    bool kernels = false;
    app.add_flag("--kernels", kernels, "loops over arrays instead of csmith's programs");
    bool mir = false;
    app.add_flag("--mir", mir, "execute the representation instead of images: faster");
    app.add_option("--search-budget", options.subject.search_budget,
                   "for register homes, for each function; 0: the compiler's own, slow");
    app.add_option("--keep", keep, "folder for the programs of faults");
    std::vector<std::string> defines;
    app.add_option("--define,-D", defines, "NAME or NAME=VALUE, for all compilers");
    CLI11_PARSE(app, argc, argv);
    options.keep = keep;
    options.subject.undocumented = cpu == "8085u";
    for (const std::string& name : left_out) {
        const auto step = toolchain::step_named(name);
        if (!step) {
            fmt::print(
                stderr,
                "csmith_compare: --without {}: no such step: `i85cc --without list` names them\n",
                name);
            return 2;
        }
        options.subject.steps.leave_out(*step);
    }
    if (kernels) options.kind = Generator::kernels;
    if (mir) options.layer = Layer::mir;
    for (const std::string& define : defines) program.options.push_back("-D" + define);
    try {
        if (!program.source.empty()) return run_one(program, options);
        if (!parse_seeds(seeds, campaign)) {
            fmt::print(stderr, "csmith_compare: --seeds FIRST-LAST or --program FILE.c\n");
            return 2;
        }
        return run_seeds(campaign, options);
    } catch (const std::exception& error) {
        fmt::print(stderr, "csmith_compare: {}\n", error.what());
        return 2;
    }
}
