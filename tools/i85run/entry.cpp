#include "tools/i85run/entry.hpp"

#include <fmt/format.h>

namespace i85run {
namespace {

constexpr uint16_t kHighestRomByte = 0x7FFF;
constexpr uint8_t kHalt = 0x76;

/// The highest byte from `first` down to 0 that neither the image nor the return address at `sp`
/// occupies.
std::optional<uint16_t> free_byte(const host_sim::Image& image, uint16_t first, uint16_t sp) {
    for (unsigned below = first + 1U; below > 0; --below) {
        const auto address = static_cast<uint16_t>(below - 1);
        const bool stack = address == sp || address == static_cast<uint16_t>(sp + 1);
        if (!image.present[address] && !stack) return address;
    }
    return std::nullopt;
}

}  // namespace

std::optional<uint16_t> enter_program(Machine& machine, const Program& program,
                                      const Options& options) {
    const host_sim::Image& image = program.image;
    for (std::size_t address = 0; address < host_sim::kAddressSpaceSize; ++address) {
        if (image.present[address]) machine.memory.bytes[address] = image.bytes[address];
    }
    machine.cpu.pc = start_address(program, options);
    machine.cpu.sp = options.sp.value_or(0);

    const auto low = static_cast<uint16_t>(machine.cpu.sp - 2);
    const auto high = static_cast<uint16_t>(machine.cpu.sp - 1);
    std::optional<uint16_t> trap = free_byte(image, kHighestRomByte, low);
    if (!trap) trap = free_byte(image, 0xFFFF, low);
    if (image.present[low] || image.present[high] || !trap) {
        if (options.entry.empty() && !options.sp) return std::nullopt;
        throw host_sim::ImageError(
            image.file, 0,
            fmt::format("occupies {:04X}h, where the return address of the entry would be", low),
            "give --sp ADDR with two free bytes below it");
    }
    machine.add_trap(*trap);
    machine.cpu.sp = low;
    machine.memory.bytes[low] = static_cast<uint8_t>(*trap);
    machine.memory.bytes[high] = static_cast<uint8_t>(*trap >> 8);
    return trap;
}

bool return_is_lost(const Machine& machine, uint16_t trap) {
    return machine.memory.bytes[trap] != kHalt;
}

}  // namespace i85run
