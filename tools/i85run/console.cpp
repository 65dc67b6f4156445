#include "tools/i85run/console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace i85run {
namespace {

constexpr double kClockHz = 3.072e6;

}  // namespace

Console::Console() : terminal_(isatty(STDERR_FILENO) == 1) {}

CpmConsole Console::for_cpm() {
    CpmConsole console;
    console.put = [this](char character) { put(character); };
    console.get = [this] {
        std::fflush(stdout);
        clear_progress();
        const int key = std::getchar();
        return key == '\n' ? '\r' : key;
    };
    console.echo = isatty(STDIN_FILENO) != 1;  // a terminal shows keys by itself
    console.warn = [this](const std::string& line) { warn(line); };
    return console;
}

void Console::put(char character) {
    clear_progress();
    std::putchar(character);
    at_line_start_ = character == '\n';
}

void Console::warn(const std::string& line) {
    finish();
    fmt::print(stderr, "i85run: {}\n", line);
}

void Console::update(const Machine& machine) {
    std::fflush(stdout);
    const Clock::time_point now = Clock::now();
    const std::chrono::duration<double> passed = now - shown_at_;
    if (!terminal_ || passed.count() < 1.0) return;
    const auto executed = static_cast<double>(machine.cpu.instructions - shown_instructions_);
    // Save cursor, print, restore: the program's own line goes on where it was.
    fmt::print(stderr, "\0337\033[K [{:.1f} s at 3.072 MHz, {:.0f} MIPS]\0338",
               static_cast<double>(machine.cpu.t) / kClockHz, executed / passed.count() / 1e6);
    std::fflush(stderr);
    progress_shown_ = true;
    shown_at_ = now;
    shown_instructions_ = machine.cpu.instructions;
}

void Console::clear_progress() {
    if (!progress_shown_) return;
    std::fputs("\033[K", stderr);
    std::fflush(stderr);
    progress_shown_ = false;
}

void Console::finish() {
    clear_progress();
    if (!at_line_start_) std::putchar('\n');
    at_line_start_ = true;
    std::fflush(stdout);
}

}  // namespace i85run
