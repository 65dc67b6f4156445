// disassemble.hpp - an instruction's bytes as text in Intel syntax.
// Depends on   toolchain/isa/instruction_set.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace toolchain::isa {

struct DisassembleOptions {
    /// Shows the ten undocumented opcodes as one-byte DB instead of their names.
    bool documented_only = false;
    /// Text for an address operand (JMP, CALL, LDA ...), for example a symbol. Empty: the number.
    std::function<std::string(uint16_t address)> address_text{};
};

struct Disassembly {
    std::string text;   ///< "LXI B,1234H"; "DB 0CBH" when the bytes are no instruction
    uint8_t bytes = 1;  ///< that the text stands for; with DB 1
};

/// The instruction at the start of `code`. Bytes behind it are not looked at; when operand bytes
/// are missing, the opcode byte is given as DB.
/// @param code  at least one byte
[[nodiscard]] Disassembly disassemble(std::span<const uint8_t> code,
                                      const DisassembleOptions& options = {});

/// A number as Intel's assemblers write it: `digits` hexadecimal digits and H, with a 0 in front
/// of a letter.
/// @param digits  2 or 4; larger values take more
[[nodiscard]] std::string intel_hex(unsigned value, int digits);

}  // namespace toolchain::isa
