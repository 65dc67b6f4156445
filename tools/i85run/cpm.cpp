#include "tools/i85run/cpm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace i85run {
namespace {

constexpr uint16_t kWarmBoot = 0x0000;
constexpr uint16_t kBiosWarmBoot = 0xFF03;  ///< second entry of the BIOS jump table
constexpr uint16_t kBdos = 0x0005;
constexpr uint8_t kVersion = 0x22;
constexpr int kEndOfFile = 0x1A;  ///< what CP/M programs take for the end of a text

/// Functions of the BDOS, by their number in C.
enum Function : uint8_t {
    kReset = 0,
    kConsoleInput = 1,
    kConsoleOutput = 2,
    kDirectConsole = 6,
    kPrintString = 9,
    kReadLine = 10,
    kConsoleStatus = 11,
    kGetVersion = 12,
};

void store_word(Machine& machine, uint16_t address, uint16_t word) {
    machine.memory.bytes[address] = static_cast<uint8_t>(word);
    machine.memory.bytes[address + 1U] = static_cast<uint8_t>(word >> 8);
}

/// The BDOS returns a byte in A and L, the high part in B and H.
void return_word(host_sim::CpuState& cpu, uint16_t word) {
    cpu.a = cpu.l = static_cast<uint8_t>(word);
    cpu.b = cpu.h = static_cast<uint8_t>(word >> 8);
}

/// Functions on files, which find no disk. The others that are not modelled return 0.
bool is_file_function(uint8_t function) {
    return (15 <= function && function <= 23) || function == 30 ||
           (33 <= function && function <= 36) || function == 40;
}

/// An unused file control block: default drive, a name of spaces.
void blank_file_control_block(Machine& machine, uint16_t address) {
    std::fill_n(machine.memory.bytes.begin() + address + 1, 11, static_cast<uint8_t>(' '));
}

}  // namespace

void Cpm::start(Machine& machine, std::span<const uint8_t> program) {
    assert(program.size() <= kCpmProgramBytesMax);
    std::ranges::copy(program, machine.memory.bytes.begin() + kCpmProgramStart);
    store_word(machine, 0x0001, kBiosWarmBoot);
    store_word(machine, 0x0006, kCpmMemoryTop);
    blank_file_control_block(machine, 0x005C);
    blank_file_control_block(machine, 0x006C);
    for (const uint16_t trap : {kWarmBoot, kBiosWarmBoot, kBdos, kCpmMemoryTop}) {
        machine.add_trap(trap);
    }
    machine.cpu.pc = kCpmProgramStart;
    machine.cpu.sp = kCpmMemoryTop - 2;
    store_word(machine, machine.cpu.sp, kWarmBoot);
}

bool Cpm::serve_trap(Machine& machine, host_sim::StepRecord& record) {
    const bool bdos = machine.cpu.pc == kBdos || machine.cpu.pc == kCpmMemoryTop;
    if (!bdos || !call_bdos(machine)) return false;
    constexpr uint8_t kRet = 0xC9;
    machine.execute_instead(kRet, record);
    return true;
}

bool Cpm::call_bdos(Machine& machine) {
    host_sim::CpuState& cpu = machine.cpu;
    switch (cpu.c) {
        case kReset:
            return false;
        case kConsoleInput:
            return_word(cpu, read_key());
            break;
        case kConsoleOutput:
            console_.put(static_cast<char>(cpu.e));
            break;
        case kDirectConsole:
            if (cpu.e == 0xFF) {
                return_word(cpu, 0);
            } else {
                console_.put(static_cast<char>(cpu.e));
            }
            break;
        case kPrintString:
            print_string(machine);
            break;
        case kReadLine:
            read_line(machine);
            break;
        case kConsoleStatus:
            return_word(cpu, 0);
            break;
        case kGetVersion:
            return_word(cpu, kVersion);
            break;
        default:
            report_unsupported(machine);
            return_word(cpu, is_file_function(cpu.c) ? 0x00FF : 0);
    }
    return true;
}

uint8_t Cpm::read_key() {
    const int key = console_.get();
    if (key < 0) return kEndOfFile;
    if (console_.echo) console_.put(static_cast<char>(key));
    return static_cast<uint8_t>(key & 0x7F);
}

/// DE points at a buffer: its size, the count of characters read, the characters.
void Cpm::read_line(Machine& machine) {
    auto& bytes = machine.memory.bytes;
    const uint16_t buffer = machine.cpu.de();
    const auto at = [buffer](unsigned offset) { return static_cast<uint16_t>(buffer + offset); };
    const unsigned size = bytes[at(0)];
    unsigned count = 0;
    while (count < size) {
        const int key = console_.get();
        if (key < 0 || key == '\r') break;
        bytes[at(2 + count++)] = static_cast<uint8_t>(key & 0x7F);
    }
    bytes[at(1)] = static_cast<uint8_t>(count);
}

void Cpm::report_unsupported(const Machine& machine) {
    const uint8_t function = machine.cpu.c;
    if (!unsupported_.insert(function).second) return;
    console_.warn(
        fmt::format("BDOS function {} is not supported; it {} (first called at T {})", function,
                    is_file_function(function) ? "reports an error" : "returns 0", machine.cpu.t));
}

void Cpm::print_string(const Machine& machine) {
    uint16_t address = machine.cpu.de();
    for (unsigned count = 0; count < 0x10000; ++count) {
        const uint8_t byte = machine.memory.bytes[address++];
        if (byte == '$') return;
        console_.put(static_cast<char>(byte));
    }
    console_.warn(fmt::format("BDOS function 9 at T {}: the string at {:04X}h has no '$'",
                              machine.cpu.t, machine.cpu.de()));
}

}  // namespace i85run
