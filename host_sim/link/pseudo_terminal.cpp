// pseudo_terminal.cpp - see pseudo_terminal.hpp.
#include "host_sim/link/pseudo_terminal.hpp"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <ctime>
#include <system_error>

namespace host_sim {
namespace {

void check(bool good, const char* what) {
    if (!good) throw std::system_error(errno, std::generic_category(), what);
}

}  // namespace

PseudoTerminal::PseudoTerminal() {
    try {
        device_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
        check(device_ >= 0, "no pseudo-terminal");
        check(::grantpt(device_) == 0 && ::unlockpt(device_) == 0, "pseudo-terminal locked");
        std::array<char, 64> name{};
        check(::ptsname_r(device_, name.data(), name.size()) == 0, "pseudo-terminal has no name");
        path_ = name.data();
        other_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
        check(other_ >= 0, "pseudo-terminal cannot be opened");
        termios settings{};
        check(::tcgetattr(other_, &settings) == 0, "pseudo-terminal has no settings");
        ::cfmakeraw(&settings);
        check(::tcsetattr(other_, TCSANOW, &settings) == 0, "pseudo-terminal cannot be set");
        check(::fcntl(device_, F_SETFL, O_NONBLOCK) == 0, "pseudo-terminal cannot be set");
    } catch (...) {
        if (other_ >= 0) ::close(other_);
        if (device_ >= 0) ::close(device_);
        throw;
    }
}

PseudoTerminal::~PseudoTerminal() {
    ::close(other_);
    ::close(device_);
}

std::vector<uint8_t> PseudoTerminal::read(std::size_t count_max) {
    std::vector<uint8_t> bytes(count_max);
    const ssize_t count = count_max == 0 ? 0 : ::read(device_, bytes.data(), bytes.size());
    bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return bytes;
}

std::size_t PseudoTerminal::write(std::span<const uint8_t> bytes) {
    const std::size_t waiting = unread();
    const std::size_t room = waiting < kUnreadMax ? kUnreadMax - waiting : 0;
    const ssize_t count = ::write(device_, bytes.data(), std::min(room, bytes.size()));
    return count > 0 ? static_cast<std::size_t>(count) : 0;
}

std::size_t PseudoTerminal::unread() const {
    int count = 0;
    return ::ioctl(other_, FIONREAD, &count) == 0 ? static_cast<std::size_t>(count) : 0;
}

bool PseudoTerminal::wait(std::chrono::nanoseconds timeout) const {
    constexpr int64_t kNsPerS = 1'000'000'000;
    const int64_t wait_ns = std::max<int64_t>(timeout.count(), 0);
    const timespec limit{wait_ns / kNsPerS, wait_ns % kNsPerS};
    pollfd request{device_, POLLIN, 0};
    return ::ppoll(&request, 1, &limit, nullptr) > 0;
}

}  // namespace host_sim
