#include "tools/rover85/progress_bar.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

ProgressBar::ProgressBar(std::string label)
    : label_(std::move(label)), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
    if (terminal_ && drawn_percent_ >= 0) std::fputs("\r\033[K", stderr);
}

void ProgressBar::update(double share) {
    const int percent = static_cast<int>(share * 100);
    if (!terminal_ || percent == drawn_percent_) return;
    drawn_percent_ = percent;
    const auto filled = static_cast<std::size_t>(percent) * 30 / 100;
    fmt::print(stderr, "\r{} [{:<30}] {:3d} %", label_, std::string(filled, '='), percent);
    std::fflush(stderr);
}
