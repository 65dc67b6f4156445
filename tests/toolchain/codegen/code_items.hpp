// code_items.hpp - finished code by hand: an instruction, a jump, a label in one word each.
// Depends on   toolchain/codegen/machine.hpp.
#pragma once

#include <cstdint>

#include "toolchain/codegen/machine.hpp"

namespace codegen_test {

using toolchain::codegen::CodeItem;
using toolchain::codegen::CodeOperand;

inline CodeItem item(uint8_t opcode, CodeOperand operand = {}) {
    CodeItem result;
    result.opcode = opcode;
    result.operand = operand;
    return result;
}
/// With a number of one or two bytes.
inline CodeItem number(uint8_t opcode, int32_t value) {
    return item(opcode, {CodeOperand::Kind::number, CodeOperand::Part::word, 0, value});
}
/// With the address of a byte of the frame.
inline CodeItem slot(uint8_t opcode, int32_t offset) {
    return item(opcode, {CodeOperand::Kind::frame, CodeOperand::Part::word, 0, offset});
}
inline CodeItem jump(uint8_t opcode, uint32_t label) {
    return item(opcode, {CodeOperand::Kind::label, CodeOperand::Part::word, label, 0});
}
inline CodeItem label(uint32_t id) {
    CodeItem result = jump(0, id);
    result.kind = CodeItem::Kind::label;
    return result;
}

}  // namespace codegen_test
