// opcode_lookup.hpp - the table entry for a mnemonic and its operands as text.
// Internal     to parse.cpp.      Depends on   toolchain/isa.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::assembly {

/// Finds an instruction.
/// @param mnemonic  upper case; the second names of undocumented instructions count too
/// @param number    value of an operand that has to be one (RST n)
/// @return          nullptr: there is no such mnemonic
/// @errors          Mistake: the mnemonic does not take these operands
[[nodiscard]] const isa::Instruction* find_instruction(
    std::string_view mnemonic, std::span<const std::string> operands,
    const std::function<int(std::string_view)>& number);

}  // namespace toolchain::assembly
