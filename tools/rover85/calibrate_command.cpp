#include "tools/rover85/calibrate_command.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "host_sim/calibration/calibrate.hpp"
#include "host_sim/calibration/calibration_file.hpp"
#include "host_sim/log/log_io.hpp"
#include "tools/rover85/log_output.hpp"

namespace {

constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

struct Options {
    std::string log, out, apply;
    std::vector<std::string> channels = {"bogie_left", "bogie_right", "differential"};
    std::vector<std::string> flip;
    bool no_swing = false;
    double level_from_s = kNotGiven, level_to_s = kNotGiven;
    double turned_from_s = kNotGiven, turned_to_s = kNotGiven;
    host_sim::CalibrateOptions calibrate;
};

hal::AngleChannel channel_of(const std::string& name) {
    for (std::uint8_t index = 0; index < hal::kAngleChannelCount; ++index) {
        const auto channel = static_cast<hal::AngleChannel>(index);
        if (host_sim::angle_channel_name(channel) == name) return channel;
    }
    throw CLI::ValidationError(fmt::format("{} is not an angle channel", name));
}

/// Both ends or neither; CLI11 has seen to that.
std::optional<host_sim::TimeSpan> span_of(double from_s, double to_s) {
    if (std::isnan(from_s)) return std::nullopt;
    return host_sim::TimeSpan{from_s, to_s};
}

host_sim::CalibrateOptions complete(const Options& options) {
    host_sim::CalibrateOptions calibrate = options.calibrate;
    calibrate.swung.clear();
    if (!options.no_swing) {
        for (const std::string& name : options.channels) {
            calibrate.swung.push_back(channel_of(name));
        }
    }
    for (const std::string& name : options.flip) {
        calibrate.flip[static_cast<std::size_t>(channel_of(name))] = true;
    }
    calibrate.level_span = span_of(options.level_from_s, options.level_to_s);
    calibrate.turned_span = span_of(options.turned_from_s, options.turned_to_s);
    return calibrate;
}

int run_calibrate(const Options& options) {
    const host_sim::CalibrateOptions calibrate = complete(options);
    if (calibrate.swung.empty() && !calibrate.level_span) {
        std::cerr << "nothing to estimate: leave out --no-swing or give --level-from\n";
        return 2;
    }
    try {
        host_sim::Log log = host_sim::load_log(options.log);
        const host_sim::CalibrationResult result = host_sim::calibrate(log, calibrate);
        std::vector<std::string> comments = {fmt::format(
            "rover85 calibrate, from {}", std::filesystem::path(options.log).filename().string())};
        for (const std::string& line : host_sim::describe(result, calibrate)) {
            comments.push_back(line);
        }
        if (options.out.empty()) {
            std::cout << host_sim::encode_calibration(result.record, comments);
        } else {
            host_sim::save_calibration(options.out, result.record, comments);
            for (const std::string& line : comments) std::cout << line << "\n";
        }
        if (!options.apply.empty()) {
            log.head.calibration = result.record;
            write_log(options.apply, log);
        }
        return 0;
    } catch (const host_sim::CalibrationError& error) {
        std::cerr << options.log << ": " << error.what() << "\n";
    } catch (const host_sim::LogError& error) {
        std::cerr << error.what() << "\n";
    }
    return 3;
}

void add_stretch(CLI::App& command, const std::string& name, double& from_s, double& to_s,
                 const std::string& help) {
    CLI::Option* from =
        command.add_option("--" + name + "-from", from_s, help + ": start")->type_name("S");
    CLI::Option* to = command.add_option("--" + name + "-to", to_s, help + ": end")->type_name("S");
    from->needs(to)->check(CLI::NonNegativeNumber);
    to->needs(from)->check(CLI::NonNegativeNumber);
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<Options>();
    CLI::App& command = *app.add_subcommand(
        "calibrate",
        "Find potentiometer zero and gain from a swing of the bogies to both stops, and the "
        "inclinometer's zero from standing still (docs/spec/calibration.md)");
    command.add_option("LOG", options->log, "Recorded log, .rlog or wide CSV")->required();
    command.add_option("-o,--output", options->out,
                       "Record to write (TOML); without it the record goes to standard output");
    command.add_option("--apply", options->apply, "Also copy the log with the record in its head")
        ->type_name("OUT")
        ->check(check_log_name);
    const auto stop = [&](const char* name, double& value, const char* help) {
        command.add_option(name, value, help)
            ->type_name("DEG")
            ->check(CLI::Range(1.0, 44.9))
            ->capture_default_str();
    };
    stop("--stop-deg", options->calibrate.bogie_stop_deg, "Bogie stops, from the middle");
    stop("--differential-stop-deg", options->calibrate.differential_stop_deg,
         "Differential stops, from the middle");
    command.add_option("--channel", options->channels, "Potentiometers that were swung")
        ->type_name("NAME")
        ->check(CLI::IsMember({"bogie_left", "bogie_right", "differential"}))
        ->capture_default_str();
    command.add_flag("--no-swing", options->no_swing, "Nothing was swung: level stretch only");
    command.add_option("--visits", options->calibrate.swing.visits_min, "Visits needed at a stop")
        ->type_name("N")
        ->check(CLI::Range(2, 100))
        ->capture_default_str();
    add_stretch(command, "level", options->level_from_s, options->level_to_s,
                "Standing still on level ground");
    add_stretch(command, "turned", options->turned_from_s, options->turned_to_s,
                "Standing still after turning by 180 deg on the spot");
    command.get_option("--turned-from")->needs(command.get_option("--level-from"));
    command.add_option("--flip", options->flip, "Channels whose polarity is to change")
        ->type_name("NAME")
        ->check(CLI::IsMember({"bogie_left", "bogie_right", "differential", "pitch", "roll"}));
    command.footer(
        "Examples:\n"
        "  rover85 calibrate swing.rlog -o calibration.toml --stop-deg 30\n"
        "  rover85 calibrate swing.rlog --channel bogie_left --channel bogie_right\n"
        "  rover85 calibrate still.csv --no-swing --level-from 0 --level-to 10 --turned-from 20 "
        "--turned-to 30");
    command.callback([options, &exit_code] { exit_code = run_calibrate(*options); });
}
