// instruction_set.hpp - the 256 opcodes of the 8085: names, bytes, T-states, bus cycles, flags.
// Source       Intel MCS-80/85 Family User's Manual (1979), tables of the 8085A instruction set;
//              undocumented ones: W. Dehnhardt, V. Sorensen, "Unspecified 8085 op codes enhance
//              programming", Electronics, January 1979; Tundra CA80C85B data sheet.
// Depends on   the standard library.
// Independent  of every interpreter, so that it can check them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace toolchain::isa {

/// Kinds of machine cycle. A fetch of 6 T-states reads as one of 4 does, at the same T-state.
enum class BusCycle : uint8_t {
    fetch4,
    fetch6,
    memory_read,  ///< 3 T: an operand byte of the instruction, or data
    memory_write,
    io_read,
    io_write,
    bus_idle,  ///< 3 T without a transfer; of HLT 1 T
};

/// The machine cycles of an instruction in their order.
struct BusCycles {
    std::array<BusCycle, 5> kinds{};
    uint8_t count = 0;

    [[nodiscard]] std::span<const BusCycle> list() const { return {kinds.data(), count}; }
    bool operator==(const BusCycles&) const = default;
};

/// Bits of the flag byte as PUSH PSW stores it. K and V are undocumented by Intel.
namespace flag {
inline constexpr uint8_t kSign = 0x80;
inline constexpr uint8_t kZero = 0x40;
inline constexpr uint8_t kK = 0x20;
inline constexpr uint8_t kAuxiliaryCarry = 0x10;
inline constexpr uint8_t kParity = 0x04;
inline constexpr uint8_t kV = 0x02;
inline constexpr uint8_t kCarry = 0x01;
}  // namespace flag

/// What follows the opcode byte. Sixteen-bit operands come low byte first.
enum class Operand : uint8_t { none, data8, data16, address16, port8 };

/// Where execution goes on. Conditional ones have t_taken > t_not_taken.
enum class Flow : uint8_t { next, jump, call, restart, ret, jump_hl, halt };

/// One opcode.
struct Instruction {
    std::array<char, 12> text_storage{};
    uint8_t text_size = 0;
    uint8_t mnemonic_size = 0;

    uint8_t opcode = 0;
    uint8_t bytes = 1;
    Operand operand = Operand::none;
    uint8_t t_not_taken = 0;  ///< T-states without wait states; for unconditional ones both agree
    uint8_t t_taken = 0;
    BusCycles cycles_not_taken{};
    BusCycles cycles_taken{};
    uint8_t flags = 0;            ///< bits of the flag byte that it may change
    uint8_t flags_unsettled = 0;  ///< those among `flags` on which published sources disagree
    bool documented = true;       ///< by Intel
    Flow flow = Flow::next;
    std::string_view alternate_mnemonic{};  ///< a second name in use, or empty

    /// Intel mnemonic and operands, as "MOV B,C" or "LXI B,d16". Placeholders: d8 and d16 data, a16
    /// address, p8 port.
    [[nodiscard]] std::string_view text() const { return {text_storage.data(), text_size}; }
    [[nodiscard]] std::string_view mnemonic() const { return text().substr(0, mnemonic_size); }
    /// Behind the mnemonic: "B,d16", or empty.
    [[nodiscard]] std::string_view operands() const {
        return mnemonic_size == text_size ? std::string_view() : text().substr(mnemonic_size + 1u);
    }
    [[nodiscard]] bool conditional() const { return t_taken != t_not_taken; }
};

/// The table, indexed by opcode.
[[nodiscard]] std::span<const Instruction, 256> instruction_set();

[[nodiscard]] inline const Instruction& instruction(uint8_t opcode) {
    return instruction_set()[opcode];
}

}  // namespace toolchain::isa
