// machine.hpp - registers of the 8085, and machine code before it has addresses.
// Depends on   the standard library.
#pragma once

#include <cstdint>
#include <vector>

namespace toolchain::codegen {

/// Numbered as in the opcodes; 6 stands for memory there and for the flags in a RegisterSet.
enum class Register : uint8_t { b = 0, c = 1, d = 2, e = 3, h = 4, l = 5, flags = 6, a = 7 };

/// A set of registers: bit 1 << number.
using RegisterSet = uint8_t;
inline constexpr RegisterSet kAllRegisters = 0xFF;

[[nodiscard]] constexpr RegisterSet set_of(Register which) {
    return static_cast<RegisterSet>(1U << static_cast<unsigned>(which));
}

/// What an instruction refers to.
struct CodeOperand {
    enum class Kind : uint8_t {
        none,
        number,  ///< offset
        symbol,  ///< symbol `id` of the module plus offset
        frame,   ///< the function's slots plus offset
        label,   ///< label `id` of the function
    };
    enum class Part : uint8_t { word, low, high };
    Kind kind = Kind::none;
    Part part = Part::word;
    uint32_t id = 0;
    int32_t offset = 0;

    bool operator==(const CodeOperand&) const = default;
};

/// One instruction, label, word of a jump table or remark.
struct CodeItem {
    enum class Kind : uint8_t {
        instruction,
        label,       ///< operand.id
        word,        ///< operand: an entry of a jump table
        loop_bound,  ///< operand.offset: the loop that begins here
    };
    Kind kind = Kind::instruction;
    uint8_t opcode = 0;
    CodeOperand operand{};
    uint32_t file = UINT32_MAX;  ///< index into Module::files
    uint32_t line = 0;
    RegisterSet reads = 0;   ///< of a call: registers with arguments
    RegisterSet writes = 0;  ///< of a call: results and what it destroys
};

/// A call from a function.
struct CallSite {
    uint32_t symbol = UINT32_MAX;     ///< function or routine
    uint32_t signature = UINT32_MAX;  ///< of a call through a pointer
    uint32_t pushed = 0;              ///< bytes on the stack then, without the return address
    bool jumps = false;               ///< there is none: the callee returns in its caller's place
};

/// A function as machine code. What it does not touch keeps its value.
struct FunctionCode {
    std::vector<CodeItem> items{};
    uint32_t frame_bytes = 0;  ///< of slots; FrameObjects come on top
    uint32_t stack_bytes = 0;  ///< pushed at most, calls and the return address left out
    RegisterSet clobbers = 0;  ///< its callees' included
    std::vector<CallSite> calls{};
};

}  // namespace toolchain::codegen
