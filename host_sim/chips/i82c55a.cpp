// i82c55a.cpp - 82C55A: port C as data, status and handshake.
#include "host_sim/chips/i82c55a.hpp"

#include <fmt/format.h>

namespace host_sim::chips {
namespace {

constexpr uint8_t kModeSetFlag = 0x80;

// Bits of the mode word.
constexpr uint8_t kBidirectionalA = 0x40;
constexpr uint8_t kStrobedA = 0x20;
constexpr uint8_t kInputA = 0x10;
constexpr uint8_t kInputUpperC = 0x08;
constexpr uint8_t kStrobedB = 0x04;
constexpr uint8_t kInputB = 0x02;
constexpr uint8_t kInputLowerC = 0x01;

// Bits of port C. In mode 1 and 2 they carry the handshake.
constexpr unsigned kInterruptB = 0;
constexpr unsigned kFullB = 1;     // IBF or OBF
constexpr unsigned kControlB = 2;  // STB or ACK; its INTE when written
constexpr unsigned kInterruptA = 3;
constexpr unsigned kStrobeA = 4;       // STB; its INTE when written
constexpr unsigned kInputFullA = 5;    // IBF
constexpr unsigned kAcknowledgeA = 6;  // ACK; its INTE when written
constexpr unsigned kOutputFullA = 7;   // OBF

constexpr unsigned kA = 0;
constexpr unsigned kB = 1;
constexpr unsigned kC = 2;

constexpr unsigned bit_mask(unsigned bit) {
    return 1u << bit;
}

constexpr unsigned bit_if(bool level, unsigned bit) {
    return level ? bit_mask(bit) : 0u;
}

}  // namespace

I82c55a::Mode I82c55a::mode_a() const {
    if ((control & kBidirectionalA) != 0) return Mode::bidirectional;
    if ((control & kStrobedA) == 0) return Mode::basic;
    return (control & kInputA) != 0 ? Mode::strobed_input : Mode::strobed_output;
}

I82c55a::Mode I82c55a::mode_b() const {
    if ((control & kStrobedB) == 0) return Mode::basic;
    return (control & kInputB) != 0 ? Mode::strobed_input : Mode::strobed_output;
}

bool I82c55a::takes_a() const {
    return mode_a() == Mode::strobed_input || mode_a() == Mode::bidirectional;
}

bool I82c55a::gives_a() const {
    return mode_a() == Mode::strobed_output || mode_a() == Mode::bidirectional;
}

// Pins of port C that the modes take away from general use.
uint8_t I82c55a::handshake_pins() const {
    unsigned pins = 0;
    if (mode_a() != Mode::basic) pins |= bit_mask(kInterruptA);
    if (takes_a()) pins |= bit_mask(kStrobeA) | bit_mask(kInputFullA);
    if (gives_a()) pins |= bit_mask(kAcknowledgeA) | bit_mask(kOutputFullA);
    if (mode_b() != Mode::basic) {
        pins |= bit_mask(kInterruptB) | bit_mask(kFullB) | bit_mask(kControlB);
    }
    return static_cast<uint8_t>(pins);
}

uint8_t I82c55a::handshake_outputs() const {
    constexpr unsigned kInputs = bit_mask(kStrobeA) | bit_mask(kAcknowledgeA) | bit_mask(kControlB);
    return static_cast<uint8_t>(handshake_pins() & ~kInputs);
}

uint8_t I82c55a::general_outputs() const {
    const unsigned upper = (control & kInputUpperC) != 0 ? 0u : 0xF0u;
    const unsigned lower = (control & kInputLowerC) != 0 ? 0u : 0x0Fu;
    return static_cast<uint8_t>((upper | lower) & ~unsigned{handshake_pins()});
}

bool I82c55a::interrupt_a() const {
    const bool input = takes_a() && input_enable_a && input_full_a && outside_c(kStrobeA);
    const bool output = gives_a() && output_enable_a && !output_full_a && outside_c(kAcknowledgeA);
    return input || output;
}

bool I82c55a::interrupt_b() const {
    if (mode_b() == Mode::basic || !enable_b || !outside_c(kControlB)) return false;
    return mode_b() == Mode::strobed_input ? input_full_b : !output_full_b;
}

// IBF is active high, OBF active low.
uint8_t I82c55a::handshake_levels() const {
    const bool full_b = mode_b() == Mode::strobed_input ? input_full_b : !output_full_b;
    return static_cast<uint8_t>(bit_if(interrupt_a(), kInterruptA) |
                                bit_if(input_full_a, kInputFullA) |
                                bit_if(!output_full_a, kOutputFullA) | bit_if(full_b, kFullB) |
                                bit_if(interrupt_b(), kInterruptB));
}

// What a read of port C yields: the handshake inputs are replaced by their INTE flip-flops.
uint8_t I82c55a::status() const {
    const unsigned enables = bit_if(input_enable_a, kStrobeA) |
                             bit_if(output_enable_a, kAcknowledgeA) | bit_if(enable_b, kControlB);
    const uint8_t taken = handshake_pins();
    const uint8_t outputs = general_outputs();
    return static_cast<uint8_t>(((handshake_levels() | enables) & taken) | (latch[kC] & outputs) |
                                (outside[kC] & ~(taken | outputs)));
}

uint8_t I82c55a::port_output_mask(Port port) const {
    switch (port) {
        case Port::a:
            if (mode_a() == Mode::bidirectional) return outside_c(kAcknowledgeA) ? 0x00 : 0xFF;
            return (control & kInputA) != 0 ? 0x00 : 0xFF;
        case Port::b:
            return (control & kInputB) != 0 ? 0x00 : 0xFF;
        case Port::c:
            break;
    }
    return general_outputs() | handshake_outputs();
}

uint8_t I82c55a::port_output(Port port) const {
    uint8_t levels = latch[static_cast<unsigned>(port)];
    if (port == Port::c) {
        levels = static_cast<uint8_t>((levels & general_outputs()) |
                                      (handshake_levels() & handshake_outputs()));
    }
    const uint8_t mask = port_output_mask(port);
    return static_cast<uint8_t>((levels & mask) | (~mask & 0xFF));
}

uint8_t I82c55a::port_level(Port port) const {
    // Undriven pins are 1 in port_output, driven ones are to win over what is outside.
    return port_output(port) & (outside[static_cast<unsigned>(port)] | port_output_mask(port));
}

uint8_t I82c55a::read(uint16_t address, uint64_t /*now_t*/) {
    switch (address & 3) {
        case 0:
            return read_port_a();
        case 1:
            return read_port_b();
        case 2:
            return status();
        default:
            return control;  // bit 7 of a mode word is set
    }
}

uint8_t I82c55a::read_port_a() {
    if (takes_a()) {
        if (!input_full_a) ++empty_read_count;
        input_full_a = false;
        return strobed[kA];
    }
    return (control & kInputA) != 0 ? outside[kA] : latch[kA];
}

uint8_t I82c55a::read_port_b() {
    if (mode_b() == Mode::strobed_input) {
        if (!input_full_b) ++empty_read_count;
        input_full_b = false;
        return strobed[kB];
    }
    return (control & kInputB) != 0 ? outside[kB] : latch[kB];
}

void I82c55a::write(uint16_t address, uint8_t value, uint64_t /*now_t*/) {
    const auto port = static_cast<uint8_t>(address & 3);
    if (port != kControlAddress) {
        write_port(port, value);
    } else if ((value & kModeSetFlag) != 0) {
        set_mode(value);
    } else {
        write_bit(value >> 1 & 7u, (value & 1) != 0);
    }
}

void I82c55a::write_port(uint8_t port, uint8_t value) {
    if (port == kC) {
        const uint8_t outputs = general_outputs();
        if (outputs == 0) ++input_write_count;
        latch[kC] = static_cast<uint8_t>((latch[kC] & ~outputs) | (value & outputs));
        return;
    }
    latch[port] = value;
    const bool gives = port == kA ? gives_a() : mode_b() == Mode::strobed_output;
    if (gives) {
        bool& full = port == kA ? output_full_a : output_full_b;
        if (full) ++output_overrun_count;
        full = true;
    } else if (port_output_mask(static_cast<Port>(port)) == 0) {
        ++input_write_count;
    }
}

void I82c55a::write_bit(unsigned bit, bool level) {
    const unsigned mask = bit_mask(bit);
    if ((handshake_pins() & mask) == 0) {
        if ((general_outputs() & mask) == 0) ++input_write_count;
        latch[kC] = static_cast<uint8_t>(level ? latch[kC] | mask : latch[kC] & ~mask);
        return;
    }
    switch (bit) {
        case kStrobeA:
            input_enable_a = level;
            break;
        case kAcknowledgeA:
            output_enable_a = level;
            break;
        case kControlB:
            enable_b = level;
            break;
        case kInputFullA:
            input_full_a = level;
            break;
        case kOutputFullA:
            output_full_a = !level;
            break;
        case kFullB:
            (mode_b() == Mode::strobed_input ? input_full_b : output_full_b) =
                mode_b() == Mode::strobed_input ? level : !level;
            break;
        default:
            break;  // INTR follows the other bits at all times
    }
}

void I82c55a::set_mode(uint8_t word) {
    control = word;
    latch.fill(0);
    strobed.fill(0);
    input_full_a = input_full_b = false;
    output_full_a = output_full_b = false;
    input_enable_a = output_enable_a = enable_b = false;
    follow_strobes();
}

void I82c55a::reset() {
    set_mode(kResetControl);
}

void I82c55a::set_port_input(Port port, uint8_t value, uint8_t mask, uint64_t /*now_t*/) {
    uint8_t& levels = outside[static_cast<unsigned>(port)];
    const uint8_t before = levels;
    levels = static_cast<uint8_t>((levels & ~mask) | (value & mask));
    if (port == Port::c) follow_control_edges(before);
    follow_strobes();
}

// An input latch is transparent while its strobe is low.
void I82c55a::follow_strobes() {
    if (takes_a() && !outside_c(kStrobeA)) strobed[kA] = outside[kA];
    if (mode_b() == Mode::strobed_input && !outside_c(kControlB)) strobed[kB] = outside[kB];
}

void I82c55a::follow_control_edges(uint8_t before) {
    const auto fallen = static_cast<uint8_t>(before & ~outside[kC]);
    const auto strobe = [this](bool& full) {
        if (full) ++strobe_overrun_count;
        full = true;
    };
    if (takes_a() && (fallen & bit_mask(kStrobeA)) != 0) strobe(input_full_a);
    if (gives_a() && (fallen & bit_mask(kAcknowledgeA)) != 0) output_full_a = false;
    if ((fallen & bit_mask(kControlB)) == 0) return;
    if (mode_b() == Mode::strobed_input) strobe(input_full_b);
    if (mode_b() == Mode::strobed_output) output_full_b = false;
}

Properties I82c55a::properties() const {
    constexpr std::array<const char*, 4> kModes = {"0", "1 input", "1 output", "2"};
    return {
        {"control", fmt::format("{:02X}h", control)},
        {"mode of group A", kModes[static_cast<unsigned>(mode_a())]},
        {"mode of group B", kModes[static_cast<unsigned>(mode_b())]},
        {"port A",
         fmt::format("{:02X}h, drives {:02X}h", port_level(Port::a), port_output_mask(Port::a))},
        {"port B",
         fmt::format("{:02X}h, drives {:02X}h", port_level(Port::b), port_output_mask(Port::b))},
        {"port C",
         fmt::format("{:02X}h, drives {:02X}h", port_level(Port::c), port_output_mask(Port::c))},
        {"interrupt requests",
         fmt::format("A {}, B {}", interrupt_a() ? 1 : 0, interrupt_b() ? 1 : 0)},
        {"strobes over an unread byte", fmt::format("{}", strobe_overrun_count)},
        {"bytes over an unacknowledged one", fmt::format("{}", output_overrun_count)},
        {"reads without a new byte", fmt::format("{}", empty_read_count)},
        {"writes that drive no pin", fmt::format("{}", input_write_count)},
    };
}

}  // namespace host_sim::chips
