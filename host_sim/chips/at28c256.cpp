// at28c256.cpp - AT28C256: command recognition, page latches, programming.
#include "host_sim/chips/at28c256.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace host_sim::chips {
namespace {

constexpr uint16_t kAddressMask = At28c256::kSize - 1;
constexpr uint8_t kErased = 0xFF;

constexpr uint8_t kDataPollingBit = 0x80;
constexpr uint8_t kToggleBit = 0x40;

constexpr uint8_t kProtectCode = 0xA0;
constexpr uint8_t kSecondHalfCode = 0x80;  // three more bytes follow
constexpr uint8_t kUnprotectCode = 0x20;
constexpr uint8_t kEraseCode = 0x10;
constexpr uint8_t kCommandSize = 6;

// All commands write to the same addresses; the third and sixth byte tell them apart.
constexpr std::array<uint16_t, kCommandSize> kCommandAddresses = {0x5555, 0x2AAA, 0x5555,
                                                                  0x5555, 0x2AAA, 0x5555};

bool matches(uint8_t step, uint16_t address, uint8_t value) {
    if (address != kCommandAddresses[step]) return false;
    switch (step) {
        case 2:
            return value == kProtectCode || value == kSecondHalfCode;
        case 5:
            return value == kUnprotectCode || value == kEraseCode;
        default:
            return value == (step % 3 == 0 ? 0xAA : 0x55);
    }
}

// A cell whose programming was cut short. The part erases a byte before it programs it, so some
// bytes are half programmed and others still as they were; which ones is fixed, so that runs agree.
uint8_t half_done(uint32_t address, uint8_t before, uint8_t after) {
    return address % 2 == 0 ? static_cast<uint8_t>(after | 0xAA) : before;
}

}  // namespace

At28c256::At28c256(uint64_t clock_hz, uint64_t write_cycle_ns)
    : load_t(t_states_from_ns(kLoadTimeNs, clock_hz)),
      write_cycle_t(t_states_from_ns(write_cycle_ns, clock_hz)),
      erase_cycle_t(t_states_from_ns(kEraseCycleNs, clock_hz)),
      power_on_delay_t(t_states_from_ns(kPowerOnDelayNs, clock_hz)) {
    contents.fill(kErased);
}

void At28c256::load(std::span<const uint8_t> bytes, uint16_t address) {
    if (address + bytes.size() > kSize) {
        throw std::length_error(
            fmt::format("{} bytes at {:04X}h do not fit into the 32768 bytes of an AT28C256; "
                        "shorten the image",
                        bytes.size(), address));
    }
    std::copy(bytes.begin(), bytes.end(), contents.begin() + address);
    active = false;
}

void At28c256::power_off(uint64_t now_t) {
    advance(now_t);
    if (!active) return;
    active = false;
    if (now_t < window_end_t) return;  // only loaded: the latches are lost, the cells untouched
    take_held();
    ++interrupted_count;
    if (command == Command::erase) {
        for (uint32_t i = 0; i < kSize; ++i) contents[i] = half_done(i, contents[i], kErased);
        for (uint32_t& count : page_writes) ++count;
    } else if (latched != 0 && may_program()) {
        for (uint32_t i = 0; i < kPageSize; ++i) {
            uint8_t& cell = contents[page * kPageSize + i];
            if ((latched >> i & 1) != 0) cell = half_done(i, cell, latches[i]);
        }
        ++page_writes[page];
    }
}

void At28c256::power_on(uint64_t now_t) {
    advance(now_t);
    writable_t = now_t + power_on_delay_t;
}

uint8_t At28c256::read(uint16_t address, uint64_t now_t) {
    advance(now_t);
    if (!active) return contents[address & kAddressMask];
    const auto polling =
        static_cast<uint8_t>((~last_value & kDataPollingBit) | (toggle ? kToggleBit : 0) |
                             (last_value & ~(kDataPollingBit | kToggleBit)));
    toggle = !toggle;
    return polling;
}

void At28c256::write(uint16_t address, uint8_t value, uint64_t now_t) {
    advance(now_t);
    const auto cell = static_cast<uint16_t>(address & kAddressMask);
    const bool too_late = active && now_t >= window_end_t;
    if (now_t < writable_t || too_late) {
        ++(too_late ? busy_write_count : power_on_write_count);
        last_ignored_address = cell;
        return;
    }
    if (!active) begin();
    window_end_t = now_t + load_t;
    cycle_end_t = window_end_t + write_cycle_t;
    last_value = value;
    take(cell, value, now_t);
}

void At28c256::advance(uint64_t now_t) {
    if (active && now_t >= cycle_end_t) complete();
}

void At28c256::begin() {
    active = true;
    latches.fill(0);
    latched = 0;
    held_count = 0;
    command_open = true;
    command = Command::none;
    toggle = true;
}

void At28c256::take(uint16_t address, uint8_t value, uint64_t now_t) {
    if (!command_open || !matches(held_count, address, value)) {
        take_held();
        load_byte(address, value);
        return;
    }
    if (held_count == 2) held_third = value;
    ++held_count;
    if (held_count == 3 && value == kProtectCode) {
        command = Command::protect;
    } else if (held_count == kCommandSize) {
        command = value == kEraseCode ? Command::erase : Command::unprotect;
    } else {
        return;
    }
    command_open = false;
    held_count = 0;
    if (command == Command::erase) {  // no byte may follow
        window_end_t = now_t;
        cycle_end_t = now_t + erase_cycle_t;
    }
}

// The beginning of a command that was not continued is data.
void At28c256::take_held() {
    command_open = false;
    for (uint8_t step = 0; step < held_count; ++step) {
        const uint8_t value = step == 2 ? held_third : step % 3 == 0 ? 0xAA : 0x55;
        load_byte(kCommandAddresses[step], value);
    }
    held_count = 0;
}

void At28c256::load_byte(uint16_t address, uint8_t value) {
    const auto new_page = static_cast<uint16_t>(address / kPageSize);
    if (latched != 0 && new_page != page) ++page_crossing_count;
    page = new_page;
    latches[address % kPageSize] = value;
    latched |= uint64_t{1} << address % kPageSize;
    if (!may_program()) {
        ++protected_write_count;
        last_ignored_address = address;
    }
}

bool At28c256::may_program() const {
    return !write_protected || command != Command::none;
}

void At28c256::complete() {
    take_held();
    active = false;
    ++cycle_count;
    if (command == Command::erase) {
        contents.fill(kErased);
        for (uint32_t& count : page_writes) ++count;
        return;
    }
    if (latched != 0 && may_program()) {
        for (uint32_t i = 0; i < kPageSize; ++i) {
            if ((latched >> i & 1) != 0) contents[page * kPageSize + i] = latches[i];
        }
        ++page_writes[page];
    }
    if (command != Command::none) write_protected = command == Command::protect;
}

Properties At28c256::properties() const {
    const uint32_t most = *std::max_element(page_writes.begin(), page_writes.end());
    return {
        {"state", !active ? "idle" : fmt::format("cycle until T {}", cycle_end_t)},
        {"data protection", write_protected ? "on" : "off"},
        {"page being loaded", fmt::format("{:04X}h", page * kPageSize)},
        {"cycles completed", fmt::format("{}", cycle_count)},
        {"cycles cut short by power", fmt::format("{}", interrupted_count)},
        {"most cycles of a page", fmt::format("{}", most)},
        {"writes ignored: busy", fmt::format("{}", busy_write_count)},
        {"writes ignored: protected", fmt::format("{}", protected_write_count)},
        {"writes ignored: after power-on", fmt::format("{}", power_on_write_count)},
        {"last ignored address", fmt::format("{:04X}h", last_ignored_address)},
        {"loads across a page", fmt::format("{}", page_crossing_count)},
    };
}

}  // namespace host_sim::chips
