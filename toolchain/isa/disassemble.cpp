// disassemble.cpp - see disassemble.hpp.
#include "toolchain/isa/disassemble.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::isa {
namespace {

std::string operand_text(Operand operand, std::span<const uint8_t> code,
                         const DisassembleOptions& options) {
    if (operand == Operand::data8 || operand == Operand::port8) return intel_hex(code[1], 2);
    const auto word = static_cast<uint16_t>(code[1] | code[2] << 8);
    if (operand == Operand::address16 && options.address_text) {
        std::string text = options.address_text(word);
        if (!text.empty()) return text;
    }
    return intel_hex(word, 4);
}

}  // namespace

std::string intel_hex(unsigned value, int digits) {
    std::string text = fmt::format("{:0{}X}H", value, digits);
    return text.front() > '9' ? '0' + text : text;
}

Disassembly disassemble(std::span<const uint8_t> code, const DisassembleOptions& options) {
    if (code.empty()) throw std::invalid_argument("disassemble: no bytes");
    const Instruction& entry = instruction(code[0]);
    if (code.size() < entry.bytes || (options.documented_only && !entry.documented)) {
        return {"DB " + intel_hex(code[0], 2), 1};
    }
    std::string text(entry.text());
    if (entry.operand != Operand::none) {
        text.resize(text.find_last_of(" ,") + 1);  // the placeholder comes last
        text += operand_text(entry.operand, code, options);
    }
    return {std::move(text), entry.bytes};
}

}  // namespace toolchain::isa
