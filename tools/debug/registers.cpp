// registers.cpp - see registers.hpp.
#include "tools/debug/registers.hpp"

#include <fmt/format.h>

#include <array>

#include "hal/board/rb85.hpp"
#include "tools/debug/arguments.hpp"
#include "tools/debug/debug_error.hpp"

namespace debug_console {

using host_sim::CpuState;
using host_sim::Pin;
namespace flag = host_sim::flag;

namespace {

struct Name {
    std::string_view name;
    Register which;
    int64_t max;  ///< -1: cannot be set
};

constexpr std::array kNames = {
    Name{"A", Register::a, 0xFF},
    Name{"F", Register::f, 0xFF},
    Name{"B", Register::b, 0xFF},
    Name{"C", Register::c, 0xFF},
    Name{"D", Register::d, 0xFF},
    Name{"E", Register::e, 0xFF},
    Name{"H", Register::h, 0xFF},
    Name{"L", Register::l, 0xFF},
    Name{"BC", Register::bc, 0xFFFF},
    Name{"DE", Register::de, 0xFFFF},
    Name{"HL", Register::hl, 0xFFFF},
    Name{"PSW", Register::psw, 0xFFFF},
    Name{"SP", Register::sp, 0xFFFF},
    Name{"PC", Register::pc, 0xFFFF},
    Name{"$", Register::pc, 0xFFFF},
    Name{"S", Register::sign, 1},
    Name{"Z", Register::zero, 1},
    Name{"K", Register::k, 1},
    Name{"AC", Register::auxiliary_carry, 1},
    Name{"P", Register::parity, 1},
    Name{"V", Register::v, 1},
    Name{"CY", Register::carry, 1},
    Name{"IE", Register::interrupt_enable, 1},
    Name{"MASKS", Register::masks, 7},
    Name{"T", Register::t, -1},
    Name{"N", Register::instructions, -1},
};

/// The flag's bit; 0 when `which` is no flag.
uint8_t flag_bit(Register which) {
    switch (which) {
        case Register::sign:
            return flag::kSign;
        case Register::zero:
            return flag::kZero;
        case Register::k:
            return flag::kK;
        case Register::auxiliary_carry:
            return flag::kAuxiliaryCarry;
        case Register::parity:
            return flag::kParity;
        case Register::v:
            return flag::kV;
        case Register::carry:
            return flag::kCarry;
        default:
            return 0;
    }
}

/// The 8-bit register; null when `which` is none.
template <class Cpu>
auto* byte_register(Cpu& cpu, Register which) {
    switch (which) {
        case Register::a:
            return &cpu.a;
        case Register::f:
            return &cpu.f;
        case Register::b:
            return &cpu.b;
        case Register::c:
            return &cpu.c;
        case Register::d:
            return &cpu.d;
        case Register::e:
            return &cpu.e;
        case Register::h:
            return &cpu.h;
        case Register::l:
            return &cpu.l;
        case Register::masks:
            return &cpu.masks;
        default:
            return decltype(&cpu.a){nullptr};
    }
}

void set_pair(uint8_t& high, uint8_t& low, int64_t value) {
    high = static_cast<uint8_t>(value >> 8);
    low = static_cast<uint8_t>(value & 0xFF);
}

void set_word(CpuState& cpu, Register which, int64_t value) {
    switch (which) {
        case Register::bc:
            return set_pair(cpu.b, cpu.c, value);
        case Register::de:
            return set_pair(cpu.d, cpu.e, value);
        case Register::hl:
            return set_pair(cpu.h, cpu.l, value);
        case Register::psw:
            set_pair(cpu.a, cpu.f, value);
            cpu.f &= static_cast<uint8_t>(~flag::kUnused);
            return;
        case Register::sp:
            cpu.sp = static_cast<uint16_t>(value);
            return;
        default:
            cpu.pc = static_cast<uint16_t>(value);
            cpu.halted = false;
            return;
    }
}

std::string join(const std::string& list, std::string_view word) {
    return list.empty() ? std::string(word) : list + " " + std::string(word);
}

}  // namespace

std::optional<Register> find_register(std::string_view name) {
    for (const Name& entry : kNames) {
        if (same_word(entry.name, name)) return entry.which;
    }
    return std::nullopt;
}

int64_t register_value(const CpuState& cpu, Register which) {
    if (const uint8_t* byte = byte_register(cpu, which)) return *byte;
    if (const uint8_t bit = flag_bit(which)) return (cpu.f & bit) != 0 ? 1 : 0;
    switch (which) {
        case Register::bc:
            return cpu.bc();
        case Register::de:
            return cpu.de();
        case Register::hl:
            return cpu.hl();
        case Register::psw:
            return cpu.a << 8 | cpu.f;
        case Register::sp:
            return cpu.sp;
        case Register::pc:
            return cpu.pc;
        case Register::interrupt_enable:
            return cpu.interrupt_enable ? 1 : 0;
        case Register::t:
            return static_cast<int64_t>(cpu.t);
        case Register::instructions:
            return static_cast<int64_t>(cpu.instructions);
        default:
            return 0;
    }
}

void set_register(CpuState& cpu, Register which, int64_t value) {
    for (const Name& entry : kNames) {
        if (entry.which != which) continue;
        if (entry.max < 0) throw DebugError(fmt::format("{} cannot be set", entry.name));
        if (value < 0 || value > entry.max) {
            throw DebugError(
                fmt::format("{} does not fit: {} holds 0 to {}", value, entry.name, entry.max));
        }
        break;
    }
    if (uint8_t* byte = byte_register(cpu, which)) {
        *byte = static_cast<uint8_t>(value);
        cpu.f &= static_cast<uint8_t>(~flag::kUnused);
    } else if (const uint8_t bit = flag_bit(which)) {
        cpu.f = static_cast<uint8_t>(value != 0 ? cpu.f | bit : cpu.f & ~bit);
    } else if (which == Register::interrupt_enable) {
        cpu.interrupt_enable = value != 0;
    } else {
        set_word(cpu, which, value);
    }
}

std::string flags_text(uint8_t f) {
    const auto bit = [f](uint8_t which) { return (f & which) != 0 ? 1 : 0; };
    return fmt::format("S{} Z{} K{} AC{} P{} V{} CY{}", bit(flag::kSign), bit(flag::kZero),
                       bit(flag::kK), bit(flag::kAuxiliaryCarry), bit(flag::kParity), bit(flag::kV),
                       bit(flag::kCarry));
}

std::string masks_text(uint8_t masks) {
    std::string list;
    if ((masks & host_sim::mask::kRst75) != 0) list = join(list, "7.5");
    if ((masks & host_sim::mask::kRst65) != 0) list = join(list, "6.5");
    if ((masks & host_sim::mask::kRst55) != 0) list = join(list, "5.5");
    return list.empty() ? "none" : list;
}

std::string pending_text(const CpuState& cpu) {
    std::string list;
    if (cpu.trap_latch && cpu.pin(Pin::trap).level) list = join(list, "TRAP");
    if (cpu.rst75_latch) list = join(list, "7.5");
    if (cpu.pin(Pin::rst65).level) list = join(list, "6.5");
    if (cpu.pin(Pin::rst55).level) list = join(list, "5.5");
    return list.empty() ? "none" : list;
}

std::string time_text(uint64_t t) {
    return fmt::format("T {} ({:.3f} ms)", t, 1e3 * static_cast<double>(t) / hal::rb85::kClockHz);
}

}  // namespace debug_console
