// i82c54.cpp - see i82c54.hpp.
#include "host_sim/chips/i82c54.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace host_sim::chips {

namespace {

using Counter = I82c54::Counter;

constexpr uint8_t kStatusOutput = 0x80;
constexpr uint8_t kStatusNullCount = 0x40;
constexpr uint8_t kControlBits = 0x3F;
constexpr uint8_t kReadBackNoCount = 0x20;  // both active low
constexpr uint8_t kReadBackNoStatus = 0x10;
constexpr unsigned kReadBack = 3;  // counter number of the read-back command

enum class Access : uint8_t { latch, lsb, msb, lsb_then_msb };

Access access_of(uint8_t control) {
    return static_cast<Access>(control >> 4 & 3);
}

/// Modes 6 and 7 are 2 and 3 (data sheet, control word format: X10, X11).
unsigned mode_of(const Counter& c) {
    const unsigned bits = c.control >> 1 & 7U;
    return bits > 5 ? bits - 4 : bits;
}
bool is_bcd(const Counter& c) {
    return (c.control & 1) != 0;
}
uint32_t modulus_of(const Counter& c) {
    return is_bcd(c) ? 10'000 : 65'536;
}
bool is_periodic(const Counter& c) {
    return mode_of(c) == 2 || mode_of(c) == 3;
}
bool is_strobe(const Counter& c) {
    return mode_of(c) >= 4;
}
/// Modes 1 and 5: triggers load, the gate's level does not stop the count.
bool is_hardware(const Counter& c) {
    return mode_of(c) == 1 || mode_of(c) == 5;
}

/// Whether the next CLK pulse loads the counter.
bool loads_next(const Counter& c) {
    return c.load_pending || (c.trigger && c.count != 0);
}
bool is_counting(const Counter& c) {
    return c.loaded && !c.inhibited && (c.gate || is_hardware(c));
}

void start_cycle(Counter& c) {
    c.load_pending = false;
    c.null_count = false;
    c.loaded = true;
    c.cycle_count = c.count;
}

/// Modes 0, 1, 4, 5: down to 0 once, then on around without effect.
void count_once(Counter& c, uint64_t pulses) {
    const bool loads = loads_next(c);
    c.trigger = false;
    c.output = c.output || is_strobe(c);  // a strobe ends with the next pulse, whatever the gate
    if (loads) {
        start_cycle(c);
        c.value = c.count;
        c.expired = false;
        c.output = is_strobe(c);
        --pulses;
    }
    if (!is_counting(c) || pulses == 0) {
        return;
    }
    if (!c.expired) {
        const uint64_t counted = std::min<uint64_t>(pulses, c.value);
        c.value -= static_cast<uint32_t>(counted);
        pulses -= counted;
        if (c.value != 0) {
            return;
        }
        c.expired = true;
        c.output = !is_strobe(c);
        if (pulses == 0) {
            return;
        }
        c.output = true;
    }
    const uint32_t modulus = modulus_of(c);
    c.value = static_cast<uint32_t>((c.value + modulus - pulses % modulus) % modulus);
}

/// Mode 2: one cycle, low at 1. Mode 3: a half cycle; the high one is longer for an odd count.
/// A count of 1 is illegal; here the output then stays high.
void start_part(Counter& c, bool low_half) {
    start_cycle(c);
    c.low_half = low_half && mode_of(c) == 3 && c.count > 1;
    if (mode_of(c) == 2) {
        c.value = c.count;
    } else {
        c.value = c.low_half ? c.count / 2 : (c.count + 1) / 2;
    }
}

void count_periodic(Counter& c, uint64_t pulses) {
    const bool loads = loads_next(c);
    c.trigger = false;
    if (loads) {
        start_part(c, false);
        --pulses;
    }
    if (!is_counting(c)) {
        return;  // the gate, when it fell, has set the output high
    }
    if (pulses >= c.value) {
        pulses -= c.value;
        start_part(c, !c.low_half);
        pulses %= c.cycle_count;  // whole cycles change nothing
        if (pulses >= c.value) {
            pulses -= c.value;
            start_part(c, !c.low_half);
        }
    }
    c.value -= static_cast<uint32_t>(pulses);
    c.output = mode_of(c) == 2 ? c.value > 1 || c.cycle_count == 1 : !c.low_half;
}

void count(Counter& c, uint64_t pulses) {
    if (pulses == 0 || !c.programmed) {
        return;
    }
    if (is_periodic(c)) {
        count_periodic(c, pulses);
    } else {
        count_once(c, pulses);
    }
}

/// CLK pulses until OUT changes, kNever if nothing but an access or the gate changes it.
uint64_t pulses_to_change(const Counter& c) {
    if (!c.programmed) {
        return kNever;
    }
    if (is_periodic(c)) {
        const bool is_rate = mode_of(c) == 2;
        if (loads_next(c)) {
            if (!c.gate || c.count < 2) {
                return kNever;
            }
            return is_rate ? c.count : 1 + (c.count + 1) / 2;
        }
        if (!is_counting(c)) {
            return kNever;
        }
        const bool to_high = !c.output;
        if (is_rate && c.cycle_count > 1) {
            return to_high ? 1 : c.value - 1;
        }
        if (c.count == 1) {
            return to_high ? c.value : kNever;
        }
        return is_rate ? c.value + c.count - 1 : c.value;
    }
    const bool loads = loads_next(c);
    if ((is_strobe(c) && !c.output) || (loads && mode_of(c) == 1 && c.output)) {
        return 1;
    }
    if (loads) {
        return (c.gate || is_hardware(c)) && !c.inhibited ? 1 + uint64_t{c.count} : kNever;
    }
    return is_counting(c) && !c.expired ? c.value : kNever;
}

uint16_t bcd_from(uint32_t number) {
    return static_cast<uint16_t>(number / 1000 << 12 | number / 100 % 10 << 8 |
                                 number / 10 % 10 << 4 | number % 10);
}

/// The counting element as the bus sees it.
uint16_t count_bits(const Counter& c) {
    if (!c.loaded) {
        return I82c54::kUndefinedCount;
    }
    uint32_t number = c.value;
    if (mode_of(c) == 3) {  // counts down by two from the even part of the count
        const bool odd_high = c.cycle_count % 2 == 1 && !c.low_half;
        number = 2 * (c.value - (odd_high ? 1 : 0));
    }
    number %= modulus_of(c);
    return is_bcd(c) ? bcd_from(number) : static_cast<uint16_t>(number);
}

uint8_t status_bits(const Counter& c) {
    return static_cast<uint8_t>((c.output ? kStatusOutput : 0) |
                                (c.null_count ? kStatusNullCount : 0) | c.control);
}

std::string describe(const Counter& c) {
    if (!c.programmed) {
        return "not programmed";
    }
    constexpr std::array<const char*, 4> kAccessNames{"", "LSB", "MSB", "LSB+MSB"};
    const std::string clock = c.clock_period_t == 0 ? std::string("external clock")
                                                    : fmt::format("clock {} T", c.clock_period_t);
    return fmt::format("mode {} {} {}, {}, gate {}, register {}, count {:04X}h{}{}, OUT {}",
                       mode_of(c), is_bcd(c) ? "BCD" : "binary",
                       kAccessNames[static_cast<unsigned>(access_of(c.control))], clock,
                       c.gate ? 1 : 0, c.count, count_bits(c), c.loaded ? "" : " (undefined)",
                       c.null_count ? ", null count" : "", c.output ? 1 : 0);
}

}  // namespace

void I82c54::reset() {
    for (Counter& c : counters) {
        Counter fresh;
        fresh.clock_period_t = c.clock_period_t;
        fresh.next_pulse_t = c.next_pulse_t;
        fresh.gate = c.gate;
        fresh.watched = c.watched;
        c = fresh;
    }
    find_event();
}

void I82c54::advance(uint64_t now_t) {
    if (now_t <= last_t) {
        return;
    }
    last_t = now_t;
    for (Counter& c : counters) {
        if (now_t < c.next_pulse_t) {
            continue;
        }
        const uint64_t span = now_t - c.next_pulse_t;
        const uint64_t pulses = 1 + (c.clock_period_t == 1 ? span : span / c.clock_period_t);
        c.next_pulse_t += pulses * c.clock_period_t;
        count(c, pulses);
    }
    if (now_t >= event_t) {
        find_event();
    }
}

void I82c54::find_event() {
    event_t = kNever;
    for (const Counter& c : counters) {
        if (c.clock_period_t == 0 || !c.watched) {
            continue;
        }
        const uint64_t pulses = pulses_to_change(c);
        if (pulses == kNever || c.clock_period_t > (kNever - c.next_pulse_t) / pulses) {
            continue;  // never, or behind the end of time
        }
        event_t = std::min(event_t, c.next_pulse_t + (pulses - 1) * c.clock_period_t);
    }
}

void I82c54::set_periodic_clock(unsigned counter, uint64_t period_t, uint64_t phase_t) {
    Counter& c = counters[counter];
    c.clock_period_t = period_t;
    const uint64_t past = (last_t % period_t + period_t - phase_t % period_t) % period_t;
    c.next_pulse_t = last_t + (period_t - past);
    find_event();
}

void I82c54::set_external_clock(unsigned counter) {
    counters[counter].clock_period_t = 0;
    counters[counter].next_pulse_t = kNever;
    find_event();
}

void I82c54::clock_pulses(unsigned counter, uint64_t pulse_count, uint64_t now_t) {
    advance(now_t);
    count(counters[counter], pulse_count);
}

void I82c54::set_gate(unsigned counter, bool level, uint64_t now_t) {
    advance(now_t);
    Counter& c = counters[counter];
    if (level == c.gate) {
        return;
    }
    c.gate = level;
    if (c.programmed && level && (is_periodic(c) || is_hardware(c))) {
        c.trigger = true;
    }
    if (c.programmed && !level && is_periodic(c)) {
        c.output = true;  // at once, no CLK pulse needed
    }
    find_event();
}

void I82c54::watch_output(unsigned counter, bool watched) {
    counters[counter].watched = watched;
    find_event();
}

uint64_t I82c54::output_period_t(unsigned counter) const {
    const Counter& c = counters[counter];
    const bool runs = c.programmed && is_periodic(c) && c.gate && c.count > 1;
    return runs ? c.count * c.clock_period_t : 0;
}

uint8_t I82c54::read(uint16_t address, uint64_t now_t) {
    advance(now_t);
    if ((address & 3) == kControlAddress) {
        return kOpenBus;
    }
    Counter& c = counters[address & 3];
    if (c.status_latched) {
        c.status_latched = false;
        return c.latched_status;
    }
    if (!c.programmed) {
        ++unprogrammed_access_count;
        return kUndefinedCount & 0xFF;
    }
    uint16_t bits = c.latched_count;
    if (!c.count_latched) {
        bits = count_bits(c);
        undefined_read_count += c.loaded ? 0 : 1;
        ++live_read_count;
    }
    const Access access = access_of(c.control);
    const bool msb = access == Access::msb || (access == Access::lsb_then_msb && c.read_msb);
    if (access == Access::lsb_then_msb) {
        c.read_msb = !c.read_msb;
    }
    if (!c.read_msb) {
        c.count_latched = false;
    }
    return static_cast<uint8_t>(msb ? bits >> 8 : bits);
}

void I82c54::write(uint16_t address, uint8_t value, uint64_t now_t) {
    advance(now_t);
    if ((address & 3) == kControlAddress) {
        write_control(value);
    } else {
        write_count(counters[address & 3], value);
    }
    find_event();
}

// Whoever latches status and count together sees by the null count bit that there is no count yet.
void I82c54::latch_count(Counter& c, bool status_tells) {
    if (c.count_latched) {
        ++lost_latch_count;
        return;
    }
    if (!c.programmed) {
        ++unprogrammed_access_count;
        return;
    }
    undefined_read_count += c.loaded || status_tells ? 0 : 1;
    c.count_latched = true;
    c.latched_count = count_bits(c);
}

void I82c54::write_control(uint8_t value) {
    const unsigned selected = value >> 6;
    if (selected == kReadBack) {
        for (unsigned index = 0; index < kCounterCount; ++index) {
            Counter& c = counters[index];
            if ((value >> (index + 1) & 1) == 0) {
                continue;
            }
            const bool status = (value & kReadBackNoStatus) == 0;
            if (status) {
                lost_latch_count += c.status_latched ? 1 : 0;
                c.latched_status = c.status_latched ? c.latched_status : status_bits(c);
                c.status_latched = true;
            }
            if ((value & kReadBackNoCount) == 0) {
                latch_count(c, status);
            }
        }
        return;
    }
    Counter& c = counters[selected];
    if (access_of(value) == Access::latch) {
        latch_count(c, false);
        return;
    }
    // A control word resets all control logic at once; no CLK pulse is needed.
    Counter fresh;
    fresh.clock_period_t = c.clock_period_t;
    fresh.next_pulse_t = c.next_pulse_t;
    fresh.gate = c.gate;
    fresh.watched = c.watched;
    fresh.programmed = true;
    fresh.control = value & kControlBits;
    fresh.null_count = true;
    fresh.output = mode_of(fresh) != 0;
    c = fresh;
}

void I82c54::write_count(Counter& c, uint8_t value) {
    if (!c.programmed) {
        ++unprogrammed_access_count;
        return;
    }
    switch (access_of(c.control)) {
        case Access::lsb:
            take_count(c, value);
            break;
        case Access::msb:
            take_count(c, static_cast<uint16_t>(value << 8));
            break;
        case Access::lsb_then_msb:
            c.write_msb = !c.write_msb;
            if (!c.write_msb) {
                take_count(c, static_cast<uint16_t>(value << 8 | c.written_lsb));
                break;
            }
            c.written_lsb = value;
            if (mode_of(c) == 0) {  // the first byte stops the count and sets OUT low at once
                c.inhibited = true;
                c.output = false;
            }
            break;
        case Access::latch:
            break;  // is a command, never a counter's programming
    }
}

/// A complete count: the register takes it now, the counting element when its mode says so.
void I82c54::take_count(Counter& c, uint16_t bits) {
    uint32_t number = bits;
    if (is_bcd(c)) {
        number = 0;
        bool legal = true;
        for (unsigned shift = 16; shift != 0; shift -= 4) {
            const uint32_t digit = uint32_t{bits} >> (shift - 4) & 0xFU;
            legal = legal && digit <= 9;
            number = number * 10 + digit;
        }
        illegal_count_count += legal ? 0 : 1;
    }
    const uint32_t modulus = modulus_of(c);
    c.count = number % modulus == 0 ? modulus : number % modulus;
    c.null_count = true;
    illegal_count_count += is_periodic(c) && c.count == 1 ? 1U : 0U;
    switch (mode_of(c)) {
        case 0:
            c.inhibited = false;
            c.output = false;
            c.load_pending = true;
            break;
        case 4:
            c.load_pending = true;
            break;
        case 2:
        case 3:
            c.load_pending = !c.loaded;  // later counts wait for the cycle's end or a trigger
            break;
        default:
            break;  // modes 1 and 5: a trigger loads
    }
}

Properties I82c54::properties() const {
    Properties list;
    for (unsigned index = 0; index < kCounterCount; ++index) {
        list.push_back({fmt::format("counter {}", index), describe(counters[index])});
    }
    const auto add = [&list](const char* name, uint64_t number) {
        list.push_back({name, std::to_string(number)});
    };
    add("accesses before control word", unprogrammed_access_count);
    add("reads of an undefined count", undefined_read_count);
    add("reads without latch", live_read_count);
    add("illegal counts", illegal_count_count);
    add("latches lost", lost_latch_count);
    return list;
}

}  // namespace host_sim::chips
