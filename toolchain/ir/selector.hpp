// selector.hpp - the translation of one function; internal to toolchain/ir.
// Depends on   libLLVM 19 (IR), toolchain/codegen, constants.hpp.
#pragma once

#include <llvm/IR/Function.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/IntrinsicInst.h>

#include <compare>
#include <map>
#include <optional>
#include <string>

#include "toolchain/codegen/builder.hpp"
#include "toolchain/codegen/mir.hpp"

namespace toolchain::ir {

/// Translates one function into `out`, block by block in an order in which definitions come before
/// uses.
class Selector {
public:
    Selector(codegen::Module& out, const llvm::Function& function);

    [[nodiscard]] codegen::Function run();

private:
    using Bytes = codegen::Bytes;

    void take_variables();
    void make_blocks();
    void fill_block(const llvm::BasicBlock& block);
    void add_parameter(codegen::Block& block, const Bytes& bytes);
    [[nodiscard]] Bytes select_instruction(const llvm::Instruction& instruction);
    [[nodiscard]] Bytes select_variable(const llvm::AllocaInst& variable);
    void select_terminator(const llvm::Instruction& instruction);
    void select_branch(const llvm::BranchInst& branch);
    [[nodiscard]] codegen::Terminator table_of(const llvm::SwitchInst& table);
    [[nodiscard]] codegen::Edge edge(const llvm::BasicBlock& from, const llvm::BasicBlock& to);

    // Integers: canonical, bits above an odd width are 0.
    [[nodiscard]] Bytes select_binary(const llvm::BinaryOperator& operation);
    [[nodiscard]] Bytes mask_of(const llvm::BinaryOperator& operation);
    [[nodiscard]] Bytes select_multiply(const llvm::BinaryOperator& operation);
    [[nodiscard]] Bytes multiply_by_constant(const Bytes& value, uint64_t factor);
    [[nodiscard]] Bytes select_divide(const llvm::BinaryOperator& operation);
    [[nodiscard]] Bytes select_shift(const llvm::BinaryOperator& operation);
    [[nodiscard]] Bytes select_cast(const llvm::CastInst& cast);
    [[nodiscard]] Bytes select_compare(const llvm::ICmpInst& compare);
    [[nodiscard]] Bytes select_address(const llvm::GetElementPtrInst& address);
    [[nodiscard]] Bytes select_in_page(const llvm::GetElementPtrInst& address,
                                       const llvm::MDNode& note);
    [[nodiscard]] std::optional<Bytes> select_field_in_page(const llvm::GetElementPtrInst& address);
    [[nodiscard]] Bytes select_call(const llvm::CallBase& call);
    [[nodiscard]] Bytes select_intrinsic(const llvm::IntrinsicInst& call);
    void check_prototype(const llvm::CallBase& call, const llvm::Function& callee) const;
    [[nodiscard]] Bytes select_processor(const std::string& name, const llvm::CallBase& call);
    [[nodiscard]] Bytes runtime(const std::string& name, std::vector<Bytes> arguments,
                                std::size_t result_size);

    struct Comparison {
        codegen::Predicate predicate;
        Bytes left;
        Bytes right;
    };
    bool drop_equal_tops(Bytes& left, Bytes& right, bool is_signed) const;
    [[nodiscard]] Comparison comparison(const llvm::ICmpInst& compare);

    [[nodiscard]] Bytes value(const llvm::Value* value);
    [[nodiscard]] Bytes constant_bytes(const llvm::Constant& constant);
    [[nodiscard]] Bytes undefined(const llvm::Type& type);
    [[nodiscard]] Bytes signed_value(const llvm::Value* value);
    [[nodiscard]] Bytes masked(Bytes bytes, unsigned bits);
    [[nodiscard]] Bytes sign_from(const Bytes& bytes, unsigned bits, std::size_t size);
    [[nodiscard]] std::size_t size_of(const llvm::Type* type) const;
    [[nodiscard]] std::ptrdiff_t offset_of(const llvm::Type* type,
                                           llvm::ArrayRef<unsigned> indices) const;
    [[nodiscard]] codegen::SourcePlace place_of(const llvm::Instruction& instruction);
    [[noreturn]] void refuse(const llvm::Instruction& instruction, const std::string& what) const;

    codegen::Module& out_;
    const llvm::Function& function_;
    const llvm::DataLayout& layout_;
    codegen::Function result_;
    codegen::Builder builder_{result_};
    std::map<const llvm::Value*, Bytes> values_;
    std::map<const llvm::BasicBlock*, codegen::BlockId> blocks_;
    struct Division {
        const llvm::BasicBlock* block;
        const llvm::Value* dividend;
        const llvm::Value* divisor;
        bool is_signed;
        auto operator<=>(const Division&) const = default;
    };
    std::map<Division, Bytes> divisions_;         ///< quotient and remainder behind it
    const llvm::Instruction* current_ = nullptr;  ///< for messages
    bool freezes_ = false;
};

}  // namespace toolchain::ir
