// target_option.hpp - where the controller runs: the --target and --image options of the commands.
// Depends on   host_sim/bind, tools/budget, CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "host_sim/bind/board_target.hpp"
#include "tools/report/machine.hpp"

/// What --target, --image, --hold and --no-profile say.
struct TargetOptions {
    std::string target = "host";
    std::string image;  ///< empty: the one beside the program
    bool hold = false;
    bool no_profile = false;  ///< on the board: do not measure every step
};

/// Adds --image and --hold.
void add_image_options(CLI::App& command, TargetOptions& options);
/// Adds --target and --no-profile as well.
void add_target_options(CLI::App& command, TargetOptions& options);

/// The image that the options name. @errors std::runtime_error when it does not exist
std::filesystem::path image_file(const TargetOptions& options);

/// The image on the simulated board. @errors std::runtime_error: no image, or not for this board
std::unique_ptr<host_sim::BoardTarget> make_board_target(const TargetOptions& options);

/// The target that the options name; on the board every step is measured.
/// @errors as make_board_target()
std::unique_ptr<host_sim::ControllerTarget> make_target(const TargetOptions& options);

/// What the steps of a target of make_target() cost; nothing where they were not measured.
std::optional<report::Machine> machine_of(const host_sim::ControllerTarget& target);

/// As guarded(), and a board that fails is exit code 1: the image is wrong, not the input.
int guarded_on_target(const std::function<int()>& work);
