// select.cpp - blocks, phis, terminators, memory; the rest of Selector is in select_*.cpp.
#include "toolchain/ir/select.hpp"

#include <fmt/format.h>
#include <llvm/ADT/PostOrderIterator.h>
#include <llvm/IR/CFG.h>
#include <llvm/IR/DebugInfoMetadata.h>
#include <llvm/IR/InstrTypes.h>
#include <llvm/IR/Module.h>

#include "toolchain/ir/constants.hpp"
#include "toolchain/ir/constructors.hpp"
#include "toolchain/ir/selector.hpp"

namespace toolchain::ir {

using codegen::Bytes;
using codegen::Predicate;

Selector::Selector(codegen::Module& out, const llvm::Function& function)
    : out_(out), function_(function), layout_(function.getParent()->getDataLayout()) {}

codegen::Function Selector::run() {
    result_.symbol = out_.intern(function_.getName().str());
    result_.result_size = function_.getReturnType()->isVoidTy()
                              ? 0
                              : static_cast<uint32_t>(size_of(function_.getReturnType()));
    if (function_.hasFnAttribute("interrupt")) {
        result_.interrupt =
            std::stoi(function_.getFnAttribute("interrupt").getValueAsString().str());
    }
    make_blocks();
    const llvm::ReversePostOrderTraversal<const llvm::Function*> order(&function_);
    for (const llvm::BasicBlock* block : order) fill_block(*block);
    for (const llvm::BasicBlock* block : order) {
        builder_.set_block(blocks_.at(block));
        select_terminator(*block->getTerminator());
    }
    return std::move(result_);
}

// A value that flows around a loop is used before its definition is translated only by phis, and
// their edges are made last. The entry block has the function's parameters.
void Selector::make_blocks() {
    result_.blocks.emplace_back();
    for (const llvm::Argument& argument : function_.args()) {
        const Bytes bytes = builder_.parameter(size_of(argument.getType()));
        values_[&argument] = bytes;
        result_.parameters.push_back(bytes);
        Bytes& parameters = result_.blocks[0].parameters;
        parameters.insert(parameters.end(), bytes.begin(), bytes.end());
    }
    const llvm::ReversePostOrderTraversal<const llvm::Function*> order(&function_);
    for (const llvm::BasicBlock* block : order) {
        if (block != &function_.getEntryBlock()) result_.blocks.emplace_back();
        const auto id = static_cast<codegen::BlockId>(result_.blocks.size() - 1);
        blocks_[block] = id;
        for (const llvm::PHINode& phi : block->phis()) {
            const Bytes bytes = builder_.parameter(size_of(phi.getType()));
            values_[&phi] = bytes;
            Bytes& parameters = result_.blocks[id].parameters;
            parameters.insert(parameters.end(), bytes.begin(), bytes.end());
        }
    }
}

void Selector::fill_block(const llvm::BasicBlock& block) {
    builder_.set_block(blocks_.at(&block));
    for (const llvm::Instruction& instruction : block) {
        if (instruction.isTerminator() || llvm::isa<llvm::PHINode>(instruction)) continue;
        builder_.set_place(place_of(instruction));
        select_instruction(instruction);
    }
}

void Selector::select_instruction(const llvm::Instruction& instruction) {
    Bytes result;
    if (const auto* binary = llvm::dyn_cast<llvm::BinaryOperator>(&instruction)) {
        result = select_binary(*binary);
    } else if (const auto* cast = llvm::dyn_cast<llvm::CastInst>(&instruction)) {
        result = select_cast(*cast);
    } else if (const auto* compare = llvm::dyn_cast<llvm::ICmpInst>(&instruction)) {
        result = select_compare(*compare);
    } else if (const auto* load = llvm::dyn_cast<llvm::LoadInst>(&instruction)) {
        result = builder_.load(value(load->getPointerOperand()), size_of(load->getType()),
                               load->isVolatile());
    } else if (const auto* store = llvm::dyn_cast<llvm::StoreInst>(&instruction)) {
        builder_.store(value(store->getPointerOperand()), value(store->getValueOperand()),
                       store->isVolatile());
    } else if (const auto* address = llvm::dyn_cast<llvm::GetElementPtrInst>(&instruction)) {
        result = select_address(*address);
    } else if (const auto* call = llvm::dyn_cast<llvm::CallInst>(&instruction)) {
        result = select_call(*call);
    } else if (const auto* freeze = llvm::dyn_cast<llvm::FreezeInst>(&instruction)) {
        result = value(freeze->getOperand(0));
    } else if (const auto* variable = llvm::dyn_cast<llvm::AllocaInst>(&instruction)) {
        const auto size = variable->getAllocationSize(layout_);
        if (!size || !variable->isStaticAlloca()) {
            refuse(
                instruction,
                "a variable whose size is known only at run time has no place in a static frame");
        }
        const auto symbol = out_.intern(
            fmt::format("{}@frame.{}", function_.getName().str(), result_.frame.size()));
        result_.frame.push_back({symbol, static_cast<uint32_t>(size->getFixedValue())});
        result = builder_.address(symbol, 0);
    } else if (const auto* extract = llvm::dyn_cast<llvm::ExtractValueInst>(&instruction)) {
        const Bytes whole = value(extract->getAggregateOperand());
        const auto from = whole.begin() + offset_of(extract->getAggregateOperand()->getType(),
                                                    extract->getIndices());
        result.assign(from, from + static_cast<std::ptrdiff_t>(size_of(extract->getType())));
    } else if (const auto* insert = llvm::dyn_cast<llvm::InsertValueInst>(&instruction)) {
        result = value(insert->getAggregateOperand());
        const Bytes part = value(insert->getInsertedValueOperand());
        std::copy(part.begin(), part.end(),
                  result.begin() + offset_of(insert->getType(), insert->getIndices()));
    } else {
        refuse(instruction, fmt::format("'{}' is not supported", instruction.getOpcodeName()));
    }
    values_[&instruction] = result;
}

// Byte offset of an element of a first-class aggregate.
std::ptrdiff_t Selector::offset_of(const llvm::Type* type, llvm::ArrayRef<unsigned> indices) const {
    std::size_t offset = 0;
    for (const unsigned index : indices) {
        if (const auto* structure = llvm::dyn_cast<llvm::StructType>(type)) {
            auto* mutable_structure =
                const_cast<llvm::StructType*>(structure);  // the layout is cached in it
            offset += layout_.getStructLayout(mutable_structure)->getElementOffset(index);
            type = structure->getElementType(index);
        } else {
            type = type->getArrayElementType();
            offset += index * layout_.getTypeAllocSize(const_cast<llvm::Type*>(type));
        }
    }
    return static_cast<std::ptrdiff_t>(offset);
}

// -- Terminators
// ---------------------------------------------------------------------------------------

codegen::Edge Selector::edge(const llvm::BasicBlock& from, const llvm::BasicBlock& to) {
    codegen::Edge result{blocks_.at(&to), {}};
    for (const llvm::PHINode& phi : to.phis()) {
        const Bytes bytes = value(phi.getIncomingValueForBlock(&from));
        result.arguments.insert(result.arguments.end(), bytes.begin(), bytes.end());
    }
    return result;
}

void Selector::select_terminator(const llvm::Instruction& instruction) {
    builder_.set_place(place_of(instruction));
    codegen::Terminator end;
    using Kind = codegen::Terminator::Kind;
    if (const auto* give_back = llvm::dyn_cast<llvm::ReturnInst>(&instruction)) {
        end.kind = Kind::give_back;
        if (give_back->getReturnValue() != nullptr) end.left = value(give_back->getReturnValue());
    } else if (const auto* branch = llvm::dyn_cast<llvm::BranchInst>(&instruction)) {
        select_branch(*branch);
        return;
    } else if (!llvm::isa<llvm::UnreachableInst>(instruction)) {
        refuse(instruction, fmt::format("'{}' is not supported", instruction.getOpcodeName()));
    }
    builder_.terminate(std::move(end));
}

// A comparison is repeated at its branch: the flags it leaves are the cheapest form of its result.
void Selector::select_branch(const llvm::BranchInst& branch) {
    codegen::Terminator end;
    end.kind = codegen::Terminator::Kind::jump;
    if (branch.isConditional()) {
        end.kind = codegen::Terminator::Kind::branch;
        const auto* compare = llvm::dyn_cast<llvm::ICmpInst>(branch.getCondition());
        if (compare != nullptr) {
            Comparison wanted = comparison(*compare);
            end.predicate = wanted.predicate;
            end.left = std::move(wanted.left);
            end.right = std::move(wanted.right);
        } else {
            end.predicate = Predicate::not_equal;
            end.left = value(branch.getCondition());
            end.right = builder_.constant(0, 1);
        }
    }
    for (unsigned i = 0; i < branch.getNumSuccessors(); ++i) {
        end.edges.push_back(edge(*branch.getParent(), *branch.getSuccessor(i)));
    }
    builder_.terminate(std::move(end));
}

// -- Values
// --------------------------------------------------------------------------------------------

Bytes Selector::value(const llvm::Value* value) {
    const auto known = values_.find(value);
    if (known != values_.end()) return known->second;
    if (const auto* constant = llvm::dyn_cast<llvm::Constant>(value)) {
        return constant_bytes(out_, builder_, layout_, *constant);
    }
    throw Refused(
        fmt::format("{}: a value is used before its definition", function_.getName().str()));
}

std::size_t Selector::size_of(const llvm::Type* type) const {
    return layout_.getTypeStoreSize(const_cast<llvm::Type*>(type));
}

// An integer of an odd width keeps zeros above it.
Bytes Selector::masked(Bytes bytes, unsigned bits) {
    if (bits % 8 == 0) return bytes;
    const auto mask = static_cast<uint8_t>((1U << bits % 8) - 1);
    bytes.back() = builder_.bitwise(codegen::Opcode::bit_and, {bytes.back()},
                                    {builder_.constant_byte(mask)})[0];
    return bytes;
}

// The same with copies of the sign above it, as many bytes as asked for.
Bytes Selector::sign_from(const Bytes& bytes, unsigned bits, std::size_t size) {
    if (bits % 8 == 0) return builder_.sign_extended(bytes, size);
    const unsigned unused = 8 - bits % 8;
    Bytes top = builder_.shift_left({bytes.back()}, unused);
    top = builder_.shift_right_signed(top, unused);
    Bytes result = bytes;
    result.back() = top[0];
    return builder_.sign_extended(result, size);
}

Bytes Selector::signed_value(const llvm::Value* operand) {
    const Bytes bytes = value(operand);
    if (!operand->getType()->isIntegerTy()) return bytes;
    return sign_from(bytes, operand->getType()->getIntegerBitWidth(), bytes.size());
}

// -- Messages
// ------------------------------------------------------------------------------------------

codegen::SourcePlace Selector::place_of(const llvm::Instruction& instruction) {
    const llvm::DebugLoc& place = instruction.getDebugLoc();
    if (!place) return {};
    const std::string file = place->getFilename().str();
    for (std::size_t i = 0; i < out_.files.size(); ++i) {
        if (out_.files[i] == file) return {static_cast<uint32_t>(i), place.getLine()};
    }
    out_.files.push_back(file);
    return {static_cast<uint32_t>(out_.files.size() - 1), place.getLine()};
}

void Selector::refuse(const llvm::Instruction& instruction, const std::string& what) const {
    const llvm::DebugLoc& place = instruction.getDebugLoc();
    const std::string where =
        place ? fmt::format("{}:{}", place->getFilename().str(), place.getLine())
              : function_.getParent()->getSourceFileName();
    throw Refused(fmt::format("{}: in {}: {}", where, function_.getName().str(), what));
}

Bytes constant_bytes(codegen::Module& out, codegen::Builder& builder,
                     const llvm::DataLayout& layout, const llvm::Constant& constant) {
    if (llvm::isa<llvm::UndefValue>(constant)) {
        return builder.undefined(layout.getTypeStoreSize(constant.getType()));
    }
    Bytes bytes;
    for (const codegen::Datum& datum : constant_data(out, layout, constant)) {
        if (datum.symbol == codegen::kNone) {
            bytes.push_back(builder.constant_byte(datum.value));
        } else {
            bytes.push_back(builder.address(datum.symbol, datum.offset)[datum.high ? 1 : 0]);
        }
    }
    bytes.resize(layout.getTypeStoreSize(constant.getType()));
    return bytes;
}

codegen::Module select(const llvm::Module& module) {
    codegen::Module result;
    for (const llvm::GlobalVariable& variable : module.globals()) {
        if (variable.getName().starts_with("llvm.") || variable.isDeclaration()) continue;
        result.variables.push_back(make_variable(result, module.getDataLayout(), variable));
    }
    for (const llvm::Function& function : module) {
        if (!function.isDeclaration()) result.functions.push_back(Selector(result, function).run());
    }
    result.constructors = constructors_of(result, module);
    return result;
}

}  // namespace toolchain::ir
