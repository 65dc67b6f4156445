// pseudo_terminal.hpp - the device's end of a serial line that exists only on this PC.
// Depends on   POSIX pseudo-terminals; FIONREAD of Linux.
// The other end has a name that any program opens like a serial port, closes, and opens again. It
//              passes every byte as it is, from the start.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace host_sim {

class PseudoTerminal {
public:
    /// As many bytes wait for a reader as a PC's serial driver keeps about.
    static constexpr std::size_t kUnreadMax = 2048;

    /// @errors  std::system_error: the system has no more of them
    PseudoTerminal();
    ~PseudoTerminal();
    PseudoTerminal(const PseudoTerminal&) = delete;
    PseudoTerminal& operator=(const PseudoTerminal&) = delete;

    /// What others open.
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Bytes that others have sent, at most `count_max` of them; does not wait.
    [[nodiscard]] std::vector<uint8_t> read(std::size_t count_max);

    /// Sends bytes; does not wait.
    /// @return  how many; the rest found no room, because nobody reads
    std::size_t write(std::span<const uint8_t> bytes);

    /// Bytes sent that nobody has read yet.
    [[nodiscard]] std::size_t unread() const;

    /// Waits for bytes to read. @return true: there are some; false: not within `timeout`
    [[nodiscard]] bool wait(std::chrono::nanoseconds timeout) const;

private:
    int device_ = -1;  ///< ours
    int other_ = -1;   ///< kept open: between two users the line stays up
    std::filesystem::path path_;
};

}  // namespace host_sim
