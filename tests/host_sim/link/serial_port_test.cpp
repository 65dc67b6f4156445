// The serial port against a pseudo-terminal; settings and exclusive use read back from the system.
#include "host_sim/link/serial_port.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <numeric>
#include <thread>
#include <vector>

#include "host_sim/link/pseudo_terminal.hpp"

namespace {

using host_sim::PseudoTerminal;
using host_sim::SerialError;
using host_sim::SerialPort;
using std::chrono::milliseconds;
using testing::HasSubstr;
using testing::StartsWith;
using Bytes = std::vector<uint8_t>;

constexpr milliseconds kSoon{2000};

Bytes all_values() {
    Bytes bytes(256);
    std::iota(bytes.begin(), bytes.end(), uint8_t{0});
    return bytes;
}

Bytes read_count(SerialPort& port, std::size_t count) {
    Bytes bytes(count);
    std::size_t done = 0;
    while (done < count) {
        const std::size_t more = port.read(std::span(bytes).subspan(done), kSoon);
        if (more == 0) break;
        done += more;
    }
    bytes.resize(done);
    return bytes;
}

Bytes read_count(PseudoTerminal& terminal, std::size_t count) {
    Bytes bytes;
    while (bytes.size() < count && terminal.wait(kSoon)) {
        const Bytes more = terminal.read(count - bytes.size());
        bytes.insert(bytes.end(), more.begin(), more.end());
    }
    return bytes;
}

std::string refusal(const std::string& path) {
    try {
        const SerialPort port(path);
    } catch (const SerialError& error) {
        return error.what();
    }
    return "accepted";
}

/// A second look at the terminal, past the port.
class Look {
public:
    explicit Look(const PseudoTerminal& terminal)
        : descriptor_(::open(terminal.path().c_str(), O_RDWR | O_NOCTTY)) {}
    ~Look() { ::close(descriptor_); }
    Look(const Look&) = delete;
    Look& operator=(const Look&) = delete;
    [[nodiscard]] termios settings() const {
        termios read{};
        EXPECT_EQ(::tcgetattr(descriptor_, &read), 0);
        return read;
    }
    void set(const termios& settings) const {
        EXPECT_EQ(::tcsetattr(descriptor_, TCSANOW, &settings), 0);
    }

private:
    int descriptor_;
};

TEST(SerialPort, PassesEveryByteBothWays) {
    PseudoTerminal terminal;
    SerialPort port(terminal.path());
    port.write(all_values(), kSoon);
    port.drain(kSoon);
    EXPECT_EQ(read_count(terminal, 256), all_values());
    EXPECT_EQ(terminal.write(all_values()), 256u);
    EXPECT_EQ(read_count(port, 256), all_values());
}

TEST(SerialPort, ReadsNothingWhenNothingComesInTime) {
    const PseudoTerminal terminal;
    SerialPort port(terminal.path());
    Bytes buffer(8);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(port.read(buffer, milliseconds(0)), 0u);
    EXPECT_EQ(port.read(buffer, milliseconds(50)), 0u);
    EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(50));
}

TEST(SerialPort, SetsTheLineAndGivesItsOldSettingsBack) {
    const PseudoTerminal terminal;
    const Look look(terminal);
    termios before = look.settings();
    before.c_lflag |= ECHO | ICANON;
    before.c_cflag |= CSTOPB | PARENB;
    ::cfsetspeed(&before, B9600);
    look.set(before);
    {
        const SerialPort port(terminal.path());
        const termios during = look.settings();
        EXPECT_EQ(::cfgetispeed(&during), static_cast<speed_t>(B19200));
        EXPECT_EQ(::cfgetospeed(&during), static_cast<speed_t>(B19200));
        // CRTSCTS and PARENB are not compared: Linux forces them off, CS8 on, on such terminals.
        EXPECT_EQ(during.c_cflag & (CSIZE | CSTOPB), static_cast<tcflag_t>(CS8));
        EXPECT_EQ(during.c_lflag & (ECHO | ICANON | ISIG | IEXTEN), 0u);
        EXPECT_EQ(during.c_iflag & (IXON | ICRNL | INLCR | IGNCR | ISTRIP | PARMRK), 0u);
        EXPECT_EQ(during.c_oflag & OPOST, 0u);
    }
    const termios after = look.settings();
    EXPECT_EQ(after.c_lflag & (ECHO | ICANON), static_cast<tcflag_t>(ECHO | ICANON));
    EXPECT_EQ(::cfgetospeed(&after), static_cast<speed_t>(B9600));
}

TEST(SerialPort, ForgetsWhatHadArrivedBefore) {
    PseudoTerminal terminal;
    terminal.write(Bytes{1, 2, 3});
    SerialPort port(terminal.path());
    Bytes buffer(8);
    EXPECT_EQ(port.read(buffer, milliseconds(20)), 0u);
    terminal.write(Bytes{4});
    port.discard_input();
    terminal.write(Bytes{5});
    EXPECT_EQ(read_count(port, 1), Bytes{5});
}

TEST(SerialPort, BelongsToOneProgramAtATime) {
    const PseudoTerminal terminal;
    {
        const SerialPort port(terminal.path());
        EXPECT_THAT(refusal(terminal.path()), HasSubstr("is in use by another program; end"));
    }
    EXPECT_EQ(refusal(terminal.path()), "accepted");
}

TEST(SerialPort, WhatIsNoPortIsNamedWithAdvice) {
    EXPECT_THAT(refusal("/dev/ttyNone7"), StartsWith("/dev/ttyNone7: cannot be opened: No such"));
    EXPECT_THAT(refusal("/dev/ttyNone7"), HasSubstr("/dev/serial/by-id"));
    EXPECT_EQ(refusal("/dev/null"),
              "/dev/null: is not a serial port; name a device such as /dev/ttyUSB0");
}

TEST(SerialPort, WithoutPermissionTheGroupIsNamed) {
    const PseudoTerminal terminal;
    ASSERT_EQ(::chmod(terminal.path().c_str(), 0), 0);
    // Root may open everything, so the test is somebody else meanwhile.
    constexpr uid_t kNobody = 65534;
    const bool root = ::geteuid() == 0;
    ASSERT_EQ(root ? ::seteuid(kNobody) : 0, 0);
    const std::string text = refusal(terminal.path());
    ASSERT_EQ(root ? ::seteuid(0) : 0, 0);
    ASSERT_EQ(::prctl(PR_SET_DUMPABLE, 1), 0);  // the change took it, the leak check needs it
    EXPECT_THAT(text, HasSubstr("usermod -aG dialout"));
}

TEST(SerialPort, APortThatGoesAwayIsSaid) {
    auto terminal = std::make_unique<PseudoTerminal>();
    SerialPort port(terminal->path());
    terminal.reset();
    Bytes buffer(8);
    EXPECT_THROW((void)port.read(buffer, kSoon), SerialError);
    try {
        port.write(all_values(), kSoon);
        FAIL() << "written to nobody";
    } catch (const SerialError& error) {
        EXPECT_THAT(error.what(), HasSubstr(port.name() + ": is gone: unplugged"));
    }
}

TEST(SerialPort, AReadThatWaitsHearsThatThePortIsGone) {
    auto terminal = std::make_unique<PseudoTerminal>();
    SerialPort port(terminal->path());
    std::thread unplug([&terminal] {
        std::this_thread::sleep_for(milliseconds(50));
        terminal.reset();
    });
    Bytes buffer(8);
    EXPECT_THROW((void)port.read(buffer, std::chrono::seconds(30)), SerialError);
    unplug.join();
}

TEST(SerialPort, WritingToAPortThatTakesNothingEndsInTime) {
    const PseudoTerminal terminal;  // nobody reads its other end
    SerialPort port(terminal.path());
    const Bytes much(1'000'000);
    const auto begin = std::chrono::steady_clock::now();
    try {
        port.write(much, milliseconds(100));
        FAIL() << "a megabyte was taken";
    } catch (const SerialError& error) {
        EXPECT_THAT(error.what(), HasSubstr(" of 1000000 bytes within 100 ms"));
    }
    EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(100));
    EXPECT_LT(std::chrono::steady_clock::now() - begin, kSoon);
}

}  // namespace
