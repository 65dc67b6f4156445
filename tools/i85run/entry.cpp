#include "tools/i85run/entry.hpp"

#include <fmt/format.h>

namespace i85run {
namespace {

constexpr uint16_t kHighestRomByte = 0x7FFF;
constexpr uint16_t kHighestByte = 0xFFFF;
constexpr uint8_t kHalt = 0x76;

/// The highest byte of the ROM half that the image leaves free, else FFFFh.
uint16_t trap_address(const host_sim::Image& image) {
    for (unsigned behind = kHighestRomByte + 1U; behind > 0; --behind) {
        if (!image.present[behind - 1]) return static_cast<uint16_t>(behind - 1);
    }
    return kHighestByte;
}

}  // namespace

std::optional<uint16_t> enter_program(Machine& machine, const Program& program,
                                      const Options& options) {
    const host_sim::Image& image = program.image;
    for (std::size_t address = 0; address < host_sim::kAddressSpaceSize; ++address) {
        if (image.present[address]) machine.memory.bytes[address] = image.bytes[address];
    }
    machine.cpu.pc = start_address(program, options);
    const uint16_t trap = trap_address(image);
    machine.cpu.sp = options.sp.value_or(trap == kHighestByte ? kHighestByte : uint16_t{0});

    const auto low = static_cast<uint16_t>(machine.cpu.sp - 2);
    const auto high = static_cast<uint16_t>(machine.cpu.sp - 1);
    const bool on_trap = low == trap || high == trap;
    if (image.present[low] || image.present[high] || image.present[trap] || on_trap) {
        if (options.entry.empty() && !options.sp) return std::nullopt;
        throw host_sim::ImageError(
            image.file, 0,
            fmt::format("leaves no room for the return address of the entry at {:04X}h{}", low,
                        image.present[trap] ? " and for the byte it points to" : ""),
            "leave a byte below 8000h free, and give --sp ADDR with two free bytes below it");
    }
    machine.add_trap(trap);
    machine.cpu.sp = low;
    machine.memory.bytes[low] = static_cast<uint8_t>(trap);
    machine.memory.bytes[high] = static_cast<uint8_t>(trap >> 8);
    return trap;
}

bool return_is_lost(const Machine& machine, uint16_t trap) {
    return machine.memory.bytes[trap] != kHalt;
}

}  // namespace i85run
