// i8251a.hpp - 8251A USART: asynchronous transmitter and receiver, bit by bit in time.
// Source       Intel 8251A data sheet (205222).
// Depends on   host_sim/chips/chip.hpp.
// Modelled     mode and command sequence, both buffers, all status bits and pins of asynchronous
//              mode. The receiver samples the line at its own mid-bit times, so a wrong baud rate
//              gives real garbage. Delays of flags are the data sheet's maxima.
// Not modelled transfers in synchronous mode (its initialisation is); 8251A's CLK is the
// processor's. Page         docs/chips/i8251a.md
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

/// The USART, its line in (RxD) as a queue of frames and its line out (TxD) as a list of them.
struct I8251a {
    static constexpr uint16_t kDataAddress = 0;
    static constexpr uint16_t kControlAddress = 1;

    /// From the middle of a character's last bit, in CLK periods (A.C. characteristics, maxima).
    static constexpr uint64_t kTxReadyDelayT = 14;
    static constexpr uint64_t kTxEmptyDelayT = 20;
    static constexpr uint64_t kRxReadyDelayT = 26;

    struct Status {
        static constexpr uint8_t kTxReady = 0x01;
        static constexpr uint8_t kRxReady = 0x02;
        static constexpr uint8_t kTxEmpty = 0x04;
        static constexpr uint8_t kParityError = 0x08;
        static constexpr uint8_t kOverrunError = 0x10;
        static constexpr uint8_t kFramingError = 0x20;
        static constexpr uint8_t kBreakDetect = 0x40;
        static constexpr uint8_t kDataSetReady = 0x80;
        static constexpr uint8_t kErrors = kParityError | kOverrunError | kFramingError;
    };
    struct Command {
        static constexpr uint8_t kTransmitEnable = 0x01;
        static constexpr uint8_t kDataTerminalReady = 0x02;
        static constexpr uint8_t kReceiveEnable = 0x04;
        static constexpr uint8_t kSendBreak = 0x08;
        static constexpr uint8_t kErrorReset = 0x10;
        static constexpr uint8_t kRequestToSend = 0x20;
        static constexpr uint8_t kInternalReset = 0x40;
        static constexpr uint8_t kEnterHunt = 0x80;
    };
    enum class Parity : uint8_t { none, odd, even };

    /// How a character is framed.
    struct Format {
        uint8_t data_bits = 8;
        Parity parity = Parity::none;
        uint8_t stop_half_bits = 2;  ///< 2, 3 or 4

        bool operator==(const Format&) const = default;
    };
    /// A stretch of RxD; outside of all of them the line is high.
    struct LineFrame {
        uint64_t start_t = 0;
        uint64_t end_t = 0;
        uint64_t bit_period_q8_t = 0;
        uint16_t levels = 0xFFFF;  ///< one bit each from bit 0, then high

        bool operator==(const LineFrame&) const = default;
    };
    /// A character as it left on TxD, from the start bit's beginning to the stop bits' end.
    struct TransmittedByte {
        uint8_t byte = 0;
        uint64_t start_t = 0;
        uint64_t end_t = 0;
        bool broken = false;  ///< SBRK held the line low in some of it

        bool operator==(const TransmittedByte&) const = default;
    };
    /// TxD held low by the command bit SBRK.
    struct TransmittedBreak {
        uint64_t start_t = 0;
        uint64_t end_t = 0;

        bool operator==(const TransmittedBreak&) const = default;
    };

    /// The RESET pin: idle until a mode instruction. Lines, clock, what was sent and counts stay.
    void reset();

    /// @param address  bit 0 counts: data, control (reads as status)
    uint8_t read(uint16_t address, uint64_t now_t);
    void write(uint16_t address, uint8_t value, uint64_t now_t);
    void advance(uint64_t now_t);
    [[nodiscard]] uint64_t next_event_t() const { return event_t; }

    /// TxC and RxC: `period_t` T-states per clock from `now_t` on, the first falling edge at its
    /// end; 0 stops them. A character under way goes on at the new rate. The period it has already
    /// changes nothing.
    void set_clock_period_t(uint64_t period_t, uint64_t now_t);
    /// CTS. True is the pin low: may send. True after construction.
    void set_cts(bool clear_to_send, uint64_t now_t);
    /// DSR. True is the pin low.
    void set_dsr(bool data_set_ready, uint64_t now_t);

    /// A character arrives on RxD. One that would begin in the past or before the end of the one
    /// before begins as soon as it can, as from a sender with a queue.
    /// @param bit_period_q8_t  T-states per bit in 1/256, not 0; the sender's, not ours
    void line_in(uint8_t byte, uint64_t start_t, uint64_t bit_period_q8_t, Format format);
    void line_in(uint8_t byte, uint64_t start_t, uint64_t bit_period_q8_t) {
        line_in(byte, start_t, bit_period_q8_t, Format{});
    }
    /// RxD is low from `start_t` to `end_t`, put back in the same way.
    void line_break(uint64_t start_t, uint64_t end_t);

    /// TxRDY: the status bit, gated by CTS and TxEN.
    [[nodiscard]] bool tx_ready_pin() const;
    [[nodiscard]] bool rx_ready_pin() const { return rx_ready; }
    [[nodiscard]] bool tx_empty_pin() const { return last_t >= tx_empty_t; }
    /// RTS and DTR. True is the pin low.
    [[nodiscard]] bool rts() const { return (command & Command::kRequestToSend) != 0; }
    [[nodiscard]] bool dtr() const { return (command & Command::kDataTerminalReady) != 0; }
    /// The status register as of the last advance.
    [[nodiscard]] uint8_t status() const;
    /// Framing set by the mode instruction.
    [[nodiscard]] const Format& format() const { return frame_format; }
    [[nodiscard]] Properties properties() const;

    /// What was sent; whoever reads it empties it.
    std::vector<TransmittedByte> transmitted;
    std::vector<TransmittedBreak> transmitted_breaks;

    enum class Expects : uint8_t { mode, sync1, sync2, command };
    Expects expects = Expects::mode;
    uint8_t mode = 0;
    uint8_t command = 0;
    Format frame_format;
    uint8_t clock_factor = 0;  ///< 1, 16, 64; 0 in synchronous mode and before a mode instruction
    bool clear_to_send = true;
    bool data_set_ready = false;
    uint64_t write_t = kNever;  ///< last write, for the recovery time
    uint64_t last_t = 0;        ///< of the last advance

    // Time on the lines is counted in half clocks: even ones are falling edges (TxC shifts), odd
    // ones rising edges (RxC samples).
    uint64_t clock_period_t = 0;
    uint64_t base_t = 0;  ///< half clock base_half was at base_t
    uint64_t base_half = 0;

    enum class TxPhase : uint8_t { idle, waiting, shifting, stopping };
    TxPhase tx_phase = TxPhase::idle;
    bool holding_full = false;
    bool holding_committed = false;  ///< was in the part while it could send: will go out
    uint8_t holding = 0;
    bool next_taken = false;  ///< the character after this one left the holding register
    uint8_t next_byte = 0;
    TransmittedByte shifting;
    uint64_t tx_half = kNever;  ///< of the transmitter's next step
    uint64_t tx_end_half = 0;
    uint64_t tx_ready_t = 0;  ///< when the empty holding register shows
    uint64_t tx_empty_t = 0;
    uint64_t break_start_t = 0;

    enum class RxPhase : uint8_t { wait_high, wait_low, start_check, bits };
    RxPhase rx_phase = RxPhase::wait_high;
    std::deque<LineFrame> line;
    uint64_t rx_half = kNever;  ///< of the receiver's next sample that matters
    uint8_t rx_bit = 0;
    uint16_t rx_shift = 0;
    uint64_t rx_break_half = kNever;  ///< BRKDET if the line stays low until then
    uint64_t rx_load_t = kNever;      ///< when the assembled character shows
    uint8_t rx_assembled = 0;
    uint8_t rx_assembled_errors = 0;
    uint8_t rx_data = 0;
    bool rx_ready = false;
    bool break_detected = false;
    uint8_t errors = 0;  ///< PE, OE, FE at their places in the status

    uint64_t wake_t = kNever;   ///< next step inside
    uint64_t event_t = kNever;  ///< what next_event_t() returns

    uint64_t overwritten_count = 0;  ///< data written over a character that was still to send
    uint64_t early_write_count = 0;  ///< data written before TxRDY showed, nothing lost
    uint64_t empty_read_count = 0;   ///< data read without RxRDY
    uint64_t overrun_count = 0;      ///< characters lost because they were not read in time
    uint64_t parity_error_count = 0;
    uint64_t framing_error_count = 0;
    uint64_t false_start_count = 0;    ///< start bit gone at its middle
    uint64_t aborted_frame_count = 0;  ///< reset while sending
    uint64_t recovery_violation_count = 0;
    uint64_t invalid_mode_count = 0;     ///< no stop bit length
    uint64_t lost_data_write_count = 0;  ///< data before the mode instruction or synchronous

    bool operator==(const I8251a&) const = default;

private:
    [[nodiscard]] uint64_t time_of(uint64_t half) const;
    [[nodiscard]] uint64_t half_from(uint64_t t) const;
    [[nodiscard]] uint64_t low_frame_halves() const;
    [[nodiscard]] bool has(uint8_t command_bits) const { return (command & command_bits) != 0; }
    [[nodiscard]] bool line_level(uint64_t t) const;
    [[nodiscard]] uint64_t line_level_from_t(bool level, uint64_t t) const;
    void drop_line(uint64_t t);
    void append_line(LineFrame frame, uint64_t length_t);
    void write_control(uint8_t value);
    void take_mode(uint8_t value);
    void take_command(uint8_t value);
    void write_data(uint8_t value);
    void count_recovery();
    void commit_holding();
    void begin_frame(uint8_t byte, uint64_t half);
    void step_transmitter();
    void run_transmitter();
    void find_sample(bool level, uint64_t from_t);
    void search_receiver(RxPhase phase, uint64_t from_t);
    void take_sample(uint64_t t);
    void take_bit(bool level, uint64_t t);
    void load_received();
    void run_receiver();
    void run();
};

}  // namespace host_sim::chips
