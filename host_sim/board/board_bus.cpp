// board_bus.cpp - see board_bus.hpp.
#include "host_sim/board/board_bus.hpp"

#include <algorithm>

namespace host_sim {

namespace rb85 = hal::rb85;
using chips::I82c55a;
using Port = I82c55a::Port;

namespace {

constexpr bool in_block(uint8_t port, uint8_t first, uint8_t size) {
    return port >= first && port < first + size;
}

constexpr unsigned kWheelsPerTimer = 3;
constexpr uint64_t kLineBitQ8T = uint64_t{rb85::kBaudCount} * 16 * 256;  // one bit at 19,200 baud

/// Pins of an 82C55A that drive a load: what the part drives low or not at all leaves it off.
uint8_t driven(const I82c55a& ppi, Port port) {
    return static_cast<uint8_t>(ppi.port_output(port) & ppi.port_output_mask(port));
}

/// Bytes that the EEPROM did not take as its protocol has it.
uint64_t ignored_bytes(const chips::At28c256& eeprom) {
    return eeprom.busy_write_count + eeprom.protected_write_count + eeprom.power_on_write_count +
           eeprom.page_crossing_count;
}

}  // namespace

uint8_t BoardBus::read(uint16_t address, uint64_t t) {
    if (s_.eeprom.active && address <= s_.map.eeprom_last) {
        advance(t);
        if (s_.eeprom.active) return s_.eeprom.read(address, t);
    }
    return s_.memory.bytes[address];
}

void BoardBus::write(uint16_t address, uint8_t value, uint64_t t) {
    if (address >= s_.map.ram_first && address <= s_.map.ram_last) {
        s_.memory.bytes[address] = value;
        return;
    }
    if (address > s_.map.eeprom_last) {
        violate(Violation::Kind::unmapped_write, address, value, t);
        return;
    }
    advance(t);
    const uint64_t ignored = ignored_bytes(s_.eeprom);
    s_.eeprom.write(address, value, t);
    if (ignored_bytes(s_.eeprom) != ignored) {
        violate(Violation::Kind::eeprom_write, address, value, t);
    }
    find_event();
}

uint8_t BoardBus::in(uint8_t port, uint64_t t) {
    advance(t);
    uint8_t value = chips::kOpenBus;
    if (in_block(port, rb85::kUsartData, 2)) {
        value = s_.usart.read(port & 1, t);
    } else if (in_block(port, rb85::kTimerA, 12)) {
        value = s_.timers[(port - rb85::kTimerA) / 4U].read(port & 3, t);
    } else if (in_block(port, rb85::kPpiA, 8)) {
        value = read_ppi((port - rb85::kPpiA) / 4U, port & 3, t);
    } else if (in_block(port, rb85::kAdc, 2)) {
        value = s_.analog.read(port & 1, t);
    } else if (port == rb85::kPresence) {
        value = s_.presence.read(0, t);
    } else if (!in_block(port, rb85::kMotorDrive, 12)) {
        violate(Violation::Kind::unmapped_in, port, value, t);
    }
    follow_interrupt_lines(t);
    find_event();
    return value;
}

uint8_t BoardBus::read_ppi(unsigned index, uint8_t address, uint64_t t) {
    if (index == 0) {
        const uint8_t busy = s_.analog.busy(t) ? rb85::kAdcBusyBit : 0;
        s_.ppis[0].set_port_input(Port::b, busy, rb85::kAdcBusyBit, t);
    } else {
        s_.range.advance(t);
        s_.ppis[1].set_port_input(Port::a, s_.range.data(), 0xFF, t);
        const uint8_t acknowledge = s_.range.acknowledge() ? rb85::kRangeAckBit : 0;
        s_.ppis[1].set_port_input(Port::c, acknowledge, rb85::kRangeAckBit, t);
    }
    return s_.ppis[index].read(address, t);
}

void BoardBus::out(uint8_t port, uint8_t value, uint64_t t) {
    advance(t);
    if (in_block(port, rb85::kUsartData, 2)) {
        s_.usart.write(port & 1, value, t);
    } else if (in_block(port, rb85::kTimerA, 12)) {
        s_.timers[(port - rb85::kTimerA) / 4U].write(port & 3, value, t);
        s_.usart.set_clock_period_t(s_.timers[0].output_period_t(rb85::kBaudCounter), t);
    } else if (in_block(port, rb85::kPpiA, 8)) {
        s_.ppis[(port - rb85::kPpiA) / 4U].write(port & 3, value, t);
        follow_outputs(t);
    } else if (in_block(port, rb85::kAdc, 2)) {
        s_.analog.write(port & 1, value, t);
    } else if (in_block(port, rb85::kMotorDrive, 12)) {
        s_.motors.write(static_cast<uint16_t>(port - rb85::kMotorDrive), value, t);
    } else {
        violate(Violation::Kind::unmapped_out, port, value, t);
    }
    follow_interrupt_lines(t);
    find_event();
}

void BoardBus::serial_out(bool level, uint64_t t) {
    advance(t);
    s_.watchdog.sod(level, t);
    find_event();
}

void BoardBus::follow_outputs(uint64_t t) {
    const I82c55a& analog_side = s_.ppis[0];
    s_.analog.select(analog_side.port_level(Port::a) & rb85::kMuxAddressMask, t);
    const bool laser_fires = (driven(analog_side, Port::c) & rb85::kLaserMask) != 0;
    s_.timers[0].set_gate(rb85::kLaserCounter, laser_fires, t);
    const uint8_t range_lines = driven(s_.ppis[1], Port::c);
    s_.range.set_lines((range_lines & rb85::kRangeSelectBit) != 0,
                       (range_lines & rb85::kRangeStrobeBit) != 0, t);
}

void BoardBus::follow_interrupt_lines(uint64_t t) {
    set_pin(s_.cpu, Pin::rst75, s_.timers[0].output(rb85::kTickCounter), t);
    set_pin(s_.cpu, Pin::rst65, s_.usart.rx_ready_pin(), t);
    set_pin(s_.cpu, Pin::rst55, s_.usart.tx_ready_pin(), t);
    const bool gate = (driven(s_.ppis[1], Port::c) & rb85::kTrapGateBit) != 0;
    set_pin(s_.cpu, Pin::trap, gate && (s_.undervoltage || s_.bumper), t);
}

void BoardBus::handle_event() {
    if (s_.event_t == 0) {
        find_event();
        return;
    }
    const uint64_t t = s_.event_t;
    while (!s_.stimuli.empty() && s_.stimuli.front().t <= t) {
        const Stimulus stimulus = s_.stimuli.front();
        s_.stimuli.pop_front();
        apply(stimulus);
    }
    for (chips::I82c54& timer : s_.timers) timer.advance(t);
    s_.usart.advance(t);
    if (s_.eeprom.next_event_t() <= t) follow_eeprom();
    follow_watchdog(t);
    follow_interrupt_lines(t);
    find_event();
}

void BoardBus::follow_watchdog(uint64_t t) {
    const bool pulse_before = s_.watchdog.pulse();
    s_.watchdog.advance(t);
    const bool pulse = s_.watchdog.pulse();
    s_.motors.set_motors_off(pulse);
    if (pulse && !pulse_before) s_.reset_pending = true;
}

// The cycle is over: the bus reads the new contents.
void BoardBus::follow_eeprom() {
    const uint64_t end_t = s_.eeprom.next_event_t();
    const uint64_t ignored = ignored_bytes(s_.eeprom);
    s_.eeprom.advance(end_t);
    if (ignored_bytes(s_.eeprom) != ignored) {  // the beginning of a command, and no more
        violate(Violation::Kind::eeprom_write, s_.eeprom.last_ignored_address, s_.eeprom.last_value,
                end_t);
    }
    const unsigned size = s_.map.eeprom_last + 1U;
    std::copy_n(s_.eeprom.data(), size, s_.memory.bytes.begin());
}

void BoardBus::find_event() {
    uint64_t next = std::min({s_.usart.next_event_t(), s_.eeprom.next_event_t(),
                              s_.watchdog.next_event_t(), s_.timers[0].next_event_t()});
    if (!s_.stimuli.empty()) next = std::min(next, s_.stimuli.front().t);
    s_.event_t = next;
}

void BoardBus::apply(const Stimulus& stimulus) {
    const uint64_t t = stimulus.t;
    const auto byte = static_cast<uint8_t>(stimulus.value);
    const bool on = stimulus.value != 0;
    switch (stimulus.kind) {
        case Stimulus::Kind::sensor:
            s_.analog.set_sensor(stimulus.index, stimulus.value, t);
            break;
        case Stimulus::Kind::tach_pulse:
            s_.timers[1 + stimulus.index / kWheelsPerTimer].clock_pulse(
                stimulus.index % kWheelsPerTimer, t);
            break;
        case Stimulus::Kind::tach_forward: {
            const auto bit = static_cast<uint8_t>(1U << stimulus.index);
            s_.ppis[0].set_port_input(Port::b, on ? bit : 0, bit, t);
            break;
        }
        case Stimulus::Kind::tach_connected:
            s_.presence.set_connected(stimulus.index, on);
            break;
        case Stimulus::Kind::detectors:
            s_.ppis[1].set_port_input(Port::b, byte, 0xFF, t);
            break;
        case Stimulus::Kind::undervoltage:
            s_.undervoltage = on;
            s_.ppis[0].set_port_input(Port::b, on ? rb85::kTrapCauseBit : 0, rb85::kTrapCauseBit,
                                      t);
            break;
        case Stimulus::Kind::bumper:
            s_.bumper = on;
            break;
        case Stimulus::Kind::service:
            set_pin(s_.cpu, Pin::sid, on, t);
            break;
        case Stimulus::Kind::serial_byte:
            s_.usart.line_in(byte, t, kLineBitQ8T);
            break;
        case Stimulus::Kind::reset_button:
            s_.reset_pending = true;
            break;
    }
    follow_interrupt_lines(t);
    find_event();
}

void BoardBus::find_lines(uint64_t t) {
    follow_interrupt_lines(t);
    find_event();
}

void BoardBus::reset(uint64_t t) {
    host_sim::reset(s_.cpu);
    s_.usart.reset();
    for (I82c55a& ppi : s_.ppis) ppi.reset();
    s_.motors.reset();
    if (!s_.watchdog.pulse()) s_.watchdog.restart(t);
    s_.reset_pending = false;
    ++s_.reset_count;
    follow_outputs(t);
    follow_interrupt_lines(t);
    find_event();
}

void BoardBus::violate(Violation::Kind kind, uint16_t address, uint8_t value, uint64_t t) {
    s_.last_violation = {kind, instruction_pc_, address, value, t};
    if (s_.violation_count == 0) s_.first_violation = s_.last_violation;
    ++s_.violation_count;
}

}  // namespace host_sim
