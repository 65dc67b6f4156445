// board_command.cpp - see board_command.hpp.
#include "tools/rover85/board_command.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "hal/board/rb85.hpp"
#include "host_sim/image/image.hpp"
#include "host_sim/link/live_board.hpp"
#include "tools/debug/load.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/end_signal.hpp"

namespace {

namespace fs = std::filesystem;
namespace rb85 = hal::rb85;
using Bytes = std::vector<uint8_t>;
using Clock = std::chrono::steady_clock;

constexpr uint64_t kSaveEveryT = 2ULL * rb85::kClockHz;

struct BoardCommandOptions {
    std::string image, link, eeprom;
    std::optional<double> seconds;
};

/// A second name for the pseudo-terminal, gone with this object.
class Link {
public:
    /// @errors  std::runtime_error: there is something else, or it cannot be made
    Link(fs::path name, fs::path target) : name_(std::move(name)), target_(std::move(target)) {
        if (name_.empty()) return;
        std::error_code problem;
        if (fs::is_symlink(fs::symlink_status(name_, problem))) fs::remove(name_, problem);
        fs::create_symlink(target_, name_, problem);
        if (problem) {
            const std::string what = problem.message();
            throw std::runtime_error(fmt::format("{}: cannot be made ({}); choose another --link",
                                                 name_.string(), what));
        }
    }
    ~Link() {
        std::error_code ignored;  // another board may have taken the name over
        if (!name_.empty() && fs::read_symlink(name_, ignored) == target_) {
            fs::remove(name_, ignored);
        }
    }
    Link(const Link&) = delete;
    Link& operator=(const Link&) = delete;

private:
    fs::path name_, target_;
};

/// The EEPROM's content in a file. It replaces the file whole or not at all.
class EepromFile {
public:
    explicit EepromFile(fs::path path) : path_(std::move(path)) {}

    [[nodiscard]] bool exists() const { return !path_.empty() && fs::exists(path_); }

    void load(host_sim::Board& board) {
        const std::string content = host_sim::read_image_file(path_);
        if (content.size() != host_sim::chips::At28c256::kSize) {
            throw host_sim::ImageError(path_.string(), 0,
                                       fmt::format("has {} bytes, the EEPROM {}", content.size(),
                                                   host_sim::chips::At28c256::kSize),
                                       "name a file that `rover85 board` or a programmer wrote");
        }
        saved_.assign(content.begin(), content.end());
        board.program(saved_);
    }

    void save(const host_sim::Board& board) {
        const uint8_t* data = board.state.eeprom.data();
        Bytes content(data, data + host_sim::chips::At28c256::kSize);
        if (path_.empty() || content == saved_) return;
        const fs::path part = path_.string() + ".part";
        std::ofstream stream(part, std::ios::binary | std::ios::trunc);
        stream.write(reinterpret_cast<const char*>(content.data()),
                     static_cast<std::streamsize>(content.size()));
        stream.close();
        std::error_code problem;
        if (stream) fs::rename(part, path_, problem);
        if (!stream || problem) {
            throw host_sim::ImageError(path_.string(), 0, "cannot be written",
                                       "check path, permissions and space");
        }
        saved_ = std::move(content);
    }

private:
    fs::path path_;
    Bytes saved_;
};

/// What is in the board when it is switched on, in words.
std::string fill(host_sim::Board& board, const BoardCommandOptions& options, EepromFile& eeprom) {
    if (eeprom.exists()) {
        eeprom.load(board);
        return options.eeprom;
    }
    if (options.image.empty()) {
        throw std::runtime_error(
            options.eeprom.empty()
                ? "board: nothing to run; name an image, or a file with --eeprom"
                : options.eeprom + ": does not exist yet; name an image to begin with");
    }
    debug_console::load_image(debug_console::read_image(options.image, {}), board);
    return options.image;
}

/// A vehicle that stands level: every sensor in the middle of its range.
void plug_in_sensors(host_sim::Board& board) {
    constexpr uint16_t kMiddleCount = 2048;
    for (uint8_t channel = 0; channel < hal::kAdcChannelCount; ++channel) {
        board.schedule({0, host_sim::Stimulus::Kind::sensor, channel,
                        host_sim::sensor_uv_of_count(kMiddleCount)});
    }
}

/// Saves now and then, for as long as the board lives.
void save_regularly(host_sim::LiveBoard& live, EepromFile& eeprom, uint64_t t) {
    live.at(t, [&live, &eeprom, t](host_sim::Board& board) {
        eeprom.save(board);
        save_regularly(live, eeprom, t + kSaveEveryT);
    });
}

void print_end(host_sim::LiveBoard& live) {
    const auto counts = live.counts();
    const host_sim::BoardState& state = live.board().state;
    std::cout << fmt::format(
        "{:.1f} s, {} resets, {} violations; {} characters received, {} sent, {} of them read by "
        "nobody\n",
        static_cast<double>(state.cpu.t) / rb85::kClockHz, state.reset_count, state.violation_count,
        counts.received, counts.sent, counts.lost);
}

int run_board(const BoardCommandOptions& options) {
    host_sim::LiveBoard live;
    EepromFile eeprom(options.eeprom);
    const std::string content = fill(live.board(), options, eeprom);
    plug_in_sensors(live.board());
    eeprom.save(live.board());
    const Link link(options.link, live.path());
    const EndSignal end;
    save_regularly(live, eeprom, kSaveEveryT);
    live.start();
    std::cout << fmt::format("board with {}, serial port {}{}; Ctrl-C ends it", content,
                             live.path().string(), options.link.empty() ? "" : " = " + options.link)
              << std::endl;
    const Clock::time_point begin = Clock::now();
    const auto over = [&] {
        return options.seconds &&
               Clock::now() - begin >= std::chrono::duration<double>(*options.seconds);
    };
    while (live.running() && !end.came() && !over()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    try {
        live.stop();
    } catch (const host_sim::LiveBoardError& error) {
        eeprom.save(live.board());
        std::cerr << "rover85: " << error.what() << "\n";
        return kExitDifference;
    }
    eeprom.save(live.board());
    print_end(live);
    return kExitPass;
}

}  // namespace

void add_board_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<BoardCommandOptions>();
    CLI::App& command = *app.add_subcommand(
        "board", "Run a simulated board in real time, its link a serial port to try things with");
    command
        .add_option("IMAGE", options->image,
                    "Program, Intel HEX or BIN; not needed when the file of --eeprom exists")
        ->type_name("IMAGE");
    command.add_option("--link", options->link, "A name for the serial port, as a symbolic link")
        ->type_name("PATH");
    command
        .add_option("--eeprom", options->eeprom,
                    "Content of the EEPROM: read when the file exists, else IMAGE; written back "
                    "when it changes")
        ->type_name("FILE.bin");
    command.add_option("--seconds", options->seconds, "End by itself [default: at Ctrl-C]")
        ->check(CLI::Range(0.1, 1e7));
    command.footer(
        "The serial port is a pseudo-terminal that other programs open like a real one. Every\n"
        "sensor stands in the middle of its range. For a vehicle that drives: monitor --board.\n"
        "Examples:\n"
        "  rover85 board build/bin/rover85.hex --link /tmp/rover\n"
        "  rover85 monitor --port /tmp/rover\n"
        "  rover85 board build/bin/rover85.hex --eeprom board.bin");
    command.callback(
        [options, &exit_code] { exit_code = guarded([&] { return run_board(*options); }); });
}
