// interpreter.hpp - executes the back end's representation on the host, as the oracle between LLVM
// IR and machine code.
// Depends on   toolchain/codegen/mir.hpp.
// Calls        before lower_calls() by value; behind it through registers, cells and memory, so
// that
//              a caller and a callee who disagree give a wrong result. Runtime routines do what
//              docs/spec/runtime.md says; what they clobber becomes garbage.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace codegen_test {

/// A module with memory. Variables lie from 8000H on, frame objects behind them.
class Interpreter {
public:
    explicit Interpreter(const toolchain::codegen::Module& module);

    /// Calls a function by name; the result as a number. @errors std::runtime_error
    uint64_t call(const std::string& name, const std::vector<uint64_t>& arguments = {});

    [[nodiscard]] uint64_t variable(const std::string& name, unsigned size) const;
    /// Where a variable or frame object is. @errors std::out_of_range
    [[nodiscard]] uint16_t address(const std::string& name) const {
        return addresses_.at(module_.symbol_ids.at(name));
    }
    std::array<uint8_t, 0x10000> memory{};
    uint64_t steps = 0;
    uint64_t step_limit = 200'000'000;

private:
    using Bytes = toolchain::codegen::Bytes;
    using Function = toolchain::codegen::Function;
    using Operation = toolchain::codegen::Operation;
    // Intermediate products of 64-bit values.
    __extension__ using Wide = unsigned __int128;
    __extension__ using SignedWide = __int128;
    struct Frame {
        const Function& function;
        std::vector<uint8_t> values;
        uint16_t stack = 0;  ///< address of its variables on the stack
    };

    void place(toolchain::codegen::SymbolId symbol, uint32_t size, uint32_t alignment = 1);
    uint8_t read(const Frame& frame, uint32_t byte) const;
    Wide number(const Frame& frame, const Bytes& bytes) const;
    SignedWide signed_number(const Frame& frame, const Bytes& bytes) const;
    static void set(Frame& frame, const Bytes& bytes, Wide value);
    std::vector<uint8_t> run(const Function& function, const std::vector<uint8_t>& arguments);
    std::vector<uint8_t> run_blocks(Frame& frame, const std::vector<uint8_t>& arguments);
    void count_step();
    void execute(Frame& frame, const Operation& operation);
    bool holds(const Frame& frame, toolchain::codegen::Predicate predicate, const Bytes& left,
               const Bytes& right) const;
    void call_symbol(Frame& frame, const Operation& operation, toolchain::codegen::SymbolId symbol);
    bool call_runtime(Frame& frame, const Operation& operation, const std::string& name);
    void copy_block(uint64_t to, uint64_t from, uint64_t count);

    // Behind lower_calls().
    void call_flat(Frame& frame, const Operation& operation);
    void enter_flat(const Function& callee);
    [[nodiscard]] uint64_t registers(const char* letters) const;
    void set_registers(const char* letters, uint64_t value);
    [[nodiscard]] uint64_t cell(const std::string& name, unsigned size) const;
    void set_cell(const std::string& name, unsigned size, uint64_t value, unsigned offset = 0);
    bool routine(const std::string& name);
    bool divide_routine(const std::string& name);
    bool shift_routine(const std::string& name);
    bool wide_routine(const std::string& name);
    bool block_routine(const std::string& name);

    const toolchain::codegen::Module& module_;
    std::map<toolchain::codegen::SymbolId, uint16_t> addresses_;
    uint16_t next_ = 0x8000;
    uint16_t stack_ = 0xFF00;
    std::array<uint8_t, 8> registers_{};  ///< by toolchain::codegen::Register
};

}  // namespace codegen_test
