// serial_port.hpp - a serial port of the PC: the ground's end of the rover's link.
// Depends on   POSIX termios.
// Opens        real ports (/dev/ttyUSB0) and pseudo-terminals alike; on the latter the baud rate
//              has no effect.
// Line         19,200 baud, 8 data bits, no parity, 1 stop bit, no handshake, every byte as it is.
#pragma once

#include <termios.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>

namespace host_sim {

/// A port that cannot be used, or no longer. One line: which port, what, what to do.
class SerialError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// An open port. One program at a time: others that ask, by flock or by opening it, are refused.
class SerialPort {
public:
    using Milliseconds = std::chrono::milliseconds;

    /// Opens the port and forgets what had arrived before.
    /// @errors  SerialError: not there, no permission, in use, or no serial port
    explicit SerialPort(const std::filesystem::path& path);
    /// Gives the port its old settings back.
    ~SerialPort();
    SerialPort(const SerialPort&) = delete;
    SerialPort& operator=(const SerialPort&) = delete;

    /// Waits for bytes.
    /// @param buffer   not empty
    /// @param timeout  0: only what is there already
    /// @return  how many bytes came, at least 1; 0: none within `timeout`, or a signal came
    /// @errors  SerialError: unplugged, or the other end of a pseudo-terminal is gone
    [[nodiscard]] std::size_t read(std::span<uint8_t> buffer, Milliseconds timeout);

    /// Hands all bytes to the system, which sends them one behind the other.
    /// @errors  SerialError: as read(), and when the port does not take them within `timeout`
    void write(std::span<const uint8_t> bytes, Milliseconds timeout);

    /// Waits until the last byte has been sent.
    /// @errors  as write()
    void drain(Milliseconds timeout);

    /// Forgets what has arrived and was not read. @errors as read()
    void discard_input();

    [[nodiscard]] const std::string& name() const { return name_; }

private:
    void claim();
    void configure();
    [[noreturn]] void fail(const std::string& what, const std::string& advice) const;
    [[noreturn]] void fail_transfer(int error) const;

    std::string name_;
    int descriptor_ = -1;
    bool exclusive_ = false;  ///< TIOCEXCL was set
    termios old_settings_{};
};

}  // namespace host_sim
