#include "tools/rover85/target_option.hpp"

#include <fmt/format.h>

#include <functional>
#include <stdexcept>

#include "host_sim/bind/host_target.hpp"
#include "tools/budget/profiled_target.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/image_beside.hpp"

namespace fs = std::filesystem;

namespace {

host_sim::SlowStep slow_step(const TargetOptions& options) {
    return options.hold ? host_sim::SlowStep::hold : host_sim::SlowStep::fail;
}

}  // namespace

void add_image_options(CLI::App& command, TargetOptions& options) {
    command
        .add_option("--image", options.image,
                    "Image for the board, Intel HEX with its .sym beside it; else rover85.hex "
                    "beside this program")
        ->type_name("HEX");
    command.add_flag("--hold", options.hold,
                     "Let the board's tick stand still while a step takes more than 0.1 s, instead "
                     "of failing: for images that are too slow");
}

void add_target_options(CLI::App& command, TargetOptions& options) {
    command
        .add_option("--target", options.target,
                    "Where the controller runs: as a native program, or as the image on the "
                    "simulated board")
        ->check(CLI::IsMember({"host", "board"}))
        ->take_last()
        ->capture_default_str();
    add_image_options(command, options);
    command.add_flag("--no-profile", options.no_profile,
                     "On the board: do not measure every step; some five times faster, and the "
                     "report has no section about the machine");
}

fs::path image_file(const TargetOptions& options) {
    const fs::path image = options.image.empty() ? image_beside() : fs::path(options.image);
    if (fs::exists(image)) return image;
    throw std::runtime_error(fmt::format(
        "{}: there is no such image; {}", image.string(),
        options.image.empty() ? "build the target rover85_image, or name one with --image"
                              : "build the target rover85_image, or correct the name"));
}

std::unique_ptr<host_sim::BoardTarget> make_board_target(const TargetOptions& options) {
    return std::make_unique<host_sim::BoardTarget>(image_file(options), slow_step(options));
}

std::unique_ptr<host_sim::ControllerTarget> make_target(const TargetOptions& options) {
    if (options.target == "board" && options.no_profile) return make_board_target(options);
    if (options.target == "board") {
        return std::make_unique<rover_budget::ProfiledTarget>(image_file(options),
                                                              slow_step(options));
    }
    return host_sim::make_host_target();
}

std::optional<report::Machine> machine_of(const host_sim::ControllerTarget& target) {
    const auto* measured = dynamic_cast<const rover_budget::ProfiledTarget*>(&target);
    if (measured == nullptr) return {};
    return measured->machine();
}

int guarded_on_target(const std::function<int()>& work) {
    return guarded([&] {
        try {
            return work();
        } catch (const host_sim::BoardError& error) {
            fmt::print(stderr, "rover85: {}\n", error.what());
            return int{kExitDifference};
        }
    });
}
