// mir_print.cpp - the representation as text: b12 is a byte, [b1 b2] a value, low byte first.
// Depends on   mir.hpp.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <string_view>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

namespace {

constexpr std::array<const char*, 23> kOpcodeNames = {
    "add",  "sub",     "and",  "or",    "xor",  "shl",           "shr",          "sar",
    "sign", "compare", "load", "store", "call", "call_indirect", "port_in",      "port_out",
    "ei",   "di",      "hlt",  "rim",   "sim",  "nop",           "stack_address"};
constexpr std::array<const char*, 6> kPredicateNames = {"eq",        "ne",   "below",
                                                        "not_below", "less", "not_less"};

const char* name(Opcode opcode) {
    return kOpcodeNames[static_cast<std::size_t>(opcode)];
}

const char* name(Predicate predicate) {
    return kPredicateNames[static_cast<std::size_t>(predicate)];
}

std::string text(const Module& module, const Function& function, ByteId byte) {
    const ByteInfo& info = function.bytes[byte];
    switch (info.kind) {
        case ByteInfo::Kind::undefined:
            return "?";
        case ByteInfo::Kind::constant:
            return fmt::format("{:02X}", info.constant);
        case ByteInfo::Kind::address_low:
            return fmt::format("low({}{:+})", module.symbols[info.symbol], info.offset);
        case ByteInfo::Kind::address_high:
            return fmt::format("high({}{:+})", module.symbols[info.symbol], info.offset);
        case ByteInfo::Kind::computed:
        case ByteInfo::Kind::parameter:
            break;
    }
    return fmt::format("b{}", byte);
}

std::string text(const Module& module, const Function& function, const Bytes& bytes) {
    std::vector<std::string> parts;
    for (const ByteId byte : bytes) parts.push_back(text(module, function, byte));
    return fmt::format("[{}]", fmt::join(parts, " "));
}

/// " in HL E": the registers of a call's arguments or results.
std::string text(const char* word, const std::vector<Register>& registers) {
    constexpr std::string_view kLetters = "BCDEHLFA";
    std::string line;
    for (const Register which : registers) line += kLetters[static_cast<std::size_t>(which)];
    return line.empty() ? line : fmt::format(" {} {}", word, line);
}

std::string text(const Module& module, const Function& function, const Operation& operation) {
    std::string line = "    ";
    if (!operation.results.empty()) {
        line += fmt::format("{} = ", text(module, function, operation.results));
    }
    line += name(operation.opcode);
    if (operation.opcode == Opcode::compare) line += fmt::format(" {}", name(operation.predicate));
    if (operation.is_volatile) line += " volatile";
    if (operation.symbol != kNone) {
        line += fmt::format(" {}", module.symbols[operation.symbol]);
    }
    if (!operation.left.empty()) {
        line += fmt::format(" {}", text(module, function, operation.left));
    }
    if (!operation.right.empty()) {
        line += fmt::format(" {}", text(module, function, operation.right));
    }
    for (const Bytes& argument : operation.arguments) {
        line += fmt::format(" {}", text(module, function, argument));
    }
    line += text("in", operation.argument_registers);
    line += text("out", operation.result_registers);
    if (operation.reenters) line += " reenters";
    if (operation.immediate != 0) line += fmt::format(" #{}", operation.immediate);
    if (operation.opcode == Opcode::stack_address)
        line += fmt::format(" {}", operation.immediate16);
    return line + "\n";
}

std::string text(const Module& module, const Function& function, const Terminator& end) {
    std::string line;
    switch (end.kind) {
        case Terminator::Kind::jump:
            line = "    jump";
            break;
        case Terminator::Kind::branch:
            line = fmt::format("    if {} {} {}", name(end.predicate),
                               text(module, function, end.left), text(module, function, end.right));
            break;
        case Terminator::Kind::table:
            line = fmt::format("    table {}", text(module, function, end.left));
            break;
        case Terminator::Kind::give_back:
            line = fmt::format("    return {}", text(module, function, end.left));
            break;
        case Terminator::Kind::unreachable:
            line = "    unreachable";
            break;
    }
    for (const Edge& edge : end.edges) {
        line += fmt::format(" -> {}{}", edge.target, text(module, function, edge.arguments));
    }
    return line + "\n";
}

}  // namespace

std::string print(const Module& module, const Function& function) {
    std::string result = fmt::format("function {}", module.symbols[function.symbol]);
    if (function.interrupt >= 0) result += fmt::format(" interrupt {}", function.interrupt);
    result += text("in", function.parameter_registers);
    result += text("out", function.result_registers);
    if (function.recursive) result += fmt::format(" recursive, stack {}", function.stack_bytes);
    result += "\n";
    for (const FrameObject& object : function.frame) {
        result += fmt::format("  frame {} {}\n", module.symbols[object.symbol], object.size);
    }
    for (std::size_t i = 0; i < function.blocks.size(); ++i) {
        const Block& block = function.blocks[i];
        result += fmt::format("  {}{}:\n", i, text(module, function, block.parameters));
        for (const Operation& operation : block.operations) {
            result += text(module, function, operation);
        }
        result += text(module, function, block.terminator);
    }
    return result;
}

std::string print(const Module& module) {
    std::string result;
    for (const Function& function : module.functions) result += print(module, function);
    return result;
}

}  // namespace toolchain::codegen
