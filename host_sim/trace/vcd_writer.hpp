// vcd_writer.hpp - signals over time as a Value Change Dump, for GTKWave and others.
// Depends on   the standard library, POSIX files and signals.
// Source       IEEE 1364-2005, clause 18 (four-state VCD).
// Bounds       one thread writes; flush_vcd_on_signals covers the writers of that thread.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace host_sim {

/// A VCD file that cannot be written. "file: what: why".
class VcdError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The nanosecond nearest to the beginning of T-state `t` of a clock of `clock_hz`; exact, halves
/// up. @param clock_hz  1 to 10^9
[[nodiscard]] constexpr uint64_t ns_from_t(uint64_t t, uint64_t clock_hz) {
    constexpr uint64_t kNsPerSecond = 1'000'000'000;
    return t / clock_hz * kNsPerSecond + (t % clock_hz * kNsPerSecond + clock_hz / 2) / clock_hz;
}

/// Writes one VCD file: first all signals are added, then changes come in the order of time.
class VcdWriter {
public:
    using Signal = std::size_t;

    /// Creates or empties the file.
    /// @param clock_hz  of the T-states, 1 to 10^9
    /// @errors  VcdError; std::invalid_argument for the clock
    VcdWriter(const std::filesystem::path& path, uint64_t clock_hz);
    ~VcdWriter();  ///< close(), without its errors
    VcdWriter(const VcdWriter&) = delete;
    VcdWriter& operator=(const VcdWriter&) = delete;

    /// @param scope    module path with dots, as "board.uart"; empty: no module
    /// @param name     without spaces
    /// @param width    bits, 1 to 64
    /// @param initial  value until the first change; nothing: unknown (x)
    /// @errors  std::invalid_argument; std::logic_error after the first change
    Signal add_signal(std::string_view scope, std::string_view name, unsigned width,
                      std::optional<uint64_t> initial = {});

    /// Gives a signal a value from the beginning of T-state `t` on. An unchanged value is no event.
    /// @errors  std::logic_error when time goes back or the file is closed; VcdError
    void change(Signal signal, uint64_t value, uint64_t t);

    /// Hands all records to the operating system. @errors VcdError
    void flush();

    /// Completes the file: with a last time mark, so that a viewer shows the time up to `end_t`.
    /// @errors  VcdError; the file is then closed as well
    void close(std::optional<uint64_t> end_t = {});

    /// Writes what is complete and not yet written. Async-signal-safe.
    void emergency_flush() noexcept;

private:
    friend void flush_all_vcd() noexcept;
    struct Line {
        std::string scope;
        std::string name;
        unsigned width;
        std::optional<uint64_t> value;
    };
    static constexpr std::size_t kBufferSize = 65536;

    void begin();
    void append(std::string_view record);
    void stamp(uint64_t t);
    void write_pending(bool& failed, int& error) noexcept;
    [[noreturn]] void fail(std::string_view what, int error) const;

    std::filesystem::path path_;
    uint64_t clock_hz_;
    int descriptor_ = -1;
    bool begun_ = false;
    uint64_t last_ns_ = 0;
    uint64_t last_t_ = 0;
    std::vector<Line> signals_;
    std::string record_;
    std::vector<char> buffer_ = std::vector<char>(kBufferSize);
    // buffer_[written_, complete_) are whole records that wait; a signal handler may look at them
    // at any time.
    std::atomic<std::size_t> written_ = 0;
    std::atomic<std::size_t> complete_ = 0;
    std::atomic<VcdWriter*> next_ = nullptr;  ///< of all open writers
};

/// From now on SIGINT and SIGTERM first bring all open VCD files up to their last record, then do
/// what they did before by default: end the process. A program with handlers of its own calls
/// flush_all_vcd() in them instead.
void flush_vcd_on_signals();

/// Brings all open VCD files up to their last record. Async-signal-safe.
void flush_all_vcd() noexcept;

}  // namespace host_sim
