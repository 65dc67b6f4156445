// builder.hpp - appends operations to a block and folds what needs no code.
// Depends on   mir.hpp.
// Folds        constants, bytes known to be 0 or FF, operands that repeat; addresses plus
//              constants; shifts by whole bytes. What is left computes something.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

class Builder {
public:
    explicit Builder(Function& function) : function_(function) {}

    /// Where the next operations go.
    void set_block(BlockId block) { block_ = block; }
    [[nodiscard]] BlockId block() const { return block_; }
    void set_place(SourcePlace place) { place_ = place; }

    // -- Bytes that need no code -----------------------------------------------------------------
    [[nodiscard]] ByteId constant_byte(uint8_t value);
    [[nodiscard]] Bytes constant(uint64_t value, std::size_t size);
    [[nodiscard]] Bytes address(SymbolId symbol, int32_t offset);
    [[nodiscard]] Bytes undefined(std::size_t size);
    [[nodiscard]] Bytes parameter(std::size_t size);
    [[nodiscard]] Bytes zero_extended(Bytes value, std::size_t size);
    [[nodiscard]] Bytes sign_extended(Bytes value, std::size_t size);
    /// The value if all bytes are constant; at most 8 bytes.
    [[nodiscard]] std::optional<uint64_t> value_of(const Bytes& value) const;
    /// Bytes at the top that are known to be 0.
    [[nodiscard]] std::size_t leading_zero_bytes(const Bytes& value) const;

    // -- Computation. Operands have the same size. -----------------------------------------------
    [[nodiscard]] Bytes add(const Bytes& left, const Bytes& right);
    [[nodiscard]] Bytes subtract(const Bytes& left, const Bytes& right);
    [[nodiscard]] Bytes bitwise(Opcode opcode, const Bytes& left, const Bytes& right);
    [[nodiscard]] Bytes shift_left(const Bytes& value, unsigned count);
    [[nodiscard]] Bytes shift_right(const Bytes& value, unsigned count);
    [[nodiscard]] Bytes shift_right_signed(const Bytes& value, unsigned count);
    /// A byte that is 0 or 1.
    [[nodiscard]] ByteId compare(Predicate predicate, const Bytes& left, const Bytes& right);

    // -- Memory and calls ------------------------------------------------------------------------
    [[nodiscard]] Bytes load(const Bytes& address, std::size_t size, bool is_volatile);
    void store(const Bytes& address, const Bytes& value, bool is_volatile);
    [[nodiscard]] Bytes call(SymbolId symbol, std::vector<Bytes> arguments,
                             std::size_t result_size);
    [[nodiscard]] Bytes call_indirect(const Bytes& target, std::vector<Bytes> arguments,
                                      std::size_t result_size);
    /// Ports, interrupt masks, EI, DI, HLT, NOP. @param operand  of port_out and set_mask
    [[nodiscard]] Bytes processor(Opcode opcode, uint8_t immediate, const Bytes& operand,
                                  std::size_t result_size);
    void terminate(Terminator terminator);

private:
    ByteId new_byte(const ByteInfo& info);
    ByteId interned(const ByteInfo& info);
    Bytes new_results(std::size_t size);
    Operation& append(Opcode opcode);
    ByteId bitwise_byte(Opcode opcode, ByteId left, ByteId right);
    [[nodiscard]] bool is_constant(ByteId byte, uint8_t value) const;
    [[nodiscard]] const ByteInfo& info(ByteId byte) const { return function_.bytes[byte]; }
    [[nodiscard]] std::optional<Bytes> add_to_address(const Bytes& left, const Bytes& right);
    Bytes shifted(Opcode opcode, const Bytes& value, unsigned bits);
    std::optional<ByteId> without_carry(Opcode opcode, ByteId left, ByteId right);
    Bytes carry_chain(Opcode opcode, const Bytes& left, const Bytes& right);
    ByteId sign_of(ByteId byte);

    Function& function_;
    BlockId block_ = 0;
    SourcePlace place_;
    std::map<std::tuple<ByteInfo::Kind, uint8_t, SymbolId, int32_t>, ByteId> interned_;
};

}  // namespace toolchain::codegen
