// serial_port.cpp - see serial_port.hpp.
#include "host_sim/link/serial_port.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

namespace host_sim {
namespace {

using Clock = std::chrono::steady_clock;
using Milliseconds = SerialPort::Milliseconds;

constexpr const char* kUnplugged =
    "plug it in again (a USB adapter may come back under another name) and repeat";

/// Slaves of Unix98 pseudo-terminals (Linux, Documentation/admin-guide/devices.txt).
bool is_pseudo_terminal(int descriptor) {
    struct stat status = {};
    if (::fstat(descriptor, &status) != 0) return false;
    return major(status.st_rdev) >= 136 && major(status.st_rdev) <= 143;
}

std::string advice_on_opening(int error) {
    switch (error) {
        case ENOENT:
        case ENOTDIR:
            return "check the name and the plug; `ls /dev/serial/by-id` lists USB adapters";
        case EACCES:
        case EPERM:
            return "join the group of the port (`sudo usermod -aG dialout $USER`) and log in again";
        case EBUSY:
            return "end the program that has it open; `fuser -v` with the port's name shows it";
        case ENXIO:
        case ENODEV:
        case EIO:
            return "there is no hardware behind this name; choose another port";
        default:
            return "check the name and the adapter";
    }
}

/// Waits until the descriptor is ready. @return false: not by `deadline`, or a signal came
bool wait_for(int descriptor, short events, Clock::time_point deadline) {
    pollfd request{descriptor, events, 0};
    const auto left = std::chrono::ceil<Milliseconds>(deadline - Clock::now());
    const auto timeout = static_cast<int>(std::max(left, Milliseconds(0)).count());
    return ::poll(&request, 1, timeout) > 0;
}

}  // namespace

SerialPort::SerialPort(const std::filesystem::path& path) : name_(path.string()) {
    // Without O_NONBLOCK the open itself would wait for a modem's carrier.
    descriptor_ = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) {
        const int error = errno;
        fail(fmt::format("cannot be opened: {}", std::strerror(error)), advice_on_opening(error));
    }
    try {
        claim();
        configure();
        discard_input();
    } catch (...) {
        if (exclusive_) ::ioctl(descriptor_, TIOCNXCL);
        ::close(descriptor_);
        throw;
    }
}

SerialPort::~SerialPort() {
    ::tcsetattr(descriptor_, TCSANOW, &old_settings_);
    if (exclusive_) ::ioctl(descriptor_, TIOCNXCL);
    ::close(descriptor_);
}

/// flock keeps out programs that ask for it; TIOCEXCL all others. Not on a pseudo-terminal, where
/// the mark would stay when this program is killed: its other end keeps the terminal alive.
void SerialPort::claim() {
    if (::isatty(descriptor_) == 0 && errno != EIO) {
        fail("is not a serial port", "name a device such as /dev/ttyUSB0");
    }
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
        fail("is in use by another program", advice_on_opening(EBUSY));
    }
    if (is_pseudo_terminal(descriptor_)) return;
    exclusive_ = ::ioctl(descriptor_, TIOCEXCL) == 0;
}

void SerialPort::configure() {
    if (::tcgetattr(descriptor_, &old_settings_) != 0) {
        const int error = errno;
        fail(fmt::format("has no settings: {}", std::strerror(error)), advice_on_opening(error));
    }
    termios settings = old_settings_;
    ::cfmakeraw(&settings);
    settings.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | CRTSCTS);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cc[VMIN] = 1;
    settings.c_cc[VTIME] = 0;
    ::cfsetspeed(&settings, B19200);
    if (::tcsetattr(descriptor_, TCSANOW, &settings) != 0) {
        const int error = errno;
        fail(fmt::format("does not take 19,200 baud, 8N1: {}", std::strerror(error)),
             "use another adapter");
    }
}

std::size_t SerialPort::read(std::span<uint8_t> buffer, Milliseconds timeout) {
    const Clock::time_point deadline = Clock::now() + timeout;
    if (!wait_for(descriptor_, POLLIN, deadline)) return 0;
    const ssize_t count = ::read(descriptor_, buffer.data(), buffer.size());
    if (count > 0) return static_cast<std::size_t>(count);
    // poll said that there is something: an end of file is a line that was hung up.
    if (count == 0) fail_transfer(EIO);
    if (errno == EAGAIN || errno == EINTR) return 0;
    fail_transfer(errno);
}

void SerialPort::write(std::span<const uint8_t> bytes, Milliseconds timeout) {
    const Clock::time_point deadline = Clock::now() + timeout;
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
        if (count >= 0) {
            done += static_cast<std::size_t>(count);
            continue;
        }
        if (errno != EAGAIN && errno != EINTR) fail_transfer(errno);
        wait_for(descriptor_, POLLOUT, deadline);
        if (Clock::now() >= deadline) {
            fail(fmt::format("took {} of {} bytes within {} ms", done, bytes.size(),
                             timeout.count()),
                 "check that nothing holds the line (handshake, XOFF)");
        }
    }
}

/// tcdrain alone could wait for ever; it comes last, for what is in the adapter itself.
void SerialPort::drain(Milliseconds timeout) {
    const Clock::time_point deadline = Clock::now() + timeout;
    for (int waiting = 0;;) {
        if (::ioctl(descriptor_, TIOCOUTQ, &waiting) != 0) fail_transfer(errno);
        if (waiting == 0) break;
        if (Clock::now() >= deadline) {
            fail(fmt::format("has {} bytes still to send after {} ms", waiting, timeout.count()),
                 "check that nothing holds the line (handshake, XOFF)");
        }
        std::this_thread::sleep_for(Milliseconds(1));
    }
    while (::tcdrain(descriptor_) != 0) {
        if (errno != EINTR) fail_transfer(errno);
    }
}

void SerialPort::discard_input() {
    ::tcflush(descriptor_, TCIFLUSH);
    // What the system had not yet passed on comes behind the flush.
    std::array<uint8_t, 4096> gone{};
    constexpr int kRoundsMax = 64;  // against a sender that never pauses
    for (int round = 0; round < kRoundsMax && read(gone, Milliseconds(0)) != 0; ++round) {
    }
}

void SerialPort::fail(const std::string& what, const std::string& advice) const {
    throw SerialError(fmt::format("{}: {}; {}", name_, what, advice));
}

void SerialPort::fail_transfer(int error) const {
    const bool gone = error == EIO || error == ENXIO || error == ENODEV || error == EBADF;
    if (gone) fail("is gone: unplugged, or the simulated board has ended", kUnplugged);
    fail(fmt::format("failed: {}", std::strerror(error)), kUnplugged);
}

}  // namespace host_sim
