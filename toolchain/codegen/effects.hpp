// effects.hpp - what an instruction reads and writes, for passes over finished code.
// Depends on   machine.hpp, toolchain/isa.
#pragma once

#include <cstdint>

#include "toolchain/codegen/machine.hpp"

namespace toolchain::codegen {

/// A set of registers and flags: bits 0 to 5 and 7 as in RegisterSet.
using ResourceSet = uint16_t;

namespace resource {
inline constexpr ResourceSet kSign = 1U << 6;   ///< S, Z, AC and P
inline constexpr ResourceSet kCarry = 1U << 8;  ///< CY
inline constexpr ResourceSet kK = 1U << 9;      ///< undocumented: of JK and JNK
inline constexpr ResourceSet kA = 1U << 7;
inline constexpr ResourceSet kBc = 0x03, kDe = 0x0C, kHl = 0x30;
inline constexpr ResourceSet kFlags = kSign | kCarry | kK;
inline constexpr ResourceSet kAll = 0x3FF;

/// Of registers that stand in a RegisterSet; its bit for the flags is all of them.
[[nodiscard]] constexpr ResourceSet of(RegisterSet set) {
    return static_cast<ResourceSet>(set | ((set & set_of(Register::flags)) != 0 ? kFlags : 0U));
}
[[nodiscard]] constexpr ResourceSet of(unsigned which) {
    return static_cast<ResourceSet>(1U << which);
}
}  // namespace resource

enum class MemoryAccess : uint8_t { none, read, write, read_write };

struct Effects {
    ResourceSet reads = 0;
    ResourceSet writes = 0;
    MemoryAccess memory = MemoryAccess::none;  ///< of data; PUSH, POP and CALL left out
    uint8_t pointer = 0xFF;                    ///< pair with the address: 0, 1, 2; else the operand
    uint8_t size = 1;                          ///< bytes that are read or written
    bool pure = false;  ///< registers and flags are all that it changes, and it reads no memory
};

/// Of an instruction by itself; a call's are in its CodeItem.
[[nodiscard]] Effects effects_of(const CodeItem& item);

}  // namespace toolchain::codegen
