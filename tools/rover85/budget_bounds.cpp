// budget_bounds.cpp - see budget_bounds.hpp.
#include "tools/rover85/budget_bounds.hpp"

#include <fmt/format.h>

#include <fstream>

#include "hal/board/rb85.hpp"
#include "host_sim/bind/host_target.hpp"
#include "host_sim/bind/random_log.hpp"
#include "host_sim/log/log_io.hpp"
#include "tools/bounds/request_log.hpp"
#include "tools/bounds/tables.hpp"
#include "tools/budget/budget_error.hpp"
#include "tools/budget/reviewed.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/progress_bar.hpp"

namespace {

namespace fs = std::filesystem;
using rover_bounds::Bounds;
using rover_bounds::Observed;

constexpr const char* kReviewed = "bounds.json";
constexpr std::size_t kRandomSteps = 100;

rover_bounds::Timing timing() {
    constexpr uint64_t kBitsOfCharacter = 10;
    constexpr uint64_t kClocksOfBit = 16;  // the 8251A samples 16 times a bit
    constexpr uint64_t kTicksPerStep = 10;
    return {hal::rb85::kTickCount, kBitsOfCharacter * kClocksOfBit * hal::rb85::kBaudCount,
            kTicksPerStep * hal::rb85::kTickCount};
}

fs::path beside(fs::path image, const char* ending) {
    return image.replace_extension(ending);
}

void write(const fs::path& file, const std::string& content) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream << content;
    stream.close();
    if (!stream) {
        throw rover_budget::BudgetError(file.string(), 0, "cannot be written",
                                        "check path, permissions and space");
    }
}

/// Flies all logs with an observer.
class Flight {
public:
    Flight(const BoundsOptions& options, const host_sim::Image& image,
           const host_sim::Symbols& symbols, rover_bounds::Observer& observer)
        : options_(options),
          observer_(observer),
          target_(image, symbols,
                  options.target.hold ? host_sim::SlowStep::hold : host_sim::SlowStep::fail) {
        target_.observe([&](const host_sim::StepRecord& step, const host_sim::CpuState& after) {
            observer_.observe(step, after);
        });
    }

    void run() {
        ProgressBar bar("Checking");
        const auto all = static_cast<double>(2 * options_.logs.size() + options_.random_logs);
        double flown = 0;
        for (const fs::path& path : options_.logs) {
            const host_sim::Log log = host_sim::load_log(path);
            fly(log);
            bar.update(++flown / all);
            fly(rover_bounds::with_requests(log));
            bar.update(++flown / all);
        }
        for (uint64_t i = 0; i < options_.random_logs; ++i) {
            fly(host_sim::random_log(options_.seed + i, kRandomSteps));
            bar.update(++flown / all);
        }
    }

private:
    void fly(host_sim::Log log) {
        observer_.restart();
        target_.begin(log.head.calibration);
        for (std::size_t i = 0; i < log.steps.size(); ++i) target_.step(log.steps, i);
    }

    const BoundsOptions& options_;
    rover_bounds::Observer& observer_;
    host_sim::BoardTarget target_;
};

/// Compares with the reviewed numbers, or replaces them. @return  are they the same?
bool review(const BoundsOptions& options, const Bounds& bounds) {
    const fs::path file = options.folder / kReviewed;
    const rover_budget::Numbers numbers = rover_bounds::numbers_of(bounds);
    if (options.update) {
        write(file, rover_budget::reviewed_text(numbers, "rover85 budget --bounds",
                                                "docs/design/bounds.md"));
        fmt::print("\nwrote {} numbers to {}\n", numbers.size(), file.string());
        return true;
    }
    const auto reviewed =
        rover_budget::parse_numbers(host_sim::read_image_file(file), file.string());
    const auto differences = rover_budget::differences(reviewed, numbers);
    for (const auto& difference : differences) {
        fmt::print("{}\n", rover_budget::describe(difference));
    }
    if (differences.empty()) {
        fmt::print("\nAll {} numbers are the reviewed ones.\n", numbers.size());
    } else {
        fmt::print(stderr,
                   "rover85: budget: {} of {} bounds differ from {}; look at each, then "
                   "`rover85 budget --bounds --update`\n",
                   differences.size(), numbers.size(), file.string());
    }
    return differences.empty();
}

/// Says what does not hold. @return  does everything?
bool holds(const Bounds& bounds, const Observed& observed) {
    bool all = observed.violations.empty();
    for (const std::string& violation : observed.violations) {
        fmt::print(stderr, "rover85: budget: exceeded: {}\n", violation);
    }
    for (const auto& deadline : bounds.deadlines) {
        if (deadline.holds()) continue;
        all = false;
        fmt::print(stderr, "rover85: budget: {}: the deadline of {} T does not hold\n",
                   deadline.what, deadline.deadline_t);
    }
    return all;
}

}  // namespace

int show_bounds(const BoundsOptions& options) {
    const fs::path hex = image_file(options.target);
    const host_sim::Image image = host_sim::load_hex(hex);
    const host_sim::Symbols symbols = host_sim::load_symbols(beside(hex, ".sym"));
    const fs::path map_file = beside(hex, ".map");
    const auto map =
        rover_budget::parse_map(host_sim::read_image_file(map_file), map_file.string());
    const fs::path flow = options.folder / "flow.csv";
    const rover_bounds::FlowProgram program(
        image, symbols, map,
        rover_bounds::parse_flow(host_sim::read_image_file(flow), flow.string()));
    const Bounds bounds = rover_bounds::find_bounds(program, timing());
    const rover_budget::MapRegion& stack = map.region("stack");
    rover_bounds::Observer observer(program, bounds, stack.first + stack.size);
    Flight(options, image, symbols, observer).run();

    const Observed& observed = observer.observed();
    fmt::print("{}", rover_bounds::console_text(program, bounds, observed));
    fmt::print(
        "\n{} steps of {} logs, as they are and with requests in every step, and {} random ones: "
        "{}.\n",
        observed.steps, options.logs.size(), options.random_logs,
        observed.violations.empty() ? "nothing above its bound" : "bounds exceeded");
    if (!options.json.empty()) {
        write(options.json, rover_bounds::json_text(program, bounds, observed));
    }
    std::fflush(stdout);
    const bool same = review(options, bounds);
    return holds(bounds, observed) && same ? kExitPass : kExitDifference;
}
