// select_calls.cpp - calls: of functions, through pointers, of the processor's own instructions.
// Depends on   selector.hpp.
#include <fmt/format.h>
#include <llvm/IR/InlineAsm.h>
#include <llvm/IR/IntrinsicInst.h>

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

Bytes Selector::select_call(const llvm::CallBase& call) {
    const llvm::Function* callee = call.getCalledFunction();
    if (callee != nullptr && callee->isIntrinsic()) {
        switch (callee->getIntrinsicID()) {
            case llvm::Intrinsic::lifetime_start:
            case llvm::Intrinsic::lifetime_end:
            case llvm::Intrinsic::dbg_declare:
            case llvm::Intrinsic::dbg_value:
            case llvm::Intrinsic::dbg_label:
            case llvm::Intrinsic::assume:
            case llvm::Intrinsic::experimental_noalias_scope_decl:
                return {};
            default:
                refuse(call, fmt::format("'{}' is not supported", callee->getName().str()));
        }
    }
    if (call.isInlineAsm())
        refuse(call, "inline assembly is not supported; use the functions of i85.h");
    if (call.getFunctionType()->isVarArg())
        refuse(call, "a variable number of arguments needs a stack frame");
    if (callee != nullptr && callee->getName().starts_with("__i85_")) {
        return select_processor(callee->getName().str(), call);
    }
    std::vector<Bytes> arguments;
    for (const llvm::Use& argument : call.args()) arguments.push_back(value(argument.get()));
    const std::size_t result_size = call.getType()->isVoidTy() ? 0 : size_of(call.getType());
    if (callee != nullptr) {
        return builder_.call(out_.intern(callee->getName().str()), std::move(arguments),
                             result_size);
    }
    return builder_.call_indirect(value(call.getCalledOperand()), std::move(arguments),
                                  result_size);
}

}  // namespace toolchain::ir
