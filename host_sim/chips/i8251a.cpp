// i8251a.cpp - bus side of the 8251A: instructions, status, properties. See i8251a.hpp.
#include "host_sim/chips/i8251a.hpp"

#include <fmt/format.h>

#include <array>

namespace host_sim::chips {

namespace {

// Mode instruction.
constexpr uint8_t kModeParityEnable = 0x10;
constexpr uint8_t kModeEvenParity = 0x20;
constexpr uint8_t kModeSingleSync = 0x80;

// Recovery time between writes in CLK periods (A.C. characteristics, tRV and its note).
constexpr uint64_t kRecoveryInitialiseT = 6;
constexpr uint64_t kRecoveryAsynchronousT = 8;
constexpr uint64_t kRecoverySynchronousT = 16;

const char* describe(I8251a::Expects expects) {
    constexpr std::array<const char*, 4> kNames{"mode instruction", "sync character 1",
                                                "sync character 2", "command"};
    return kNames[static_cast<unsigned>(expects)];
}

std::string describe_mode(const I8251a& chip) {
    if (chip.expects == I8251a::Expects::mode) {
        return "none";
    }
    if (chip.clock_factor == 0) {
        return fmt::format("{:02X}h synchronous: transfers are not modelled", chip.mode);
    }
    constexpr std::array<char, 3> kParity{'N', 'O', 'E'};
    constexpr std::array<const char*, 3> kStop{"1", "1.5", "2"};
    const I8251a::Format& format = chip.format();
    return fmt::format("{:02X}h asynchronous {}{}{} x{}", chip.mode, format.data_bits,
                       kParity[static_cast<unsigned>(format.parity)],
                       kStop[format.stop_half_bits - 2U], chip.clock_factor);
}

}  // namespace

void I8251a::reset() {
    aborted_frame_count += tx_phase == TxPhase::shifting || tx_phase == TxPhase::stopping ? 1U : 0U;
    if (has(Command::kSendBreak)) {
        transmitted_breaks.push_back({break_start_t, last_t});
    }
    expects = Expects::mode;
    mode = 0;
    command = 0;
    frame_format = Format{};
    clock_factor = 0;
    write_t = kNever;
    tx_phase = TxPhase::idle;
    tx_half = kNever;
    holding_full = false;
    holding_committed = false;
    next_taken = false;
    tx_ready_t = last_t;
    tx_empty_t = last_t;
    rx_load_t = kNever;
    rx_break_half = kNever;
    rx_data = 0;
    rx_ready = false;
    break_detected = false;
    errors = 0;
    search_receiver(RxPhase::wait_high, last_t + 1);
    run();
}

void I8251a::advance(uint64_t now_t) {
    if (now_t <= last_t) {
        return;
    }
    last_t = now_t;
    if (now_t >= wake_t) {
        run();
    }
    drop_line(now_t);
}

uint8_t I8251a::status() const {
    uint8_t bits = errors;
    bits |= !holding_full && last_t >= tx_ready_t ? Status::kTxReady : uint8_t{0};
    bits |= rx_ready ? Status::kRxReady : uint8_t{0};
    bits |= tx_empty_pin() ? Status::kTxEmpty : uint8_t{0};
    bits |= break_detected ? Status::kBreakDetect : uint8_t{0};
    bits |= data_set_ready ? Status::kDataSetReady : uint8_t{0};
    return bits;
}

bool I8251a::tx_ready_pin() const {
    return (status() & Status::kTxReady) != 0 && has(Command::kTransmitEnable) && clear_to_send;
}

uint8_t I8251a::read(uint16_t address, uint64_t now_t) {
    advance(now_t);
    if ((address & 1) == kControlAddress) {
        return status();
    }
    empty_read_count += rx_ready ? 0 : 1;
    rx_ready = false;
    return rx_data;
}

void I8251a::write(uint16_t address, uint8_t value, uint64_t now_t) {
    advance(now_t);
    count_recovery();
    if ((address & 1) == kControlAddress) {
        write_control(value);
    } else {
        write_data(value);
    }
    run();
}

void I8251a::count_recovery() {
    uint64_t recovery_t = kRecoveryInitialiseT;
    if (expects == Expects::command) {
        recovery_t = clock_factor == 0 ? kRecoverySynchronousT : kRecoveryAsynchronousT;
    }
    if (write_t != kNever && last_t - write_t < recovery_t) {
        ++recovery_violation_count;
    }
    write_t = last_t;
}

void I8251a::write_control(uint8_t value) {
    switch (expects) {
        case Expects::mode:
            take_mode(value);
            break;
        case Expects::sync1:
            expects = (mode & kModeSingleSync) != 0 ? Expects::command : Expects::sync2;
            break;
        case Expects::sync2:
            expects = Expects::command;
            break;
        case Expects::command:
            take_command(value);
            break;
    }
}

void I8251a::take_mode(uint8_t value) {
    constexpr std::array<uint8_t, 4> kFactors{0, 1, 16, 64};
    mode = value;
    clock_factor = kFactors[value & 3];
    expects = clock_factor == 0 ? Expects::sync1 : Expects::command;
    frame_format.data_bits = static_cast<uint8_t>(5 + (value >> 2 & 3));
    frame_format.parity = Parity::none;
    if ((value & kModeParityEnable) != 0) {
        frame_format.parity = (value & kModeEvenParity) != 0 ? Parity::even : Parity::odd;
    }
    const unsigned stop = value >> 6;
    if (clock_factor != 0 && stop == 0) {
        ++invalid_mode_count;  // the data sheet says invalid; here it sends one stop bit
    }
    frame_format.stop_half_bits = static_cast<uint8_t>(stop == 0 ? 2 : 1 + stop);
}

void I8251a::take_command(uint8_t value) {
    if ((value & Command::kInternalReset) != 0) {
        reset();
        write_t = last_t;
        return;
    }
    const uint8_t changed = command ^ value;
    command = value;
    if ((value & Command::kErrorReset) != 0) {
        errors = 0;
    }
    if ((changed & Command::kReceiveEnable) != 0) {
        // Off holds RxRDY in the reset condition; on looks for a start bit's edge from here.
        rx_ready = false;
        rx_load_t = kNever;
        rx_break_half = kNever;
        search_receiver(RxPhase::wait_high, last_t + 1);
    }
    if ((changed & Command::kSendBreak) != 0) {
        if (has(Command::kSendBreak)) {
            break_start_t = last_t;
            shifting.broken = true;  // begin_frame clears it for frames to come
        } else {
            transmitted_breaks.push_back({break_start_t, last_t});
        }
    }
    commit_holding();
}

void I8251a::write_data(uint8_t value) {
    if (expects != Expects::command || clock_factor == 0) {
        ++lost_data_write_count;
        return;
    }
    if (holding_full) {
        ++overwritten_count;
    } else if (last_t < tx_ready_t) {
        ++early_write_count;
    }
    holding = value;
    holding_full = true;
    commit_holding();
}

void I8251a::set_cts(bool level, uint64_t now_t) {
    advance(now_t);
    clear_to_send = level;
    commit_holding();
    run();
}

void I8251a::set_dsr(bool level, uint64_t now_t) {
    advance(now_t);
    data_set_ready = level;
}

Properties I8251a::properties() const {
    Properties list;
    list.push_back({"expects", describe(expects)});
    list.push_back({"mode", describe_mode(*this)});
    list.push_back({"command", fmt::format("{:02X}h", command)});
    list.push_back({"status", fmt::format("{:02X}h", status())});
    list.push_back({"pins", fmt::format("TxRDY {} RxRDY {} TxEMPTY {} RTS {} DTR {} CTS {} DSR {}",
                                        tx_ready_pin() ? 1 : 0, rx_ready ? 1 : 0,
                                        tx_empty_pin() ? 1 : 0, rts() ? 1 : 0, dtr() ? 1 : 0,
                                        clear_to_send ? 1 : 0, data_set_ready ? 1 : 0)});
    list.push_back({"clock", clock_period_t == 0 ? std::string("stopped")
                                                 : fmt::format("{} T", clock_period_t)});
    list.push_back({"holding register",
                    holding_full ? fmt::format("{:02X}h", holding) : std::string("empty")});
    list.push_back({"receive buffer", fmt::format("{:02X}h", rx_data)});
    const auto add = [&list](const char* name, uint64_t number) {
        list.push_back({name, std::to_string(number)});
    };
    add("characters overwritten before sent", overwritten_count);
    add("writes before TxRDY", early_write_count);
    add("reads without RxRDY", empty_read_count);
    add("characters lost by overrun", overrun_count);
    add("parity errors", parity_error_count);
    add("framing errors", framing_error_count);
    add("false start bits", false_start_count);
    add("frames aborted by reset", aborted_frame_count);
    add("recovery time violations", recovery_violation_count);
    add("invalid mode instructions", invalid_mode_count);
    add("data writes without effect", lost_data_write_count);
    return list;
}

}  // namespace host_sim::chips
