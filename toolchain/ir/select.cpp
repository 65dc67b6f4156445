// select.cpp - blocks, phis, terminators, memory; the rest of Selector is in select_*.cpp.
#include "toolchain/ir/select.hpp"

#include <fmt/format.h>
#include <llvm/ADT/PostOrderIterator.h>
#include <llvm/IR/CFG.h>
#include <llvm/IR/DebugInfoMetadata.h>
#include <llvm/IR/GlobalAlias.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/InstrTypes.h>
#include <llvm/IR/Module.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "toolchain/ir/constants.hpp"
#include "toolchain/ir/constructors.hpp"
#include "toolchain/ir/loop_bounds.hpp"
#include "toolchain/ir/prepare.hpp"
#include "toolchain/ir/refuse.hpp"
#include "toolchain/ir/selector.hpp"

namespace toolchain::ir {

using codegen::Bytes;
using codegen::Predicate;

namespace {

/// By anything but calls of it and the lists that keep it alive.
bool is_address_taken(const llvm::Function& function) {
    const auto taken = [](const llvm::GlobalValue& value, const auto& again) -> bool {
        for (const llvm::Use& use : value.uses()) {
            const llvm::User* user = use.getUser();
            const auto* call = llvm::dyn_cast<llvm::CallBase>(user);
            if (call != nullptr && call->isCallee(&use)) continue;
            const auto* alias = llvm::dyn_cast<llvm::GlobalAlias>(user);
            if (alias != nullptr && !again(*alias, again)) continue;
            const auto* list = llvm::dyn_cast<llvm::Constant>(user);
            const auto is_list = [](const llvm::User* of) {
                return llvm::isa<llvm::GlobalVariable>(of) && of->getName().starts_with("llvm.");
            };
            // llvm.used; llvm.global_ctors, whose entries are structs.
            const auto only_lists = [&](const llvm::Constant* entry, const auto& more) -> bool {
                return !llvm::isa<llvm::GlobalValue>(entry) && !entry->use_empty() &&
                       std::all_of(
                           entry->user_begin(), entry->user_end(), [&](const llvm::User* of) {
                               const auto* outer = llvm::dyn_cast<llvm::Constant>(of);
                               return is_list(of) || (outer != nullptr && more(outer, more));
                           });
            };
            if (list != nullptr && only_lists(list, only_lists)) continue;
            return true;
        }
        return false;
    };
    return taken(function, taken);
}

}  // namespace

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
    result_.address_taken = is_address_taken(function_);
    result_.alignment = static_cast<uint32_t>(function_.getAlign().valueOrOne().value());
    freezes_ = std::any_of(inst_begin(function_), inst_end(function_), [](const auto& instruction) {
        return llvm::isa<llvm::FreezeInst>(instruction);
    });
    take_variables();
    make_blocks();
    const llvm::ReversePostOrderTraversal<const llvm::Function*> order(&function_);
    for (const llvm::BasicBlock* block : order) fill_block(*block);
    for (const llvm::BasicBlock* block : order) {
        builder_.set_block(blocks_.at(block));
        select_terminator(*block->getTerminator());
    }
    return std::move(result_);
}

// Variables of the frame that callees know by name.
void Selector::take_variables() {
    for (const llvm::GlobalVariable& variable : function_.getParent()->globals()) {
        if (!variable.hasAttribute(kFrameAttribute) || variable.use_empty()) continue;
        if (variable.getAttribute(kFrameAttribute).getValueAsString() != function_.getName()) {
            continue;
        }
        const auto size = layout_.getTypeAllocSize(variable.getValueType()).getFixedValue();
        result_.frame.push_back({out_.intern(variable.getName().str()), static_cast<uint32_t>(size),
                                 static_cast<uint32_t>(variable.getAlign().valueOrOne().value())});
    }
}

// What a block's parameters are made of: a value each.
void Selector::add_parameter(codegen::Block& block, const Bytes& bytes) {
    block.parameters.insert(block.parameters.end(), bytes.begin(), bytes.end());
    block.parameter_sizes.push_back(static_cast<uint32_t>(bytes.size()));
}

// A value that flows around a loop is used before its definition is translated only by phis, and
// their edges are made last. The entry block has the function's parameters.
void Selector::make_blocks() {
    result_.blocks.emplace_back();
    for (const llvm::Argument& argument : function_.args()) {
        const Bytes bytes = builder_.parameter(size_of(argument.getType()));
        values_[&argument] = bytes;
        result_.parameters.push_back(bytes);
        add_parameter(result_.blocks[0], bytes);
    }
    const std::map<const llvm::BasicBlock*, BlockFacts> facts = block_facts(function_);
    const llvm::ReversePostOrderTraversal<const llvm::Function*> order(&function_);
    for (const llvm::BasicBlock* block : order) {
        if (block != &function_.getEntryBlock()) result_.blocks.emplace_back();
        const auto id = static_cast<codegen::BlockId>(result_.blocks.size() - 1);
        blocks_[block] = id;
        const BlockFacts& fact = facts.at(block);
        result_.blocks[id].frequency = fact.frequency;
        result_.blocks[id].loop_depth = fact.loop_depth;
        result_.blocks[id].loop_bound = fact.loop_bound;
        for (const llvm::PHINode& phi : block->phis()) {
            const Bytes bytes = builder_.parameter(size_of(phi.getType()));
            values_[&phi] = bytes;
            add_parameter(result_.blocks[id], bytes);
        }
    }
}

void Selector::fill_block(const llvm::BasicBlock& block) {
    builder_.set_block(blocks_.at(&block));
    for (const llvm::Instruction& instruction : block) {
        if (instruction.isTerminator() || llvm::isa<llvm::PHINode>(instruction)) continue;
        current_ = &instruction;
        builder_.set_place(place_of(instruction));
        values_[&instruction] = select_instruction(instruction);
    }
}

Bytes Selector::select_instruction(const llvm::Instruction& instruction) {
    if (const auto* binary = llvm::dyn_cast<llvm::BinaryOperator>(&instruction)) {
        return select_binary(*binary);
    }
    if (const auto* cast = llvm::dyn_cast<llvm::CastInst>(&instruction)) return select_cast(*cast);
    if (const auto* compare = llvm::dyn_cast<llvm::ICmpInst>(&instruction)) {
        return select_compare(*compare);
    }
    // An atomic access of a byte is one instruction; more is refused before.
    if (const auto* load = llvm::dyn_cast<llvm::LoadInst>(&instruction)) {
        return builder_.load(value(load->getPointerOperand()), size_of(load->getType()),
                             load->isVolatile() || load->isAtomic());
    }
    if (const auto* store = llvm::dyn_cast<llvm::StoreInst>(&instruction)) {
        builder_.store(value(store->getPointerOperand()), value(store->getValueOperand()),
                       store->isVolatile() || store->isAtomic());
        return {};
    }
    if (const auto* address = llvm::dyn_cast<llvm::GetElementPtrInst>(&instruction)) {
        return select_address(*address);
    }
    if (const auto* call = llvm::dyn_cast<llvm::CallInst>(&instruction)) return select_call(*call);
    if (const auto* freeze = llvm::dyn_cast<llvm::FreezeInst>(&instruction)) {
        return value(freeze->getOperand(0));
    }
    if (const auto* variable = llvm::dyn_cast<llvm::AllocaInst>(&instruction)) {
        return select_variable(*variable);
    }
    if (const auto* extract = llvm::dyn_cast<llvm::ExtractValueInst>(&instruction)) {
        const Bytes whole = value(extract->getAggregateOperand());
        const auto from = whole.begin() + offset_of(extract->getAggregateOperand()->getType(),
                                                    extract->getIndices());
        return {from, from + static_cast<std::ptrdiff_t>(size_of(extract->getType()))};
    }
    if (const auto* insert = llvm::dyn_cast<llvm::InsertValueInst>(&instruction)) {
        Bytes result = value(insert->getAggregateOperand());
        const Bytes part = value(insert->getInsertedValueOperand());
        std::copy(part.begin(), part.end(),
                  result.begin() + offset_of(insert->getType(), insert->getIndices()));
        return result;
    }
    if (llvm::isa<llvm::FenceInst>(instruction)) return {};  // one processor, in order
    refuse(instruction, fmt::format("'{}' is not supported", instruction.getOpcodeName()));
}

// A variable whose size is known has a place in the static frame.
Bytes Selector::select_variable(const llvm::AllocaInst& variable) {
    const auto size = variable.getAllocationSize(layout_);
    if (!size || !variable.isStaticAlloca()) {
        refuse(variable, "a variable whose size is known only at run time: frames are static");
    }
    const auto symbol =
        out_.intern(fmt::format("{}@frame.{}", function_.getName().str(), result_.frame.size()));
    result_.frame.push_back({symbol, static_cast<uint32_t>(size->getFixedValue()),
                             static_cast<uint32_t>(variable.getAlign().value())});
    return builder_.address(symbol, 0);
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
    current_ = &instruction;
    builder_.set_place(place_of(instruction));
    codegen::Terminator end;
    using Kind = codegen::Terminator::Kind;
    if (const auto* give_back = llvm::dyn_cast<llvm::ReturnInst>(&instruction)) {
        end.kind = Kind::give_back;
        if (give_back->getReturnValue() != nullptr) end.left = value(give_back->getReturnValue());
    } else if (const auto* branch = llvm::dyn_cast<llvm::BranchInst>(&instruction)) {
        select_branch(*branch);
        return;
    } else if (const auto* table = llvm::dyn_cast<llvm::SwitchInst>(&instruction)) {
        end = table_of(*table);
    } else if (!llvm::isa<llvm::UnreachableInst>(instruction)) {
        refuse(instruction, fmt::format("'{}' is not supported", instruction.getOpcodeName()));
    }
    builder_.terminate(std::move(end));
}

// Behind lower_switches(): cases 0, 1, 2 ... of a byte.
codegen::Terminator Selector::table_of(const llvm::SwitchInst& table) {
    codegen::Terminator end;
    end.kind = codegen::Terminator::Kind::table;
    end.left = value(table.getCondition());
    end.edges.resize(table.getNumCases());
    for (const auto& entry : table.cases()) {
        const uint64_t index = entry.getCaseValue()->getZExtValue();
        if (end.left.size() != 1 || index >= end.edges.size()) {
            refuse(table, "a switch that lower_switches() should have replaced");
        }
        end.edges[index] = edge(*table.getParent(), *entry.getCaseSuccessor());
    }
    return end;
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
    if (const auto* expression = llvm::dyn_cast<llvm::ConstantExpr>(value)) {
        // Computed like any other instruction; the builder folds what the linker can know.
        const llvm::Instruction* instruction =
            const_cast<llvm::ConstantExpr*>(expression)->getAsInstruction();
        const std::unique_ptr<const llvm::Instruction, void (*)(const llvm::Instruction*)> owner(
            instruction, [](const llvm::Instruction* done) {
                const_cast<llvm::Instruction*>(done)->deleteValue();
            });
        return select_instruction(*instruction);
    }
    if (const auto* constant = llvm::dyn_cast<llvm::Constant>(value)) {
        return constant_bytes(*constant);
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
    if (!place || place.getLine() == 0) return {};
    const std::string file = place->getFilename().str();
    for (std::size_t i = 0; i < out_.files.size(); ++i) {
        if (out_.files[i] == file) return {static_cast<uint32_t>(i), place.getLine()};
    }
    out_.files.push_back(file);
    return {static_cast<uint32_t>(out_.files.size() - 1), place.getLine()};
}

void Selector::refuse(const llvm::Instruction& instruction, const std::string& what) const {
    // A constant expression's instruction stands in no function.
    ir::refuse(instruction.getParent() == nullptr ? *current_ : instruction, what);
}

Bytes Selector::undefined(const llvm::Type& type) {
    // A frozen value is the same at every use. Bits above an odd width are 0.
    const bool odd = type.isIntegerTy() && type.getIntegerBitWidth() % 8 != 0;
    const std::size_t size = size_of(&type);
    return freezes_ || odd || type.isAggregateType() ? builder_.constant(0, size)
                                                     : builder_.undefined(size);
}

Bytes Selector::constant_bytes(const llvm::Constant& constant) {
    if (llvm::isa<llvm::UndefValue>(constant)) return undefined(*constant.getType());
    Bytes bytes;
    try {
        for (const codegen::Datum& datum : constant_data(out_, layout_, constant)) {
            if (datum.symbol == codegen::kNone) {
                bytes.push_back(builder_.constant_byte(datum.value));
            } else {
                bytes.push_back(builder_.address(datum.symbol, datum.offset)[datum.high ? 1 : 0]);
            }
        }
    } catch (const BadConstant& problem) {
        refuse(*current_, problem.what());
    }
    bytes.resize(size_of(constant.getType()));
    return bytes;
}

codegen::Module select(const llvm::Module& module) {
    codegen::Module result;
    for (const llvm::GlobalVariable& variable : module.globals()) {
        if (variable.getName().starts_with("llvm.") || variable.isDeclarationForLinker()) continue;
        if (variable.hasAttribute(kFrameAttribute)) continue;  // see Selector::run()
        result.variables.push_back(make_variable(result, module.getDataLayout(), variable));
    }
    for (const llvm::Function& function : module) {
        if (!function.isDeclarationForLinker()) {
            result.functions.push_back(Selector(result, function).run());
        }
    }
    result.constructors = constructors_of(result, module);
    return result;
}

}  // namespace toolchain::ir
