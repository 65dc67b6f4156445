// monitor_command.cpp - see monitor_command.hpp.
#include "tools/rover85/monitor_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/bind/live_drive.hpp"
#include "host_sim/link/live_board.hpp"
#include "host_sim/link/serial_port.hpp"
#include "tools/monitor/session.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/course_options.hpp"
#include "tools/rover85/end_signal.hpp"
#include "tools/rover85/log_output.hpp"
#include "tools/rover85/target_option.hpp"

namespace {

using Clock = std::chrono::steady_clock;

struct MonitorOptions {
    std::string port;
    bool board = false;
    std::string record;
    std::optional<double> seconds;
    double wait_s = 3;
    TargetOptions image;
    CourseOptions course;
    std::vector<CLI::Option*> of_board;  ///< what only --board can use
};

monitor::SessionOptions session_options(const MonitorOptions& options, std::string name) {
    monitor::SessionOptions session;
    session.name = std::move(name);
    session.record = options.record;
    session.seconds = options.seconds;
    session.wait_s = options.wait_s;
    session.in_place = isatty(STDOUT_FILENO) == 1;
    return session;
}

int monitor_port(const MonitorOptions& options) {
    host_sim::SerialPort port(options.port);
    const EndSignal end;
    monitor::SessionOptions session = session_options(options, options.port);
    session.ended = [&end] { return end.came(); };
    monitor::Session(port, std::move(session), std::cout).run();
    return kExitPass;
}

/// The options under which BoardTarget runs its board.
host_sim::BoardOptions strict_board() {
    host_sim::BoardOptions board;
    board.stop_at_violation = true;
    board.stop_at_halt = true;
    return board;
}

int monitor_board(const MonitorOptions& options) {
    const host_sim::Vehicle vehicle = vehicle_of(options.course);
    const host_sim::DriveOptions course = drive_options(options.course, vehicle);
    host_sim::LiveBoard live(strict_board());
    {
        const auto target = make_board_target(options.image);
        target->begin(head_of(options.course, vehicle).calibration);
        live.board().state = target->board().state;
    }
    host_sim::LiveDrive drive(live, course);
    host_sim::SerialPort port(live.path());
    const EndSignal end;
    // Behind the end of the course there is time for the last frames.
    std::optional<Clock::time_point> finished_at;
    monitor::SessionOptions session = session_options(options, "simulated board");
    session.ended = [&] {
        if (drive.finished() && !finished_at) finished_at = Clock::now();
        return end.came() || !live.running() ||
               (finished_at && Clock::now() - *finished_at > std::chrono::seconds(1));
    };
    monitor::Session monitor(port, std::move(session), std::cout);
    live.start();
    try {
        monitor.run();
    } catch (...) {
        live.stop();  // what it has to say comes first
        throw;
    }
    live.stop();
    if (drive.finished()) std::cout << "The course is over.\n";
    return kExitPass;
}

int run_monitor(const MonitorOptions& options) {
    return guarded_on_target([&] {
        try {
            return options.board ? monitor_board(options) : monitor_port(options);
        } catch (const host_sim::LiveBoardError& error) {
            throw host_sim::BoardError(error.what());
        }
    });
}

void add_options(CLI::App& command, MonitorOptions& options) {
    CLI::Option* port = command
                            .add_option("--port", options.port,
                                        "Serial port, or the one that `rover85 board` prints")
                            ->type_name("PATH");
    CLI::Option* board = command.add_flag(
        "--board", options.board,
        "No port: the image drives on a simulated board, in real time, through the world that "
        "the other options describe");
    port->excludes(board);
    command
        .add_option("--record", options.record, "Record as a log, .rlog or .csv, while it comes")
        ->check(check_log_name)
        ->type_name("FILE");
    command.add_option("--seconds", options.seconds, "End by itself [default: at Ctrl-C]")
        ->check(CLI::Range(0.1, 1e7));
    command.add_option("--wait", options.wait_s, "For the first telemetry frame, s")
        ->check(CLI::Range(0.1, 1e5))
        ->capture_default_str();
    const std::size_t own = command.get_options().size();
    command
        .add_option("--image", options.image.image,
                    "Image for --board, Intel HEX with its .sym beside it; else rover85.hex beside "
                    "this program")
        ->type_name("HEX");
    add_course_options(command, options.course);
    const auto all = command.get_options();
    options.of_board.assign(all.begin() + static_cast<std::ptrdiff_t>(own), all.end());
}

/// What only --board can use, and was given without it; nullptr: nothing.
const CLI::Option* misplaced(const MonitorOptions& options) {
    if (options.board) return nullptr;
    for (const CLI::Option* option : options.of_board) {
        if (option->count() > 0) return option;
    }
    return nullptr;
}

int checked_monitor(const MonitorOptions& options) {
    if (const CLI::Option* option = misplaced(options)) {
        std::cerr << "rover85: monitor: " << option->get_name() << " needs --board\n";
        return kExitUsage;
    }
    if (options.port.empty() && !options.board) {
        std::cerr << "rover85: monitor: from where? Give --port PATH or --board\n";
        return kExitUsage;
    }
    return run_monitor(options);
}

}  // namespace

void add_monitor_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<MonitorOptions>();
    CLI::App& command = *app.add_subcommand(
        "monitor",
        "Show a rover's telemetry as it comes, and record it (docs/guides/monitoring.md)");
    add_options(command, *options);
    command.footer(
        "On a terminal the figures are renewed in place, elsewhere each frame is a line. The "
        "rover\n"
        "is asked for its identity, and every 5 s for its status. Ctrl-C ends with a summary.\n"
        "Examples:\n"
        "  rover85 monitor --port /dev/ttyUSB0\n"
        "  rover85 monitor --port /dev/ttyUSB0 --record drive.rlog --seconds 600\n"
        "  rover85 monitor --board --roughness 0.04 --record drive.csv");
    command.callback([options, &exit_code] { exit_code = checked_monitor(*options); });
}
