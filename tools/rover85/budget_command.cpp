// budget_command.cpp - see budget_command.hpp.
#include "tools/rover85/budget_command.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "host_sim/image/image.hpp"
#include "tools/budget/budget_error.hpp"
#include "tools/budget/documents.hpp"
#include "tools/budget/measure.hpp"
#include "tools/rover85/budget_bounds.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/image_beside.hpp"
#include "tools/rover85/progress_bar.hpp"
#include "tools/rover85/target_option.hpp"

namespace {

namespace fs = std::filesystem;
using rover_budget::Review;

constexpr const char* kReviewed = "budget.json";

struct BudgetOptions {
    TargetOptions target;
    std::vector<std::string> logs;
    std::string folder, json, html, markdown, against;
    bool update = false;
    bool bounds = false;
    std::uint64_t random_logs = 0, seed = 1;
};

/// tests/budgets of the tree in which this program, or the current folder, is.
fs::path find_folder(const std::string& given) {
    if (!given.empty()) return given;
    for (const fs::path& start : {program_folder(), fs::current_path()}) {
        for (fs::path at = start; at.has_relative_path(); at = at.parent_path()) {
            const fs::path folder = at / "tests" / "budgets";
            if (fs::exists(folder / "modules.csv")) return folder;
        }
    }
    throw rover_budget::BudgetError("tests/budgets", 0, "is not above this program or this folder",
                                    "name it with --budgets");
}

void write(const std::string& file, const std::string& content) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream << content;
    stream.close();
    if (!stream) {
        throw rover_budget::BudgetError(file, 0, "cannot be written",
                                        "check path, permissions and space");
    }
}

Review measured(const BudgetOptions& options, const fs::path& folder) {
    rover_budget::MeasureOptions measure;
    measure.image = image_file(options.target);
    measure.folder = folder;
    measure.logs = {options.logs.begin(), options.logs.end()};
    if (measure.logs.empty())
        measure.logs = rover_budget::logs_below(folder.parent_path() / "golden");
    if (options.target.hold) measure.slow_step = host_sim::SlowStep::hold;
    Review review;
    ProgressBar bar("Measuring");
    review.figures = rover_budget::measure(measure, [&](double share) { bar.update(share); });
    review.numbers = rover_budget::numbers_of(review.figures);
    const fs::path limits = folder / "limits.csv";
    review.limits = rover_budget::parse_limits(host_sim::read_image_file(limits), limits.string());
    return review;
}

void compare(const BudgetOptions& options, const fs::path& folder, Review& review) {
    const auto read = [](const fs::path& file) {
        return rover_budget::parse_numbers(host_sim::read_image_file(file), file.string());
    };
    if (options.logs.empty() && !options.update) {
        const fs::path file = folder / kReviewed;
        if (!fs::exists(file)) {
            throw rover_budget::BudgetError(file.string(), 0, "does not exist",
                                            "write it with `rover85 budget --update`");
        }
        review.reviewed = read(file);
        review.differences = rover_budget::differences(review.reviewed, review.numbers);
    }
    if (options.against.empty()) return;
    review.against = options.against;
    review.since_then = rover_budget::differences(read(options.against), review.numbers);
}

/// What makes the exit code 1.
int verdict(const BudgetOptions& options, const fs::path& folder, const Review& review) {
    const std::vector<std::string>& unmapped = review.figures.placement.unmapped;
    for (const std::string& name : unmapped) {
        fmt::print(stderr, "rover85: budget: {}: belongs to no module; add it to {}\n", name,
                   (folder / "modules.csv").string());
    }
    if (!unmapped.empty()) return kExitDifference;
    if (options.update) {
        write((folder / kReviewed).string(), rover_budget::reviewed_text(review.numbers));
        fmt::print("\nwrote {} numbers to {}\n", review.numbers.size(),
                   (folder / kReviewed).string());
        return kExitPass;
    }
    if (!options.logs.empty()) {
        fmt::print("\nThe reviewed numbers are those of the stored logs: not compared.\n");
        return kExitPass;
    }
    if (review.differences.empty()) {
        fmt::print("\nAll {} numbers are the reviewed ones.\n", review.numbers.size());
        return kExitPass;
    }
    fmt::print(stderr,
               "rover85: budget: {} of {} numbers differ from {}; look at each, then "
               "`rover85 budget --update`\n",
               review.differences.size(), review.numbers.size(), (folder / kReviewed).string());
    return kExitDifference;
}

int bounds(const BudgetOptions& options, const fs::path& folder) {
    BoundsOptions bounds{options.target, folder,        {}, options.random_logs, options.seed,
                         options.json,   options.update};
    bounds.logs.assign(options.logs.begin(), options.logs.end());
    if (bounds.logs.empty())
        bounds.logs = rover_budget::logs_below(folder.parent_path() / "golden");
    return show_bounds(bounds);
}

int budget(const BudgetOptions& options) {
    const fs::path folder = find_folder(options.folder);
    if (options.bounds) return bounds(options, folder);
    Review review = measured(options, folder);
    compare(options, folder, review);
    fmt::print("{}", rover_budget::console_text(review));
    if (!options.json.empty()) write(options.json, rover_budget::json_text(review));
    if (!options.html.empty()) write(options.html, rover_budget::html_text(review));
    if (!options.markdown.empty()) write(options.markdown, rover_budget::markdown_text(review));
    std::fflush(stdout);
    return verdict(options, folder, review);
}

}  // namespace

void add_budget_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<BudgetOptions>();
    CLI::App& command = *app.add_subcommand(
        "budget",
        "What the image costs on the board, by module and by step, against tests/budgets");
    command
        .add_option("LOGS", options->logs,
                    "Logs to fly [default: all of tests/golden, whose numbers are reviewed]")
        ->type_name("LOG ...");
    add_image_options(command, options->target);
    command.add_option("--json", options->json, "Also as JSON, for --against and for programs")
        ->type_name("FILE");
    command.add_option("--html", options->html, "Also as a page with bars")->type_name("FILE");
    command.add_option("--markdown", options->markdown, "Also as Markdown")->type_name("FILE");
    command
        .add_option("--against", options->against,
                    "Show the differences from another revision's --json")
        ->type_name("FILE");
    CLI::Option* update =
        command.add_flag("--update", options->update, "Write the numbers as the reviewed ones");
    command.get_option("LOGS")->excludes(update);
    CLI::Option* bounds_flag = command.add_flag(
        "--bounds", options->bounds,
        "Upper bounds instead: functions, step, handlers, stack, response times, and whether the "
        "logs keep to them");
    for (const char* other : {"--html", "--markdown", "--against"}) {
        bounds_flag->excludes(command.get_option(other));
    }
    command.add_option("--random", options->random_logs, "With --bounds: fly random logs as well")
        ->check(CLI::Range(1, 1'000'000))
        ->needs(bounds_flag);
    command.add_option("--seed", options->seed, "Of the first random log; each has the next one")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str()
        ->needs(bounds_flag);
    command
        .add_option("--budgets", options->folder,
                    "Folder of modules, limits and reviewed numbers [default: tests/budgets of "
                    "this tree]")
        ->type_name("DIR");
    command.footer(
        "Exit code 1 when a number differs from its reviewed one, better or worse, or a function\n"
        "belongs to no module; with --bounds, when a log exceeds a bound or a deadline does not "
        "hold.\n"
        "Examples:\n"
        "  rover85 budget\n"
        "  rover85 budget --json now.json --html budget.html --against before.json\n"
        "  rover85 budget out/main/traverse.rlog\n"
        "  rover85 budget --update\n"
        "  rover85 budget --bounds --random 1000");
    command.callback(
        [options, &exit_code] { exit_code = guarded_on_target([&] { return budget(*options); }); });
}
