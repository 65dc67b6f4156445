// flash_link.cpp - see flash_link.hpp.
#include "tools/rover85/flash_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <memory>
#include <vector>

#include "host_sim/bind/flasher.hpp"
#include "host_sim/bind/port_line.hpp"
#include "host_sim/image/eeprom.hpp"
#include "host_sim/link/live_board.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/progress_bar.hpp"

namespace {

namespace fs = std::filesystem;
namespace layout = rover::loader;
using host_sim::LoaderClient;
using std::chrono::milliseconds;

constexpr milliseconds kImageAnswers{400};
constexpr unsigned kLookTries = 4;
constexpr unsigned kStartTries = 20;  // a cold start takes 1.3 s

void say(const char* what, const std::string& text) {
    std::cout << fmt::format("{:<9} {}\n", what, text) << std::flush;
}

/// Shows the bar of one activity after another.
class Bars {
public:
    void operator()(const host_sim::FlashProgress& progress) {
        if (what_ != progress.what) {
            bar_.reset();
            bar_ = std::make_unique<ProgressBar>(progress.what);
            what_ = progress.what;
        }
        if (progress.all == 0) return;
        bar_->update(static_cast<double>(progress.done) / static_cast<double>(progress.all));
    }
    void end() {
        bar_.reset();
        what_.clear();
    }

private:
    std::unique_ptr<ProgressBar> bar_;
    std::string what_;
};

host_sim::LoaderHello reach(LoaderClient& client, const LinkFlash& options) {
    return client.reach(std::chrono::seconds(options.patience_s), [&] {
        std::cerr << fmt::format(
            "rover85: no answer yet; press RESET on the board (waiting {} s)\n",
            options.patience_s);
    });
}

/// Reports how the board's EEPROM compares.
int verify(LoaderClient& client, const host_sim::Image& image, std::size_t pages) {
    Bars bars;
    const auto report = host_sim::verify_over_link(client, image, std::ref(bars));
    bars.end();
    if (!report) {
        say("verified", fmt::format("all {} pages", pages));
        return kExitPass;
    }
    say("DIFFERS",
        fmt::format("first wrong address {:04X}H: {:02X}H instead of {:02X}H; {} bytes in {} pages "
                    "are wrong; likely cause: {}",
                    report->first, report->found, report->expected, report->count, report->pages,
                    report->likely_cause));
    return kExitDifference;
}

/// What is there, without touching anything.
int look(LoaderClient& client) {
    for (unsigned i = 0; i < kLookTries; ++i) {
        const auto running = client.ask_image(kImageAnswers);
        if (!running) continue;
        say("before", host_sim::describe(*running) + ", running");
        say("dry run", "the board was left alone");
        return kExitPass;
    }
    try {
        const auto hello = client.reach(milliseconds(500));
        say("before", hello.identity ? host_sim::describe(*hello.identity) + ", in the loader"
                                     : "no bootable image, the loader waits");
    } catch (const host_sim::LoaderError&) {
        say("before", "nobody answers; press RESET when the image is really sent");
    }
    say("dry run", "nothing was written");
    return kExitPass;
}

int start(LoaderClient& client, const host_sim::ImageIdentity& identity) {
    if (client.start().result != layout::Result::done) {
        say("FAILED", "the loader refuses to start the image");
        return kExitDifference;
    }
    for (unsigned i = 0; i < kStartTries; ++i) {
        const auto running = client.ask_image(kImageAnswers);
        if (!running) continue;
        say("after", host_sim::describe(*running) + ", running");
        return running->image_crc == identity.image_crc ? kExitPass : kExitDifference;
    }
    say("FAILED",
        "the image was written and verified, but does not answer; press RESET, and look "
        "at its telemetry with `rover85 monitor`");
    return kExitDifference;
}

int write(LoaderClient& client, const host_sim::Image& image, const LinkFlash& options) {
    Bars bars;
    host_sim::FlashOptions how;
    how.keep_other_vehicles = !options.any_vehicle;
    how.write_all = options.write_all;
    how.progress = std::ref(bars);
    how.lost = [&] {
        bars.end();
        std::cerr << "rover85: the board was reset or the line broke; going on when it answers\n";
        reach(client, options);
        return true;
    };
    const auto began = std::chrono::steady_clock::now();
    const auto result = host_sim::flash_over_link(client, image, how);
    bars.end();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    std::string text =
        fmt::format("{} of {} pages in {:.1f} s", result.pages_written, result.pages, took.count());
    if (result.was_bootable_already) text = "nothing: the board has this image already";
    if (result.resumed != 0) text += fmt::format(", resumed {} times", result.resumed);
    if (client.repeated() != 0) text += fmt::format(", {} requests repeated", client.repeated());
    say("written", text);
    return verify(client, image, result.pages);
}

int flash(LoaderClient& client, const host_sim::Image& image, const LinkFlash& options) {
    if (options.dry_run) return look(client);
    const auto identity = host_sim::read_identity(image);
    const auto hello = reach(client, options);
    say("before", hello.identity ? host_sim::describe(*hello.identity) : "no bootable image");
    int exit_code = kExitPass;
    if (options.verify_only) {
        exit_code = verify(client, image,
                           host_sim::application_pages(image, identity).size() / layout::kPageSize);
    } else {
        exit_code = write(client, image, options);
    }
    if (exit_code != kExitPass || options.stay) return exit_code;
    if (!client.hello().bootable) return exit_code;
    return start(client, identity);
}

// -- The simulated board -------------------------------------------------------------------------

/// The content its EEPROM begins with: the file's, or what a programmer would leave: the loader.
std::vector<uint8_t> first_content(const host_sim::Image& image, const fs::path& file) {
    constexpr std::size_t kSize = hal::rb85::kEepromLast + 1;
    if (fs::exists(file)) {
        const std::string text = host_sim::read_image_file(file);
        if (text.size() != kSize) {
            throw host_sim::ImageError(
                file.string(), 0, fmt::format("has {} bytes, an EEPROM {}", text.size(), kSize),
                "give a file that flash has written, or a new name");
        }
        return {text.begin(), text.end()};
    }
    if (!image.present[0]) {
        throw host_sim::ImageError(image.file, 0, "has no loader for a new board",
                                   "give an image that the build has made");
    }
    std::vector<uint8_t> content(kSize, host_sim::kErasedByte);
    std::copy_n(image.bytes.begin(), layout::kLoaderLast + 1, content.begin());
    return content;
}

void write_content(const fs::path& file, const uint8_t* content) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    for (std::size_t at = 0; at <= hal::rb85::kEepromLast; ++at) {
        stream.put(static_cast<char>(content[at]));
    }
    stream.close();
    if (stream) return;
    throw host_sim::ImageError(file.string(), 0, "cannot be written",
                               "check path, permissions and space");
}

}  // namespace

std::string only_serial_port(const fs::path& devices) {
    std::vector<std::string> ports;
    for (const auto& entry : fs::directory_iterator(devices)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("ttyUSB") || name.starts_with("ttyACM")) {
            ports.push_back(entry.path().string());
        }
    }
    if (ports.size() == 1) return ports[0];
    if (ports.empty()) {
        throw host_sim::SerialError(fmt::format(
            "{}: no ttyUSB or ttyACM is there; plug the adapter in, or name the port with --port",
            devices.string()));
    }
    std::ranges::sort(ports);
    throw host_sim::SerialError(
        fmt::format("{}: there are several serial ports; choose one: "
                    "--port {}",
                    devices.string(), fmt::join(ports, ", ")));
}

int flash_serial(const host_sim::Image& image, const LinkFlash& options) {
    const std::string path = options.port.empty() ? only_serial_port() : options.port;
    say("port", path + ", 19,200 baud");
    host_sim::SerialPort port(path);
    LoaderClient client(host_sim::line_of(port));
    return flash(client, image, options);
}

int flash_board(const host_sim::Image& image, const LinkFlash& options) {
    host_sim::LiveBoard live(host_sim::BoardOptions{}, host_sim::Pace::eager);
    live.board().program(first_content(image, options.eeprom));
    say("board", fmt::format("simulated, its line is {}", live.path().string()));
    live.start();
    int exit_code = kExitPass;
    {
        host_sim::SerialPort port(live.path());
        LoaderClient client(host_sim::line_of(port));
        exit_code = flash(client, image, options);
    }
    live.stop();
    if (options.dry_run || options.verify_only) return exit_code;
    write_content(options.eeprom, live.board().state.eeprom.data());
    say("kept", options.eeprom);
    return exit_code;
}
