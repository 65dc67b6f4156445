#include "tools/rover85/import_command.hpp"

#include <fmt/format.h>

#include <functional>
#include <iostream>
#include <memory>
#include <string>

#include "host_sim/import/borealtc.hpp"
#include "host_sim/import/omni_wheel_slip.hpp"
#include "host_sim/log/log_io.hpp"
#include "tools/rover85/log_output.hpp"

namespace {

struct Paths {
    std::string first, second, out;
};

void add_output(CLI::App& command, Paths& paths) {
    command.add_option("-o,--output", paths.out, "Log to write: NAME.rlog or NAME.csv")
        ->required()
        ->type_name("OUT")
        ->check(check_log_name);
}

int import_to(const std::string& out, const std::function<host_sim::Log()>& import) {
    try {
        const host_sim::Log log = import();
        write_log(out, log);
        std::cout << fmt::format("{}: {}\n", out, describe_log(log));
        return 0;
    } catch (const host_sim::LogError& error) {
        std::cerr << error.what() << "\n";
        return 3;
    }
}

}  // namespace

void add_import_command(CLI::App& app, int& exit_code) {
    CLI::App& import = *app.add_subcommand(
        "import",
        "Turn a public recording of a real vehicle into a log (docs/guides/real-data.md)");
    import.require_subcommand(1);

    auto husky = std::make_shared<Paths>();
    CLI::App& borealtc = *import.add_subcommand(
        "borealtc", "BorealTC, Clearpath Husky: inertial unit at 100 Hz and wheel speeds");
    borealtc.add_option("IMU", husky->first, "NAME_imu.csv")->required()->type_name("CSV");
    borealtc.add_option("PRO", husky->second, "NAME_pro.csv of the same run")
        ->required()
        ->type_name("CSV");
    add_output(borealtc, *husky);
    borealtc.footer(
        "Example:\n  rover85 import borealtc snow_13_imu.csv snow_13_pro.csv -o snow_13.rlog");
    borealtc.callback([husky, &exit_code] {
        exit_code = import_to(husky->out, [&] {
            return host_sim::import_borealtc(std::filesystem::path(husky->first),
                                             std::filesystem::path(husky->second));
        });
    });

    auto robotino = std::make_shared<Paths>();
    CLI::App& omni = *import.add_subcommand(
        "omni", "Omni-wheel slip, Festo Robotino: encoder ticks, and a camera as the truth");
    omni.add_option("RUN", robotino->first, "A straight run of the data set")
        ->required()
        ->type_name("CSV");
    add_output(omni, *robotino);
    omni.footer("Example:\n  rover85 import omni green_1_000.csv -o green.csv");
    omni.callback([robotino, &exit_code] {
        exit_code = import_to(robotino->out, [&] {
            return host_sim::import_omni(std::filesystem::path(robotino->first));
        });
    });
}
