#include "tools/rover85/simulate_command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>

#include "host_sim/bind/controller_target.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/course_options.hpp"
#include "tools/rover85/drive_output.hpp"
#include "tools/rover85/progress_bar.hpp"
#include "tools/rover85/target_option.hpp"

namespace {

struct SimulateOptions {
    CourseOptions course;
    std::string out = "out/simulate";
    TargetOptions target;
    std::vector<double> resets_s;
};

int simulate(const SimulateOptions& options, const std::string& command_line) {
    const host_sim::Vehicle vehicle = vehicle_of(options.course);
    const host_sim::DriveOptions course = drive_options(options.course, vehicle);
    host_sim::LogHead head = head_of(options.course, vehicle);
    const auto target = make_target(options.target);
    std::vector<double> resets_s = options.resets_s;
    std::sort(resets_s.begin(), resets_s.end());
    if (!resets_s.empty()) head.notes["resets"] = fmt::format("{} s", fmt::join(resets_s, ", "));
    host_sim::Drive drive(course);
    host_sim::Log log;
    {
        ProgressBar bar("Driving");
        log = host_sim::drive(
            *target, drive, std::move(head), [&bar](double share) { bar.update(share); }, resets_s);
    }
    if (drive.end() != host_sim::DriveEnd::reached) {
        fmt::print("The course was not finished: {} after {:.2f} m.\n",
                   drive.end() == host_sim::DriveEnd::out_of_time ? "time ran out"
                                                                  : "the vehicle left the course",
                   drive.state().position_cm / 100);
    }
    write_drive_output(log, {options.out, "Simulated traverse", command_line,
                             10 * (vehicle.rocker_cm + vehicle.bogie_arm_cm), machine_of(*target)});
    return kExitPass;
}

}  // namespace

void add_simulate_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<SimulateOptions>();
    CLI::App& command = *app.add_subcommand(
        "simulate", "Drive one traverse in the simulated world and report on it");
    add_course_options(command, options->course);
    add_target_options(command, options->target);
    command
        .add_option("--reset-at", options->resets_s,
                    "Seconds at which the processor is reset; it goes on from its checkpoint")
        ->delimiter(',')
        ->check(CLI::NonNegativeNumber)
        ->type_name("S[,S...]");
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.footer(
        "Writes DIR/report.html, traverse.csv, summary.json and traverse.rlog.\n"
        "Examples:\n"
        "  rover85 simulate --terrain wilcox1994 --roughness 0.04 --seed 7 --out out/rough\n"
        "  rover85 simulate --faults bogie_left:stuck@600-900 --length 20\n"
        "  rover85 simulate --terrain profile:ground.csv --advance uniform\n"
        "  rover85 simulate --target board --length 5 --reset-at 120,240.5");
    command.callback([options, &exit_code] {
        exit_code = guarded_on_target([&] {
            return simulate(*options,
                            fmt::format("rover85 simulate --terrain {} --roughness {} --length {} "
                                        "--seed {}",
                                        options->course.terrain, options->course.roughness,
                                        options->course.length_m, options->course.seed));
        });
    });
}
