// at28c256.hpp - AT28C256 32 KB parallel EEPROM: page load, write cycle, polling, data protection.
// Source       Atmel AT28C256 data sheet; Atmel application note 0544, Software Chip Erase.
// Depends on   host_sim/chips/chip.hpp.
// Modelled     the time between loads, the write and erase cycle, both polling bits, the command
//              sequences, the start-up delay, a power failure in the middle of a cycle.
// Not modelled wear (cycles are only counted), access times, the identification page at high
// voltage. Page         docs/chips/at28c256.md says which statement is the data sheet's and which a
// choice.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

/// The EEPROM and its contents. Programming starts when no byte has come for the load time.
struct At28c256 {
    static constexpr uint32_t kSize = 32768;
    static constexpr uint32_t kPageSize = 64;
    static constexpr uint32_t kPageCount = kSize / kPageSize;

    static constexpr uint64_t kLoadTimeNs = 150'000;        ///< tBLC, maximum
    static constexpr uint64_t kWriteCycleNs = 10'000'000;   ///< tWC, maximum
    static constexpr uint64_t kEraseCycleNs = 20'000'000;   ///< tEC, maximum
    static constexpr uint64_t kPowerOnDelayNs = 5'000'000;  ///< before the first write, typical

    /// An erased part, unprotected and powered for long.
    /// @param clock_hz        frequency of the T-states
    /// @param write_cycle_ns  duration of the internal write cycle; the default is the maximum
    explicit At28c256(uint64_t clock_hz, uint64_t write_cycle_ns = kWriteCycleNs);

    /// Programs `bytes` from `address` on by an outside programmer, in no time and past all
    /// protection. A cycle in progress is dropped. @errors std::length_error when they do not fit
    void load(std::span<const uint8_t> bytes, uint16_t address = 0);

    /// The part has no RESET pin: a cycle in progress goes on.
    void reset() {}
    /// The supply fails: what was being programmed is left half done, see the page.
    void power_off(uint64_t now_t);
    /// The supply is back: writes are ignored for kPowerOnDelayNs.
    void power_on(uint64_t now_t);

    /// A bus read; during load and write cycle it yields the polling byte, whatever the address.
    uint8_t read(uint16_t address, uint64_t now_t);
    void write(uint16_t address, uint8_t value, uint64_t now_t);
    void advance(uint64_t now_t);
    /// End of the cycle in progress, if no further byte is loaded.
    [[nodiscard]] uint64_t next_event_t() const { return active ? cycle_end_t : kNever; }

    /// Reads yield the polling byte at `now_t`.
    [[nodiscard]] bool busy(uint64_t now_t) const { return active && now_t < cycle_end_t; }
    /// The contents, kSize bytes; what the bus reads while the part is not busy.
    [[nodiscard]] const uint8_t* data() const { return contents.data(); }
    [[nodiscard]] Properties properties() const;

    /// What the bytes since the beginning of a cycle have asked for.
    enum class Command : uint8_t { none, protect, unprotect, erase };

    std::array<uint8_t, kSize> contents{};
    std::array<uint32_t, kPageCount> page_writes{};  ///< endurance: programming cycles of each page
    bool write_protected = false;                    ///< software data protection; survives power

    uint64_t load_t = 0;  ///< T-states of the settings above
    uint64_t write_cycle_t = 0;
    uint64_t erase_cycle_t = 0;
    uint64_t power_on_delay_t = 0;

    bool active = false;        ///< bytes are being loaded or programmed
    uint64_t window_end_t = 0;  ///< no byte is accepted from here on
    uint64_t cycle_end_t = 0;
    uint64_t writable_t = 0;  ///< end of the start-up delay
    std::array<uint8_t, kPageSize> latches{};
    uint64_t latched = 0;       ///< bit i: latches[i] was loaded
    uint16_t page = 0;          ///< of the last byte loaded: the page that is programmed
    uint8_t held_count = 0;     ///< bytes that so far match the beginning of a command
    uint8_t held_third = 0;     ///< value of the third of them
    bool command_open = false;  ///< the cycle has had nothing but the beginning of a command
    Command command = Command::none;
    uint8_t last_value = 0;  ///< last byte on the bus, for DATA polling
    bool toggle = false;     ///< what bit 6 of the next polling byte is

    uint64_t cycle_count = 0;            ///< completed
    uint64_t interrupted_count = 0;      ///< cycles cut short by a power failure
    uint64_t busy_write_count = 0;       ///< bytes ignored because a cycle was in progress
    uint64_t protected_write_count = 0;  ///< bytes ignored because of the data protection
    uint64_t power_on_write_count = 0;   ///< bytes ignored during the start-up delay
    uint64_t page_crossing_count = 0;    ///< bytes for another page than the one before
    uint16_t last_ignored_address = 0;   ///< of the last ignored byte, whatever the reason

    bool operator==(const At28c256&) const = default;

private:
    void begin();
    void take(uint16_t address, uint8_t value, uint64_t now_t);
    void take_held();
    void load_byte(uint16_t address, uint8_t value);
    [[nodiscard]] bool may_program() const;
    void complete();
};

}  // namespace host_sim::chips
