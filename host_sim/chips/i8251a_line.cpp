// i8251a_line.cpp - line side of the 8251A: transmitter, receiver, time in half clocks. See
// i8251a.hpp.
#include <algorithm>
#include <bit>

#include "host_sim/chips/i8251a.hpp"

namespace host_sim::chips {

namespace {

constexpr unsigned kLevelCount = 16;  // bits of LineFrame::levels
constexpr uint64_t kQ8 = 256;

uint64_t round_up_q8(uint64_t value_q8) {
    return (value_q8 + kQ8 - 1) / kQ8;
}

bool is_odd(unsigned bits) {
    return std::popcount(bits) % 2 == 1;
}

bool parity_bit(uint8_t byte, I8251a::Parity parity) {
    return is_odd(byte) == (parity == I8251a::Parity::even);
}

unsigned parity_bits(const I8251a::Format& format) {
    return format.parity == I8251a::Parity::none ? 0 : 1;
}

/// Start, data, parity.
unsigned bits_before_stop(const I8251a::Format& format) {
    return 1U + format.data_bits + parity_bits(format);
}

uint8_t data_mask(const I8251a::Format& format) {
    return static_cast<uint8_t>((1U << format.data_bits) - 1);
}

}  // namespace

// -- Time ----------------------------------------------------------------------------------------

/// T-state of a half clock, rounded up; kNever while the clock stands.
uint64_t I8251a::time_of(uint64_t half) const {
    if (half == kNever || clock_period_t == 0) {
        return kNever;
    }
    const uint64_t halves = half > base_half ? half - base_half : 0;
    return base_t + (halves * clock_period_t + 1) / 2;
}

/// The first half clock at or after `t`; needs a running clock.
uint64_t I8251a::half_from(uint64_t t) const {
    if (t <= base_t) {
        return base_half;
    }
    return base_half + (2 * (t - base_t) - 2) / clock_period_t + 1;
}

void I8251a::set_clock_period_t(uint64_t period_t, uint64_t now_t) {
    advance(now_t);
    if (period_t == clock_period_t) {
        return;
    }
    uint64_t half = base_half;
    if (clock_period_t != 0) {
        half += 2 * (last_t - base_t) / clock_period_t;
    }
    base_half = half + (half & 1);
    base_t = last_t;
    clock_period_t = period_t;
    if (tx_phase == TxPhase::waiting) {
        tx_half = base_half + 2;  // planned while the old clock ran or stood
    }
    if (rx_phase == RxPhase::wait_high || rx_phase == RxPhase::wait_low) {
        search_receiver(rx_phase, last_t + 1);
    }
    run();
}

/// Runs both sides up to last_t and finds when there is more to do.
void I8251a::run() {
    run_transmitter();
    run_receiver();
    const uint64_t rx_t = time_of(rx_half);
    wake_t = std::min({time_of(tx_half), rx_t, rx_load_t, time_of(rx_break_half)});
    uint64_t rx_visible_t = rx_t;
    if (rx_phase == RxPhase::bits) {  // nothing shows before the stop bit
        const unsigned left = bits_before_stop(frame_format) - 1 - rx_bit;
        rx_visible_t = time_of(rx_half + uint64_t{left} * 2 * clock_factor);
    }
    event_t = std::min({time_of(tx_half), rx_visible_t, rx_load_t, time_of(rx_break_half)});
    for (const uint64_t t : {tx_ready_t, tx_empty_t}) {
        if (t > last_t) {
            event_t = std::min(event_t, t);
            wake_t = std::min(wake_t, t);  // only to find the event behind it
        }
    }
}

// -- Transmitter ---------------------------------------------------------------------------------

/// What is in the part while it can send goes out, even if CTS or TxEN go away.
void I8251a::commit_holding() {
    if (!holding_full) {
        return;
    }
    if (!has(Command::kTransmitEnable)) {
        const bool nothing_moves = tx_phase == TxPhase::idle || tx_phase == TxPhase::stopping;
        if (!holding_committed && nothing_moves) {
            tx_empty_t = std::min(tx_empty_t, last_t);  // TxEMPTY is high while disabled
        }
        return;
    }
    tx_empty_t = kNever;
    if (!clear_to_send) {
        return;
    }
    holding_committed = true;
    if (tx_phase == TxPhase::idle) {
        tx_phase = TxPhase::waiting;
        const uint64_t half = clock_period_t == 0 ? base_half + 2 : half_from(last_t + 1);
        tx_half = half + (half & 1);  // TxD changes on the falling edge
    }
}

void I8251a::begin_frame(uint8_t byte, uint64_t half) {
    const unsigned half_bits = 2 * bits_before_stop(frame_format) + frame_format.stop_half_bits;
    tx_phase = TxPhase::shifting;
    shifting.byte = byte & data_mask(frame_format);
    shifting.start_t = time_of(half);
    shifting.broken = has(Command::kSendBreak);
    tx_end_half = half + uint64_t{half_bits} * clock_factor;
    tx_half = tx_end_half - clock_factor;  // the middle of the last bit
}

/// One step at tx_half: start a frame, look for the next character, end a frame.
void I8251a::step_transmitter() {
    const uint64_t half = tx_half;
    const uint64_t t = time_of(half);
    const bool takes = holding_full && holding_committed;
    if (tx_phase == TxPhase::shifting) {
        tx_phase = TxPhase::stopping;
        tx_half = tx_end_half;
        next_taken = takes;
        next_byte = holding;
        if (!takes && (!holding_full || !has(Command::kTransmitEnable))) {
            tx_empty_t = t + kTxEmptyDelayT;
        }
    } else {
        if (tx_phase == TxPhase::stopping) {
            shifting.end_t = t;
            transmitted.push_back(shifting);
        }
        if (!next_taken && !takes) {
            tx_phase = TxPhase::idle;
            tx_half = kNever;
            return;
        }
        begin_frame(next_taken ? next_byte : holding, half + (half & 1));
        if (next_taken) {
            next_taken = false;
            return;
        }
    }
    if (takes) {
        holding_full = false;
        holding_committed = false;
        tx_ready_t = t + kTxReadyDelayT;
    }
}

void I8251a::run_transmitter() {
    while (time_of(tx_half) <= last_t) {
        step_transmitter();
    }
}

// -- The line in ---------------------------------------------------------------------------------

void I8251a::append_line(LineFrame frame, uint64_t length_t) {
    frame.start_t = std::max(frame.start_t, last_t + 1);
    if (!line.empty()) {
        frame.start_t = std::max(frame.start_t, line.back().end_t);
    }
    frame.end_t = frame.start_t + length_t;
    line.push_back(frame);
    if (rx_phase == RxPhase::wait_high || rx_phase == RxPhase::wait_low) {
        search_receiver(rx_phase, last_t + 1);
        run();
    }
}

void I8251a::line_in(uint8_t byte, uint64_t start_t, uint64_t bit_period_q8_t, Format format) {
    LineFrame frame;
    const uint8_t data = byte & data_mask(format);
    const unsigned stop_bit = bits_before_stop(format);
    unsigned levels = ~0U << stop_bit | unsigned{data} << 1;
    if (format.parity != Parity::none && parity_bit(data, format.parity)) {
        levels |= 1U << (stop_bit - 1);
    }
    frame.start_t = start_t;
    frame.levels = static_cast<uint16_t>(levels);
    frame.bit_period_q8_t = bit_period_q8_t;
    const uint64_t half_bits = 2 * stop_bit + format.stop_half_bits;
    append_line(frame, round_up_q8((half_bits * bit_period_q8_t + 1) / 2));
}

void I8251a::line_break(uint64_t start_t, uint64_t end_t) {
    if (end_t > start_t) {
        append_line({start_t, 0, (end_t - start_t) * kQ8, 0}, end_t - start_t);
    }
}

/// Forgets what is over at `t`: nobody looks back.
void I8251a::drop_line(uint64_t t) {
    while (!line.empty() && line.front().end_t <= t) {
        line.pop_front();
    }
}

bool I8251a::line_level(uint64_t t) const {
    for (const LineFrame& frame : line) {
        if (t < frame.start_t) {
            return true;
        }
        if (t < frame.end_t) {
            const uint64_t index = (t - frame.start_t) * kQ8 / frame.bit_period_q8_t;
            return index >= kLevelCount || (frame.levels >> index & 1) != 0;
        }
    }
    return true;
}

/// The first time from `t` on at which the line has `level`.
uint64_t I8251a::line_level_from_t(bool level, uint64_t t) const {
    for (const LineFrame& frame : line) {
        if (t < frame.start_t) {
            if (level) {
                return t;
            }
            t = frame.start_t;
        }
        while (t < frame.end_t) {
            const uint64_t index = (t - frame.start_t) * kQ8 / frame.bit_period_q8_t;
            const bool found = index >= kLevelCount || (frame.levels >> index & 1) != 0;
            if (found == level) {
                return t;
            }
            if (index >= kLevelCount) {
                break;  // high to the frame's end
            }
            t = std::min(frame.end_t,
                         frame.start_t + round_up_q8((index + 1) * frame.bit_period_q8_t));
        }
        t = std::max(t, frame.end_t);
    }
    return level ? t : kNever;
}

// -- Receiver ------------------------------------------------------------------------------------

/// Start, data, parity and one stop bit.
uint64_t I8251a::low_frame_halves() const {
    return uint64_t{bits_before_stop(frame_format) + 1} * 2 * clock_factor;
}

/// Sets rx_half to the first sample from `from_t` on that sees `level`.
void I8251a::find_sample(bool level, uint64_t from_t) {
    rx_half = kNever;
    uint64_t t = line_level_from_t(level, from_t);
    while (t != kNever) {
        const uint64_t half = half_from(t) | 1;
        const uint64_t sample_t = time_of(half);
        if (line_level(sample_t) == level) {
            rx_half = half;
            return;
        }
        t = line_level_from_t(level, sample_t + 1);
    }
}

/// Waits for the line to be high (so that an edge can come), then for a start bit. A break is
/// tracked by the caller.
void I8251a::search_receiver(RxPhase phase, uint64_t from_t) {
    rx_phase = phase;
    rx_half = kNever;
    if (clock_period_t == 0 || (phase == RxPhase::wait_low && !has(Command::kReceiveEnable)) ||
        (phase == RxPhase::wait_low && clock_factor == 0)) {
        return;
    }
    find_sample(phase == RxPhase::wait_high, from_t);
}

void I8251a::take_sample(uint64_t t) {
    drop_line(t);
    switch (rx_phase) {
        case RxPhase::wait_high:
            break_detected = false;
            rx_break_half = kNever;
            search_receiver(RxPhase::wait_low, t + 1);
            return;
        case RxPhase::wait_low:
            rx_bit = 0;
            rx_shift = 0;
            rx_phase = clock_factor == 1 ? RxPhase::bits : RxPhase::start_check;
            rx_half += clock_factor == 1 ? 2U : clock_factor;
            return;
        case RxPhase::start_check:
            if (line_level(t)) {
                ++false_start_count;
                search_receiver(RxPhase::wait_low, t + 1);
                return;
            }
            rx_phase = RxPhase::bits;
            rx_half += 2U * clock_factor;
            return;
        case RxPhase::bits:
            take_bit(line_level(t), t);
            return;
    }
}

void I8251a::take_bit(bool level, uint64_t t) {
    const unsigned stop_index = bits_before_stop(frame_format) - 1;
    if (rx_bit < stop_index) {
        rx_shift = static_cast<uint16_t>(rx_shift | (level ? 1U : 0U) << rx_bit);
        ++rx_bit;
        rx_half += 2U * clock_factor;
        return;
    }
    rx_assembled = static_cast<uint8_t>(rx_shift & data_mask(frame_format));
    rx_assembled_errors = 0;
    if (frame_format.parity != Parity::none &&
        is_odd(rx_shift) != (frame_format.parity == Parity::odd)) {
        rx_assembled_errors |= Status::kParityError;
    }
    rx_load_t = t + kRxReadyDelayT;
    if (level) {
        search_receiver(RxPhase::wait_low, t + 1);
        return;
    }
    rx_assembled_errors |= Status::kFramingError;
    // Low through two stop bit sequences is a break; this one counts if it was low throughout.
    rx_break_half = rx_half + (rx_shift == 0 ? 1 : 2) * low_frame_halves();
    search_receiver(RxPhase::wait_high, t + 1);
}

/// The assembled character replaces the one in the buffer, read or not.
void I8251a::load_received() {
    rx_load_t = kNever;
    if (rx_ready) {
        ++overrun_count;
        errors |= Status::kOverrunError;
    }
    parity_error_count += (rx_assembled_errors & Status::kParityError) != 0 ? 1U : 0U;
    framing_error_count += (rx_assembled_errors & Status::kFramingError) != 0 ? 1U : 0U;
    errors |= rx_assembled_errors;
    rx_data = rx_assembled;
    rx_ready = true;
}

void I8251a::run_receiver() {
    while (true) {
        const uint64_t sample_t = time_of(rx_half);
        const uint64_t break_t = time_of(rx_break_half);
        const uint64_t first_t = std::min({sample_t, break_t, rx_load_t});
        if (first_t > last_t) {
            return;
        }
        if (first_t == rx_load_t) {
            load_received();
        } else if (first_t == sample_t) {
            take_sample(sample_t);
        } else {
            rx_break_half = kNever;
            break_detected = has(Command::kReceiveEnable);
        }
    }
}

}  // namespace host_sim::chips
