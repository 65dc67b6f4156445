#include "tools/rover85/compare_command.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "host_sim/bind/comparison.hpp"
#include "host_sim/bind/host_target.hpp"
#include "host_sim/bind/random_log.hpp"
#include "host_sim/log/log_io.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/progress_bar.hpp"
#include "tools/rover85/target_option.hpp"

namespace {

struct CompareOptions {
    std::string log;
    TargetOptions target;
    std::uint64_t random_logs = 0, seed = 1;
    std::size_t random_steps = 100;
};

/// What has been compared so far.
struct Total {
    std::size_t logs = 0, steps = 0, frames = 0, bytes = 0, steps_held = 0;
};

void print_total(const Total& total) {
    fmt::print(
        "Identical: {} {}, {} steps, {} telemetry frames, {} bytes; drive motors, steering motors, "
        "mast and lasers of every step.\n",
        total.logs, total.logs == 1 ? "log" : "logs", total.steps, total.frames, total.bytes);
    if (total.steps_held != 0) {
        fmt::print("The board's tick was held for {} steps: they took more than 0.1 s.\n",
                   total.steps_held);
    }
}

/// Runs a log on both targets. @return  false, and the first divergence printed, when they differ
bool compare(const host_sim::Log& log, const std::string& name, host_sim::BoardTarget& board,
             Total& total, const host_sim::DriveProgress& progress) {
    host_sim::Log on_host = log, on_board = log;
    host_sim::replay_on_host(on_host);
    host_sim::replay(board, on_board, progress);
    const host_sim::Comparison result = host_sim::compare_outputs(on_host, on_board);
    ++total.logs;
    total.steps += result.steps;
    total.frames += result.frames;
    total.bytes += result.bytes;
    total.steps_held += board.counts().steps_held;
    if (!result.divergence) return true;
    const host_sim::Divergence& found = *result.divergence;
    fmt::print("{}: first difference in step {} at {:.1f} s: {}: host {}, board {}\n", name,
               found.step, found.time_ms / 1000.0, found.signal, found.first, found.second);
    fmt::print("{} steps before it are identical.\n", found.step);
    return false;
}

int compare_log(const CompareOptions& options, host_sim::BoardTarget& board) {
    const host_sim::Log log = host_sim::load_log(options.log);
    if (log.unverified) {
        fmt::print(stderr, "rover85: {}: no checksum line; edits of this file go unnoticed\n",
                   options.log);
    }
    Total total;
    bool same = false;
    {
        ProgressBar bar("Comparing");
        same = compare(log, options.log, board, total, [&bar](double share) { bar.update(share); });
    }
    fmt::print("{}\n{}\n", host_sim::host_image_identity(), board.identity());
    if (same) print_total(total);
    return same ? kExitPass : kExitDifference;
}

int compare_random(const CompareOptions& options, host_sim::BoardTarget& board) {
    Total total;
    ProgressBar bar("Comparing");
    for (std::uint64_t i = 0; i < options.random_logs; ++i) {
        const std::uint64_t seed = options.seed + i;
        const host_sim::Log log = host_sim::random_log(seed, options.random_steps);
        const std::string name = fmt::format("random log of seed {}", seed);
        try {
            if (!compare(log, name, board, total, {})) {
                fmt::print("Again: rover85 compare --random 1 --seed {} --steps {}\n", seed,
                           options.random_steps);
                return kExitDifference;
            }
        } catch (const host_sim::BoardError& error) {
            throw host_sim::BoardError(fmt::format("{}: {}", name, error.what()));
        }
        bar.update(static_cast<double>(i + 1) / static_cast<double>(options.random_logs));
    }
    fmt::print("Seeds {} to {}.\n", options.seed, options.seed + options.random_logs - 1);
    print_total(total);
    return kExitPass;
}

int run(const CompareOptions& options) {
    const auto board = make_board_target(options.target);
    return options.random_logs > 0 ? compare_random(options, *board) : compare_log(options, *board);
}

}  // namespace

void add_compare_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<CompareOptions>();
    CLI::App& command = *app.add_subcommand(
        "compare", "Run a log on both targets and compare every output of every step, bit by bit");
    CLI::Option* log = command.add_option("LOG", options->log, "Recorded log")->type_name("LOG");
    add_image_options(command, options->target);
    CLI::Option* random =
        command
            .add_option("--random", options->random_logs,
                        "Compare so many random logs instead: drives with faults, noise, resets")
            ->check(CLI::Range(1, 1'000'000))
            ->excludes(log);
    command.add_option("--seed", options->seed, "Of the first random log; each has the next one")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str()
        ->needs(random);
    command.add_option("--steps", options->random_steps, "Steps of a random log, at most")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str()
        ->needs(random);
    command.footer(
        "Exit code 0: identical. 1: different, with step, time, signal and both values of the "
        "first\n"
        "difference; or the board stopped answering.\n"
        "Examples:\n"
        "  rover85 compare out/simulate/traverse.rlog\n"
        "  rover85 compare traverse.csv --image build/other/rover85.hex\n"
        "  rover85 compare --random 200 --seed 1");
    command.callback([options, log, random, &exit_code] {
        if (log->count() + random->count() == 0) {
            throw CLI::RequiredError("LOG or --random");
        }
        exit_code = guarded_on_target([&] { return run(*options); });
    });
}
