// The device's end of a pseudo-terminal, its other end opened by hand.
#include "host_sim/link/pseudo_terminal.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <chrono>
#include <thread>
#include <vector>

namespace {

using host_sim::PseudoTerminal;
using std::chrono::milliseconds;
using Bytes = std::vector<uint8_t>;

class User {
public:
    explicit User(const PseudoTerminal& terminal)
        : descriptor_(::open(terminal.path().c_str(), O_RDWR | O_NOCTTY)) {
        EXPECT_GE(descriptor_, 0);
    }
    ~User() { ::close(descriptor_); }
    User(const User&) = delete;
    User& operator=(const User&) = delete;
    void write(const Bytes& bytes) const {
        EXPECT_EQ(::write(descriptor_, bytes.data(), bytes.size()),
                  static_cast<ssize_t>(bytes.size()));
    }
    [[nodiscard]] Bytes read(std::size_t size) const {
        Bytes bytes(size);
        const ssize_t count = ::read(descriptor_, bytes.data(), size);
        bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
        return bytes;
    }
    [[nodiscard]] int descriptor() const { return descriptor_; }

private:
    int descriptor_;
};

Bytes read_when_there(PseudoTerminal& terminal) {
    return terminal.wait(milliseconds(2000)) ? terminal.read(100) : Bytes{};
}

TEST(PseudoTerminal, ControlCharactersPassAndNothingIsEchoed) {
    PseudoTerminal terminal;
    const User user(terminal);
    const Bytes control = {0x00, 0x03, 0x04, 0x0A, 0x0D, 0x11, 0x13, 0x1A, 0x7F, 0xFF};
    user.write(control);
    EXPECT_EQ(read_when_there(terminal), control);
    EXPECT_EQ(terminal.unread(), 0u) << "no echo";
    EXPECT_EQ(terminal.write(control), control.size());
    EXPECT_EQ(user.read(100), control);
}

TEST(PseudoTerminal, UsersComeAndGo) {
    PseudoTerminal terminal;
    for (const uint8_t value : {uint8_t{1}, uint8_t{2}}) {
        EXPECT_EQ(terminal.read(10), Bytes{}) << "nobody there is no error";
        const User user(terminal);
        user.write({value});
        EXPECT_EQ(read_when_there(terminal), Bytes{value});
    }
}

TEST(PseudoTerminal, WithoutAReaderAFewBytesWaitAndTheRestIsNotTaken) {
    PseudoTerminal terminal;
    // The system passes bytes on a moment later.
    const auto write = [&terminal](std::size_t count) {
        const std::size_t before = terminal.unread();
        const std::size_t taken = terminal.write(Bytes(count, 0x55));
        for (int i = 0; i < 2000 && terminal.unread() != before + taken; ++i) {
            std::this_thread::sleep_for(milliseconds(1));
        }
        return taken;
    };
    EXPECT_EQ(write(1000), 1000u);
    EXPECT_EQ(write(1000), 1000u);
    EXPECT_EQ(write(1000), PseudoTerminal::kUnreadMax - 2000);
    EXPECT_EQ(write(1000), 0u);
    EXPECT_EQ(terminal.unread(), PseudoTerminal::kUnreadMax);
    const User user(terminal);
    EXPECT_EQ(user.read(4096).size(), PseudoTerminal::kUnreadMax);
    EXPECT_EQ(write(1000), 1000u);
    ::tcflush(user.descriptor(), TCIFLUSH);
    EXPECT_EQ(terminal.unread(), 0u);
}

TEST(PseudoTerminal, WaitsNoLongerThanAsked) {
    const PseudoTerminal terminal;
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_FALSE(terminal.wait(milliseconds(20)));
    EXPECT_FALSE(terminal.wait(milliseconds(-1)));
    const auto took = std::chrono::steady_clock::now() - begin;
    EXPECT_GE(took, milliseconds(20));
    EXPECT_LT(took, milliseconds(1000));
}

}  // namespace
