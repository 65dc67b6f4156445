// mir.hpp - the back end's own representation: values are single bytes, operations work on strings
// of them.
// Depends on   machine.hpp (registers).
// Why bytes    on the 8085 the parts of a wide value live in different places. Truncation, zero
//              extension and shifts by 8 then cost nothing: they are other views of the same bytes.
// Design note  docs/design/compiler.md
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "toolchain/codegen/machine.hpp"

namespace toolchain::codegen {

using ByteId = uint32_t;
using BlockId = uint32_t;
using SymbolId = uint32_t;

/// A string of bytes, least significant first: a value of 8, 16, 24 ... bits.
using Bytes = std::vector<ByteId>;

inline constexpr uint32_t kNone = UINT32_MAX;

/// One byte of a value. Every byte is defined once.
struct ByteInfo {
    enum class Kind : uint8_t {
        undefined,     ///< any value will do
        constant,      ///< `constant`
        address_low,   ///< of symbol + offset
        address_high,  ///< of symbol + offset
        computed,      ///< result of an operation
        parameter,     ///< of a block: set by its predecessors, or by the caller
    };
    Kind kind = Kind::undefined;
    uint8_t constant = 0;
    SymbolId symbol = kNone;
    int32_t offset = 0;

    bool operator==(const ByteInfo&) const = default;
};

enum class Opcode : uint8_t {
    add,       ///< results = left + right
    subtract,  ///< results = left - right
    bit_and,   ///< one byte each
    bit_or,
    bit_xor,
    shift_left,          ///< by `immediate` bits, 1 to 7
    shift_right,         ///< zeros come in
    shift_right_signed,  ///< copies of the sign come in
    sign_fill,           ///< one byte: FFH if the operand byte is negative, else 0
    compare,             ///< one byte: 1 if `predicate` holds, else 0
    load,                ///< results = memory at the address
    store,               ///< memory at the address = right
    call,                ///< `symbol`
    call_indirect,       ///< through the address
    port_in,             ///< from port `immediate`
    port_out,            ///< to port `immediate`
    enable_interrupts,
    disable_interrupts,
    halt,
    read_mask,  ///< RIM
    set_mask,   ///< SIM
    no_operation,
    stack_address,  ///< results = address of Function::stack_bytes + `immediate16`; one word
};

/// Comparisons that one subtraction decides; the others swap their operands or their branches.
enum class Predicate : uint8_t { equal, not_equal, below, not_below, less, not_less };

/// The predicate that holds when `predicate` does not.
[[nodiscard]] constexpr Predicate inverse(Predicate predicate) {
    return static_cast<Predicate>(static_cast<uint8_t>(predicate) ^ 1U);
}

/// Where a piece of code comes from.
struct SourcePlace {
    uint32_t file = kNone;  ///< index into Module::files
    uint32_t line = 0;

    bool operator==(const SourcePlace&) const = default;
};

/// One operation. `left` and `right` are its operands; a load's or store's address is `left`.
struct Operation {
    Opcode opcode = Opcode::no_operation;
    Predicate predicate = Predicate::equal;
    bool is_volatile = false;  ///< load, store: exactly once, in order
    uint8_t immediate = 0;
    SymbolId symbol = kNone;
    Bytes results{};
    Bytes left{};
    Bytes right{};
    std::vector<Bytes> arguments{};  ///< of a call
    SourcePlace place{};

    // Of a call behind lower_calls(): `arguments` is then one string of bytes, each with its
    // register, and so have the results; what does not fit into registers is stored and loaded.
    std::vector<Register> argument_registers{};
    std::vector<Register> result_registers{};
    RegisterSet clobbers = kAllRegisters;  ///< of a runtime routine; a function's are asked for
    SymbolId signature = kNone;            ///< of an indirect call: reaches functions with the same
    bool reenters = false;                 ///< may come back into this function while it is active
    uint32_t immediate16 = 0;              ///< of stack_address
};

/// A way to another block, with the values of its parameters.
struct Edge {
    BlockId target = kNone;
    Bytes arguments{};
    double probability = -1;  ///< of a branch: that it is taken, if it is known
};

/// How a block ends.
struct Terminator {
    enum class Kind : uint8_t {
        jump,       ///< edges[0]
        branch,     ///< edges[0] if predicate(left, right), else edges[1]
        table,      ///< edges[left]; left is one byte below the number of edges
        give_back,  ///< return of `left`
        unreachable,
    };
    Kind kind = Kind::unreachable;
    Predicate predicate = Predicate::equal;
    Bytes left{};
    Bytes right{};
    std::vector<Edge> edges{};
    SourcePlace place{};
};

struct Block {
    Bytes parameters{};
    std::vector<Operation> operations{};
    Terminator terminator{};
    uint32_t loop_depth = 0;
    double frequency = 1;     ///< executions for each call of the function, estimated
    uint32_t loop_bound = 0;  ///< of a loop's header: most iterations each time it is entered; 0: ?
    std::vector<uint32_t> parameter_sizes{};  ///< bytes of each value among `parameters`, in order
};

/// A variable in the function's static frame; its symbol is an address like any other.
struct FrameObject {
    SymbolId symbol = kNone;
    uint32_t size = 0;
    uint32_t alignment = 1;  ///< a power of two; the optimiser may rely on it
};

struct Function {
    SymbolId symbol = kNone;
    std::vector<Bytes> parameters{};  ///< as the caller passes them; also those of blocks[0]
    uint32_t result_size = 0;         ///< bytes
    int32_t interrupt = -1;           ///< vector of an interrupt function, else -1
    std::vector<Block> blocks{};      ///< the first is the entry; nothing branches to it
    std::vector<ByteInfo> bytes{};
    std::vector<FrameObject> frame{};
    bool address_taken = false;  ///< may be called through a pointer
    uint32_t alignment = 1;      ///< of its address, if that is taken: C++ keeps a bit in it
    SymbolId signature = kNone;  ///< sizes of arguments and result, if address_taken
    bool recursive = false;      ///< its calls that re-enter save the slots; its FrameObjects are
                                 ///< `NAME@args`, `NAME@result`: read at once, so never saved
    uint32_t stack_bytes = 0;    ///< variables on the real stack; of a recursive function
    // Behind lower_calls(), for the flat parameters of blocks[0] and the bytes given back.
    std::vector<Register> parameter_registers{};
    std::vector<Register> result_registers{};
};

/// Bytes that stand in memory before the program starts.
struct Datum {
    uint8_t value = 0;
    SymbolId symbol = kNone;  ///< then the byte is a part of symbol + offset
    int32_t offset = 0;
    bool high = false;
};

struct Variable {
    SymbolId symbol = kNone;
    uint32_t size = 0;
    uint32_t alignment = 1;        ///< a power of two; the optimiser may rely on it
    bool is_constant = false;      ///< may stay in ROM
    std::vector<Datum> initial{};  ///< empty: zero
};

struct Module {
    std::vector<std::string> symbols{};
    std::map<std::string, SymbolId> symbol_ids{};
    std::vector<std::string> files{};
    std::vector<Function> functions{};
    std::vector<Variable> variables{};
    std::vector<SymbolId> constructors{};  ///< to be called before main, in this order

    SymbolId intern(const std::string& name);
    [[nodiscard]] const Function* find(SymbolId symbol) const;
};

/// The module as text, for people and tests.
[[nodiscard]] std::string print(const Module& module);
[[nodiscard]] std::string print(const Module& module, const Function& function);

/// What is wrong with a function, or empty: a byte used where it is not defined, sizes that do not
/// fit, an edge with the wrong number of arguments.
[[nodiscard]] std::string verify(const Function& function);

}  // namespace toolchain::codegen
