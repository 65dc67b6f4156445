#include "tools/rover85/main_job_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "host_sim/bind/host_target.hpp"
#include "host_sim/world/course.hpp"
#include "tools/report/summary.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/drive_output.hpp"
#include "tools/rover85/progress_bar.hpp"
#include "tools/rover85/target_option.hpp"

namespace {

namespace fs = std::filesystem;

constexpr double kCourseMinM = 20.0;
constexpr double kBlendM = 0.30;
constexpr double kStaticSinkageCm = 0.5;
constexpr double kRampCm = 100;  // the paper's exit ramp: the first metre is known

struct MainJobOptions {
    std::string data = "../shared/data", out = "out/main";
    std::uint64_t seed = 1;
    TargetOptions target;  ///< of the whole course; single profiles run on the host
};

/// The measured profiles, by file name; none when the data set is not there.
std::vector<host_sim::Profile> load_profiles(const fs::path& folder) {
    std::vector<fs::path> files;
    if (fs::is_directory(folder)) {
        for (const auto& entry : fs::directory_iterator(folder)) {
            const std::string name = entry.path().filename().string();
            if (name.ends_with(".csv") && name != "index.csv") files.push_back(entry.path());
        }
    }
    // Front and rear patches by turns, so that a course has both: by the name after the first word.
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        const auto key = [](const fs::path& file) {
            const std::string name = file.filename().string();
            const std::size_t word = name.find('_');
            return std::pair(word == std::string::npos ? name : name.substr(word), name);
        };
        return key(a) < key(b);
    });
    std::vector<host_sim::Profile> profiles;
    for (const fs::path& file : files) profiles.push_back(host_sim::load_profile(file.string()));
    return profiles;
}

void print_roughness(const std::vector<host_sim::Profile>& profiles) {
    fmt::print("Measured ground in the terms of Wilcox 1994 ({} profiles, Spirit, Mars):\n",
               profiles.size());
    for (const double bin_cm : {2.5, 5.0}) {
        const host_sim::Roughness r = host_sim::roughness_of(profiles, bin_cm);
        fmt::print(
            "  {:.1f} cm bins: RMS step {:.2f} cm, RMS projection error {:.2f} cm: like "
            "roughness {:.3f} (steps), {:.3f} (projection)\n",
            bin_cm, r.rms_step_cm, r.rms_projection_cm, r.by_step, r.by_projection);
    }
}

/// Both wheel kinds, fitted when the measurements are there; the built-in fits otherwise.
host_sim::SinkageLaw print_sinkage_laws(const fs::path& file) {
    const bool measured = fs::exists(file);
    for (const auto kind : {host_sim::WheelKind::grouser, host_sim::WheelKind::smooth}) {
        const char* name = kind == host_sim::WheelKind::grouser ? "grousers" : "smooth";
        const host_sim::SinkageLaw built_in = host_sim::built_in_sinkage_law(kind);
        if (measured) {
            const host_sim::SinkageFit fit = host_sim::fit_sinkage_file(file.string(), kind);
            fmt::print(
                "Sinkage of a wheel ({}): {:.1f} mm * slip^{:.2f}, RMS {:.1f} mm over {} "
                "trials\n",
                name, fit.law.scale_mm, fit.law.exponent, fit.rms_mm, fit.trials.size());
        } else {
            fmt::print("Sinkage of a wheel ({}): {:.1f} mm * slip^{:.2f} (built in)\n", name,
                       built_in.scale_mm, built_in.exponent);
        }
    }
    return measured ? host_sim::fit_sinkage_file(file.string(), host_sim::WheelKind::grouser).law
                    : host_sim::built_in_sinkage_law(host_sim::WheelKind::grouser);
}

host_sim::Log drive(host_sim::ControllerTarget& target, const host_sim::DriveOptions& course,
                    const host_sim::Vehicle& vehicle, std::map<std::string, std::string> notes,
                    const std::string& label) {
    host_sim::LogHead head;
    head.vehicle = vehicle.toml_text;
    head.calibration = host_sim::nominal_calibration(vehicle);
    head.notes = std::move(notes);
    head.notes["seed"] = fmt::format("{}", course.seed);
    host_sim::Drive world(course);
    ProgressBar bar(label);
    return host_sim::drive(target, world, std::move(head),
                           [&bar](double share) { bar.update(share); });
}

/// The traverse itself, where the options say.
void drive_and_report(const MainJobOptions& options, const host_sim::DriveOptions& course,
                      const host_sim::Vehicle& vehicle, std::map<std::string, std::string> notes,
                      const std::string& title) {
    const auto target = make_target(options.target);
    const host_sim::Log log = drive(*target, course, vehicle, std::move(notes), "Driving");
    write_drive_output(log, {options.out, title, "rover85 main-job",
                             10 * (vehicle.rocker_cm + vehicle.bogie_arm_cm), machine_of(*target)});
}

std::string percent(const report::Figure& figure) {
    return figure ? fmt::format("{:+8.2f}", *figure) : std::string("     n/a");
}

void drive_each_profile(const std::vector<host_sim::Profile>& profiles,
                        const host_sim::SinkageLaw& law, const host_sim::Vehicle& vehicle,
                        std::uint64_t seed) {
    const auto host = host_sim::make_host_target();
    fmt::print("Each profile by itself, after a level ramp of {:.1f} m without slip:\n",
               kRampCm / 100);
    fmt::print("  {:<20} {:>7} {:>12} {:>12} {:>14}\n", "profile", "m", "position %", "odometer %",
               "sinkage rms mm");
    for (const host_sim::Profile& profile : profiles) {
        auto course = host_sim::profile_course(vehicle, profile, law, kStaticSinkageCm, seed);
        host_sim::add_exit_ramp(course, kRampCm);
        const report::Summary s =
            report::summarize(drive(*host, course, vehicle, {}, profile.name));
        fmt::print("  {:<20} {:>7.2f} {:>12} {:>12} {:>14}\n",
                   fs::path(profile.name).filename().string(), s.true_distance_m.value_or(NAN),
                   percent(s.firmware_error_percent), percent(s.wheel_error_percent),
                   s.sinkage_mm.rms_error ? fmt::format("{:.1f}", *s.sinkage_mm.rms_error) : "n/a");
    }
}

int drive_measured_ground(const MainJobOptions& options,
                          const std::vector<host_sim::Profile>& profiles,
                          const host_sim::Vehicle& vehicle) {
    print_roughness(profiles);
    const host_sim::SinkageLaw law =
        print_sinkage_laws(fs::path(options.data) / "sand-single-wheel/steady_state.csv");
    drive_each_profile(profiles, law, vehicle, options.seed);

    const host_sim::Course course = host_sim::stitch(profiles, kCourseMinM + 1.0, kBlendM);
    std::map<std::string, std::string> notes = {
        {"source", "simulated vehicle on measured ground"},
        {"terrain", fmt::format("{} height profiles of Mars (Spirit, site 131), stitched; {} seams "
                                "blended over {:.2f} m each",
                                profiles.size(), course.seams.size(), kBlendM)},
        {"sinkage", fmt::format("{:.0f} mm + {:.1f} mm * slip^{:.2f} (single-wheel tests in sand)",
                                10 * kStaticSinkageCm, law.scale_mm, law.exponent)},
        {"potentiometer_noise", "0.26 mrad, the repeatability of Spirit's"},
    };
    std::string seams;
    for (const host_sim::Seam& seam : course.seams) {
        seams +=
            fmt::format("{}{:.2f}-{:.2f} m", seams.empty() ? "" : ", ", seam.begin_m, seam.end_m);
    }
    notes["seams"] = seams + " (in the profile's distance, which begins at the end of the ramp)";
    notes["ramp"] = fmt::format("{:.1f} m, level and firm, before the course", kRampCm / 100);
    auto stitched =
        host_sim::profile_course(vehicle, course.profile, law, kStaticSinkageCm, options.seed);
    host_sim::add_exit_ramp(stitched, kRampCm);
    fmt::print("Stitched course of {:.1f} m ({} seams, each blended over {:.2f} m):\n",
               course.profile.length_m(), course.seams.size(), kBlendM);
    drive_and_report(options, stitched, vehicle, notes, "Traverse over measured ground of Mars");
    return kExitPass;
}

int drive_synthetic_ground(const MainJobOptions& options, const host_sim::Vehicle& vehicle) {
    fmt::print(
        "No measured ground in {} (docs/guides/real-data.md names the data sets): driving a "
        "built-in synthetic course instead.\n",
        options.data);
    auto course = host_sim::random_course(vehicle, host_sim::TerrainKind::wilcox1994, 0.04, 62.5,
                                          options.seed);
    host_sim::add_exit_ramp(course, kRampCm);
    drive_and_report(
        options, course, vehicle,
        {{"source", "simulated world"}, {"terrain", "synthetic: Wilcox 1994, roughness 0.04"}},
        "Traverse over synthetic ground");
    return kExitPass;
}

int main_job(const MainJobOptions& options) {
    const host_sim::Vehicle vehicle = host_sim::rocky32();
    const auto profiles = load_profiles(fs::path(options.data) / "mars-height-profiles");
    if (profiles.empty()) return drive_synthetic_ground(options, vehicle);
    return drive_measured_ground(options, profiles, vehicle);
}

}  // namespace

void add_main_job_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<MainJobOptions>();
    CLI::App& command = *app.add_subcommand(
        "main-job",
        "Drive measured ground of Mars: every profile and a course of 20 m; what ./tools/run does");
    command.add_option("--data", options->data, "Folder of the data sets")->capture_default_str();
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.add_option("--seed", options->seed, "Everything random follows from it")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    add_target_options(command, options->target);
    command.footer(
        "Single profiles are driven natively; --target is where the course is driven. On the "
        "board\n"
        "every step is measured, and the report shows T-states, interrupt load, ROM and RAM.\n"
        "Examples:\n"
        "  rover85 main-job --out out/main\n"
        "  rover85 main-job --target board --out out/on_board");
    command.callback([options, &exit_code] {
        exit_code = guarded_on_target([&] { return main_job(*options); });
    });
}
