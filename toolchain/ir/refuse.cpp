// refuse.cpp - see refuse.hpp.
#include "toolchain/ir/refuse.hpp"

#include <fmt/format.h>
#include <llvm/IR/DebugInfoMetadata.h>
#include <llvm/IR/GlobalIFunc.h>
#include <llvm/IR/InlineAsm.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/IntrinsicInst.h>
#include <llvm/IR/Module.h>

#include <algorithm>
#include <vector>

namespace toolchain::ir {

namespace {

constexpr const char* kNoFloat = "floating point: the 8085 has none; use a Q format";

/// Why a type cannot be, or nothing.
const char* objection(llvm::Type* type) {
    if (type->isFloatingPointTy()) return kNoFloat;
    if (type->isVectorTy()) return "a vector: compile without vectorisation";
    // LLVM makes products of up to twice 64 bits of its own accord.
    if (type->isIntegerTy() && type->getIntegerBitWidth() > 128) {
        return "an integer of more than 128 bits";
    }
    if (type->isPointerTy() && type->getPointerAddressSpace() != 0) {
        return "an address space: the 8085 has one memory; ports are read with __i85_in";
    }
    if (type->isArrayTy()) return objection(type->getArrayElementType());
    if (auto* structure = llvm::dyn_cast<llvm::StructType>(type)) {
        for (llvm::Type* element : structure->elements()) {
            if (const char* why = objection(element)) return why;
        }
    }
    return nullptr;
}

bool is_atomic_word(const llvm::Instruction& instruction, llvm::Type* type) {
    const auto& layout = instruction.getModule()->getDataLayout();
    return instruction.isAtomic() && layout.getTypeStoreSize(type) != llvm::TypeSize::getFixed(1);
}

const char* objection_to_call(const llvm::CallBase& call) {
    if (const auto* assembly = llvm::dyn_cast<llvm::InlineAsm>(call.getCalledOperand())) {
        // An empty one is a barrier to the optimiser.
        if (assembly->getAsmString().empty() && call.getType()->isVoidTy()) return nullptr;
        return "inline assembly: use the functions of i85.h";
    }
    switch (call.getIntrinsicID()) {
        case llvm::Intrinsic::not_intrinsic:
            break;
        case llvm::Intrinsic::vastart:
        case llvm::Intrinsic::vaend:
        case llvm::Intrinsic::vacopy:
            return "a variable argument list: frames are static; pass a pointer and a count";
        case llvm::Intrinsic::stacksave:
        case llvm::Intrinsic::stackrestore:
            return "a variable whose size is known only at run time: frames are static";
        default:
            return nullptr;
    }
    if (call.getFunctionType()->isVarArg() &&
        call.arg_size() > call.getFunctionType()->getNumParams()) {
        return "a call with a variable number of arguments: frames are static";
    }
    return nullptr;
}

const char* objection(const llvm::Instruction& instruction) {
    using Code = llvm::Instruction;
    switch (instruction.getOpcode()) {
        case Code::VAArg:
            return "a variable argument list: frames are static; pass a pointer and a count";
        case Code::IndirectBr:
        case Code::CallBr:
            return "a computed goto: use a switch";
        case Code::Invoke:
        case Code::LandingPad:
        case Code::Resume:
        case Code::CleanupPad:
        case Code::CatchPad:
        case Code::CatchSwitch:
            return "an exception: compile with -fno-exceptions";
        case Code::AtomicRMW:
        case Code::AtomicCmpXchg:
            return "an atomic read-modify-write: disable interrupts around it";
        case Code::AddrSpaceCast:
            return "an address space: the 8085 has one memory";
        case Code::Alloca: {
            const auto& variable = llvm::cast<llvm::AllocaInst>(instruction);
            if (!variable.isStaticAlloca()) {
                return "a variable whose size is known only at run time: frames are static";
            }
            return objection(variable.getAllocatedType());
        }
        case Code::Load:
            if (is_atomic_word(instruction, instruction.getType())) {
                return "an atomic load of more than a byte: disable interrupts around it";
            }
            break;
        case Code::Store:
            if (is_atomic_word(instruction, instruction.getOperand(0)->getType())) {
                return "an atomic store of more than a byte: disable interrupts around it";
            }
            break;
        default:
            break;
    }
    if (const auto* call = llvm::dyn_cast<llvm::CallBase>(&instruction)) {
        if (const char* why = objection_to_call(*call)) return why;
    }
    if (const char* why = objection(instruction.getType())) return why;
    for (const llvm::Use& operand : instruction.operands()) {
        llvm::Type* type = operand->getType();
        if (type->isMetadataTy() || type->isLabelTy() || type->isTokenTy()) continue;
        if (const char* why = objection(type)) return why;
    }
    return nullptr;
}

class Objections {
public:
    void add(const std::string& line) {
        constexpr std::size_t kMost = 20;
        if (lines_.size() < kMost && std::find(lines_.begin(), lines_.end(), line) == lines_.end())
            lines_.push_back(line);
    }

    void check(const llvm::GlobalVariable& variable) {
        if (variable.getName().starts_with("llvm.")) return;
        const char* why = objection(variable.getValueType());
        if (variable.isThreadLocal()) why = "thread_local: there is one thread";
        if (variable.getAddressSpace() != 0) why = "an address space: the 8085 has one memory";
        if (why == nullptr) return;
        add(fmt::format("{}: in {}: {}", place_text(variable), variable.getName().str(), why));
    }

    void check(const llvm::Function& function) {
        if (function.isDeclaration()) return;
        const auto complain = [&](const std::string& where, const char* why) {
            add(fmt::format("{}: in {}: {}", where, function.getName().str(), why));
        };
        if (function.isVarArg()) {
            complain(place_text(function),
                     "a variable argument list: frames are static; pass a pointer and a count");
        }
        for (const llvm::Argument& argument : function.args()) {
            if (const char* why = objection(argument.getType()))
                complain(place_text(function), why);
        }
        for (const llvm::Instruction& instruction : llvm::instructions(function)) {
            if (instruction.isDebugOrPseudoInst()) continue;
            if (const char* why = objection(instruction)) complain(place_text(instruction), why);
        }
    }

    void report() const {
        if (lines_.empty()) return;
        std::string text = lines_.front();
        for (std::size_t i = 1; i < lines_.size(); ++i) text += "\n" + lines_[i];
        throw Refused(text);
    }

private:
    std::vector<std::string> lines_;
};

}  // namespace

std::string place_text(const llvm::Function& function) {
    if (const llvm::DISubprogram* place = function.getSubprogram()) {
        return fmt::format("{}:{}", place->getFilename().str(), place->getLine());
    }
    return function.getParent()->getSourceFileName();
}

std::string place_text(const llvm::Instruction& instruction) {
    const llvm::DebugLoc& place = instruction.getDebugLoc();
    // Line 0: made by the compiler from several lines.
    if (!place || place.getLine() == 0) return place_text(*instruction.getFunction());
    return fmt::format("{}:{}", place->getFilename().str(), place.getLine());
}

std::string place_text(const llvm::GlobalVariable& variable) {
    llvm::SmallVector<llvm::DIGlobalVariableExpression*, 1> places;
    variable.getDebugInfo(places);
    if (places.empty()) return variable.getParent()->getSourceFileName();
    const llvm::DIGlobalVariable* place = places.front()->getVariable();
    return fmt::format("{}:{}", place->getFilename().str(), place->getLine());
}

void refuse(const llvm::Instruction& instruction, const std::string& what) {
    throw Refused(fmt::format("{}: in {}: {}", place_text(instruction),
                              instruction.getFunction()->getName().str(), what));
}

void refuse_unsupported(const llvm::Module& module) {
    Objections objections;
    for (const llvm::GlobalIFunc& function : module.ifuncs()) {
        objections.add(fmt::format("{}: in {}: an ifunc: there is one processor",
                                   module.getSourceFileName(), function.getName().str()));
    }
    for (const llvm::GlobalVariable& variable : module.globals()) objections.check(variable);
    for (const llvm::Function& function : module) objections.check(function);
    objections.report();
}

}  // namespace toolchain::ir
