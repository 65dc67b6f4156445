// serial_display.hpp - what the board sends on its serial line, as lines for people.
// Depends on   host_sim/chips/i8251a.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host_sim/chips/i8251a.hpp"

namespace debug_console {

/// Collects characters and shows them line by line: `serial T 1234: "OK\n"`, or in hexadecimal.
/// The time is the beginning of the first character's start bit. What is shown does not depend on
/// how often it is fed.
class SerialDisplay {
public:
    enum class Mode : uint8_t { text, hex, off };
    using Write = std::function<void(std::string_view)>;

    static constexpr std::size_t kTextBytesMax = 64;  ///< longer lines are cut in pieces
    static constexpr std::size_t kHexBytesMax = 16;

    explicit SerialDisplay(Write write) : write_(std::move(write)) {}

    void set_mode(Mode mode) { mode_ = mode; }
    [[nodiscard]] Mode mode() const { return mode_; }

    /// Takes characters and shows the lines that are whole.
    void add(const std::vector<host_sim::chips::I8251a::TransmittedByte>& characters);
    /// Shows the rest.
    void flush();

private:
    Write write_;
    Mode mode_ = Mode::text;
    std::string pending_;
    uint64_t pending_t_ = 0;
};

}  // namespace debug_console
