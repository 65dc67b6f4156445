// display.cpp - see display.hpp.
#include "tools/monitor/display.hpp"

#include <fmt/format.h>

namespace monitor {
namespace {

// Without wrapping a line is a line, however narrow the terminal.
constexpr const char* kNoWrap = "\033[?7l";
constexpr const char* kWrap = "\033[?7h";

}  // namespace

Display::Display(std::ostream& out, bool in_place) : out_(out), in_place_(in_place) {
    if (in_place_) out_ << kNoWrap << std::flush;
}

Display::~Display() {
    if (in_place_) out_ << kWrap << std::flush;
}

void Display::show(const Known& known, const std::string& line) {
    if (!in_place_) {
        out_ << line << std::endl;
        return;
    }
    erase();
    block_ = screen(known);
    draw();
}

void Display::note(const std::string& line) {
    erase();
    out_ << line << "\n";
    draw();
}

/// To the beginning of the first line drawn, and everything from there on away.
void Display::erase() {
    if (drawn_ != 0) out_ << fmt::format("\033[{}F\033[J", drawn_);
    drawn_ = 0;
}

void Display::draw() {
    for (const std::string& line : block_) out_ << line << "\n";
    drawn_ = block_.size();
    out_ << std::flush;
}

}  // namespace monitor
