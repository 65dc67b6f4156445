// probe_avr.cpp - the probe on an ATmega2560, where int has 16 bits; runs in simavr.
// Output   the first serial port, which simavr copies to its log.
// Source   register addresses: ATmega640/1280/2560 data sheet, "Register Summary".
#include "probe.hpp"

static_assert(sizeof(int) == 2, "the other side of the comparison needs a 16 bit int");

namespace {

constexpr uint16_t kUcsr0a = 0xC0;
constexpr uint16_t kUcsr0b = 0xC1;
constexpr uint16_t kUdr0 = 0xC6;
constexpr uint8_t kTransmitBufferEmpty = 1u << 5;  // UDRE0 in UCSR0A
constexpr uint8_t kTransmitterOn = 1u << 3;        // TXEN0 in UCSR0B

volatile uint8_t& io_register(uint16_t address) {
    return *reinterpret_cast<volatile uint8_t*>(address);
}

void put(char byte) {
    while ((io_register(kUcsr0a) & kTransmitBufferEmpty) == 0) {
    }
    io_register(kUdr0) = static_cast<uint8_t>(byte);
}

void put_text(const char* text) {
    for (; *text != '\0'; ++text) put(*text);
}

}  // namespace

void probe::report(const char* name, uint32_t checksum) {
    put_text("probe ");
    put_text(name);
    put(' ');
    for (uint8_t digit = 0; digit < 8; ++digit) {
        const auto nibble = rover::narrow_wrap_u8(rover::shift_floor<28>(checksum));
        put("0123456789abcdef"[nibble]);
        checksum = rover::shift_left_wrap<4>(checksum);
    }
    put('\n');
}

// extern "C": a freestanding main is an ordinary function, but the C start-up code calls this one.
extern "C" int main() {
    io_register(kUcsr0b) = kTransmitterOn;
    probe::run_groups();
    put_text("probe end\n");
    // The simulator ends when the processor sleeps with interrupts off.
    __asm__ volatile("cli\n sleep");
    return 0;
}
