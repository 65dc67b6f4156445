// select_calls.cpp - calls: of functions, through pointers, of the processor's own instructions.
// Depends on   selector.hpp.
#include <fmt/format.h>
#include <llvm/IR/IntrinsicInst.h>

#include <algorithm>
#include <array>

#include "toolchain/ir/selector.hpp"

namespace toolchain::ir {

using codegen::Bytes;
using codegen::Opcode;

namespace {

/// Functions of the header i85.h that are single instructions.
struct ProcessorCall {
    const char* name;
    Opcode opcode;
    bool has_port;
};
constexpr std::array<ProcessorCall, 8> kProcessorCalls = {{
    {"__i85_in", Opcode::port_in, true},
    {"__i85_out", Opcode::port_out, true},
    {"__i85_ei", Opcode::enable_interrupts, false},
    {"__i85_di", Opcode::disable_interrupts, false},
    {"__i85_hlt", Opcode::halt, false},
    {"__i85_rim", Opcode::read_mask, false},
    {"__i85_sim", Opcode::set_mask, false},
    {"__i85_nop", Opcode::no_operation, false},
}};

}  // namespace

Bytes Selector::runtime(const std::string& name, std::vector<Bytes> arguments,
                        std::size_t result_size) {
    return builder_.call(out_.intern(name), std::move(arguments), result_size);
}

Bytes Selector::select_processor(const std::string& name, const llvm::CallBase& call) {
    const std::size_t result_size = call.getType()->isVoidTy() ? 0 : size_of(call.getType());
    for (const ProcessorCall& known : kProcessorCalls) {
        if (name != known.name) continue;
        uint8_t port = 0;
        unsigned next = 0;
        if (known.has_port) {
            const auto* number = llvm::dyn_cast<llvm::ConstantInt>(call.getArgOperand(next++));
            if (number == nullptr) {
                refuse(call,
                       "a port number must be known at compile time: IN and OUT have it in the "
                       "instruction");
            }
            port = static_cast<uint8_t>(number->getZExtValue());
        }
        const Bytes operand = next < call.arg_size() ? value(call.getArgOperand(next)) : Bytes{};
        return builder_.processor(known.opcode, port, operand, result_size);
    }
    refuse(call, fmt::format("'{}' is not an instruction of the 8085; i85.h lists them", name));
}

Bytes Selector::select_intrinsic(const llvm::IntrinsicInst& call) {
    if (call.isDebugOrPseudoInst()) return {};
    if (call.getIntrinsicID() == llvm::Intrinsic::bswap) {
        Bytes bytes = value(call.getArgOperand(0));
        std::reverse(bytes.begin(), bytes.end());
        return bytes;
    }
    refuse(call, fmt::format("'{}' is not supported", call.getCalledFunction()->getName().str()));
}

Bytes Selector::select_call(const llvm::CallBase& call) {
    if (const auto* intrinsic = llvm::dyn_cast<llvm::IntrinsicInst>(&call)) {
        return select_intrinsic(*intrinsic);
    }
    if (call.isInlineAsm()) return {};  // an empty one; others are refused before
    const auto* callee =
        llvm::dyn_cast<llvm::Function>(call.getCalledOperand()->stripPointerCastsAndAliases());
    if (callee != nullptr && callee->getName().starts_with("__i85_")) {
        return select_processor(callee->getName().str(), call);
    }
    std::vector<Bytes> arguments;
    for (const llvm::Use& argument : call.args()) arguments.push_back(value(argument.get()));
    std::size_t result_size = call.getType()->isVoidTy() ? 0 : size_of(call.getType());
    if (callee == nullptr) {
        return builder_.call_indirect(value(call.getCalledOperand()), std::move(arguments),
                                      result_size);
    }
    if (!callee->isDeclaration()) {
        check_prototype(call, *callee);
        const llvm::Type* type = callee->getReturnType();
        result_size = type->isVoidTy() ? 0 : size_of(type);
    }
    return builder_.call(out_.intern(callee->getName().str()), std::move(arguments), result_size);
}

// Calls through another type happen in C without prototypes.
void Selector::check_prototype(const llvm::CallBase& call, const llvm::Function& callee) const {
    const auto size = [&](const llvm::Type* type) { return type->isVoidTy() ? 0 : size_of(type); };
    bool fits = call.arg_size() == callee.arg_size() &&
                (call.use_empty() || size(call.getType()) == size(callee.getReturnType()));
    for (unsigned i = 0; fits && i < call.arg_size(); ++i) {
        fits = size(call.getArgOperand(i)->getType()) == size(callee.getArg(i)->getType());
    }
    if (!fits) {
        refuse(call, fmt::format("'{}' is called with other parameters than it has: declare it",
                                 callee.getName().str()));
    }
}

}  // namespace toolchain::ir
