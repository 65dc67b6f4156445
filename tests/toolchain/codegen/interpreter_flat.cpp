// interpreter_flat.cpp - calls behind lower_calls(): registers, cells, runtime routines by name.
// Source       docs/spec/runtime.md, read by a person; not the tables of toolchain/codegen.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "tests/toolchain/codegen/interpreter.hpp"

namespace codegen_test {

using namespace toolchain::codegen;

namespace {

constexpr uint8_t kGarbage = 0x5A;

Register register_of(char letter) {
    switch (letter) {
        case 'A':
            return Register::a;
        case 'B':
            return Register::b;
        case 'C':
            return Register::c;
        case 'D':
            return Register::d;
        case 'E':
            return Register::e;
        case 'H':
            return Register::h;
        default:
            return Register::l;
    }
}

int64_t sign_extended(uint64_t value, unsigned bits) {
    const unsigned unused = 64 - bits;
    return static_cast<int64_t>(value << unused) >> unused;
}

}  // namespace

/// A number from registers, most significant first.
uint64_t Interpreter::registers(const char* letters) const {
    uint64_t value = 0;
    for (const char* letter = letters; *letter != 0; ++letter) {
        value = value << 8 | registers_[static_cast<std::size_t>(register_of(*letter))];
    }
    return value;
}

void Interpreter::set_registers(const char* letters, uint64_t value) {
    const std::string all = letters;
    for (std::size_t i = all.size(); i-- > 0;) {
        registers_[static_cast<std::size_t>(register_of(all[i]))] = static_cast<uint8_t>(value);
        value >>= 8;
    }
}

uint64_t Interpreter::cell(const std::string& name, unsigned size) const {
    return variable(name, size);
}

void Interpreter::set_cell(const std::string& name, unsigned size, uint64_t value,
                           unsigned offset) {
    const auto symbol = module_.symbol_ids.find(name);
    if (symbol == module_.symbol_ids.end()) return;  // nobody reads it
    const uint16_t address = addresses_.at(symbol->second);
    for (unsigned i = 0; i < size; ++i) {
        memory[static_cast<uint16_t>(address + offset + i)] = static_cast<uint8_t>(value >> 8 * i);
    }
}

void Interpreter::call_flat(Frame& frame, const Operation& operation) {
    registers_.fill(kGarbage);
    const Bytes& arguments = operation.arguments.at(0);
    if (arguments.size() != operation.argument_registers.size() ||
        operation.results.size() != operation.result_registers.size()) {
        throw std::runtime_error("a call whose registers do not fit");
    }
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        registers_[static_cast<std::size_t>(operation.argument_registers[i])] =
            read(frame, arguments[i]);
    }
    const Function* callee = nullptr;
    if (operation.opcode == Opcode::call_indirect) {
        const uint64_t target = registers("HL");
        for (const Function& function : module_.functions) {
            if (addresses_.at(function.symbol) == target) callee = &function;
        }
        if (callee == nullptr) throw std::runtime_error("call through a pointer to no function");
        set_registers("HL", 0xDEAD);
    } else {
        callee = module_.find(operation.symbol);
    }
    if (callee != nullptr) {
        enter_flat(*callee);
    } else if (!routine(module_.symbols[operation.symbol])) {
        throw std::runtime_error("no function " + module_.symbols[operation.symbol]);
    }
    for (std::size_t i = 0; i < operation.results.size(); ++i) {
        frame.values[operation.results[i]] =
            registers_[static_cast<std::size_t>(operation.result_registers[i])];
    }
}

void Interpreter::enter_flat(const Function& callee) {
    std::vector<uint8_t> arguments;
    for (const Register which : callee.parameter_registers) {
        arguments.push_back(registers_[static_cast<std::size_t>(which)]);
    }
    const std::vector<uint8_t> result = run(callee, arguments);
    registers_.fill(kGarbage);
    for (std::size_t i = 0; i < result.size(); ++i) {
        registers_[static_cast<std::size_t>(callee.result_registers.at(i))] = result[i];
    }
}

// -- Runtime routines ----------------------------------------------------------------------------

bool Interpreter::routine(const std::string& name) {
    const auto is_signed = [](uint64_t value, unsigned bits) {
        return static_cast<uint64_t>(sign_extended(value, bits));
    };
    const uint64_t a = registers("A");
    const uint64_t e = registers("E");
    const uint64_t de = registers("DE");
    const uint64_t hl = registers("HL");
    const uint64_t dehl = registers("DEHL");
    if (name == "__mul8") {
        set_registers("DHL", a * e);
    } else if (name == "__mul8s") {
        set_registers("HL", is_signed(a, 8) * is_signed(e, 8));
        set_registers("AD", 0x5A5B);
    } else if (name == "__mul8_16") {
        set_registers("HL", a * de);
        set_registers("A", 0);
    } else if (name == "__mul16") {
        set_registers("HL", hl * de);
        set_registers("A", kGarbage);
    } else if (name == "__mul8_16w") {
        set_registers("AHL", a * de);
    } else if (name == "__mul8_s16w") {
        set_registers("AHL", a * is_signed(de, 16));
    } else if (name == "__umul16w") {
        set_registers("DEHL", hl * de);
    } else if (name == "__smul16w") {
        set_registers("DEHL", is_signed(hl, 16) * is_signed(de, 16));
    } else if (name == "__mul32") {
        set_registers("DEHL", dehl * cell("__mul32.cells", 4));
    } else {
        return divide_routine(name) || shift_routine(name) || wide_routine(name) ||
               block_routine(name);
    }
    return true;
}

// Division by 0 is undefined in C; here it gives 0.
bool Interpreter::divide_routine(const std::string& name) {
    struct Both {
        uint64_t quotient;
        uint64_t remainder;
    };
    const auto divide = [&](uint64_t left, uint64_t right, unsigned bits) -> Both {
        if (right == 0) return {0, 0};
        if (!name.starts_with("__s")) return {left / right, left % right};
        const int64_t dividend = sign_extended(left, bits);
        const int64_t divisor = sign_extended(right, bits);
        if (divisor == -1) return {0 - left, 0};
        return {static_cast<uint64_t>(dividend / divisor),
                static_cast<uint64_t>(dividend % divisor)};
    };
    if (name == "__udiv8" || name == "__sdiv8") {
        const Both both = divide(registers("A"), registers("E"), 8);
        set_registers("HL", name == "__udiv8" ? both.quotient : both.quotient & 0xFF);
        set_registers("A", both.remainder);
    } else if (name == "__udiv16" || name == "__sdiv16") {
        const Both both = divide(registers("HL"), registers("DE"), 16);
        set_registers("HL", both.quotient);
        set_registers("DE", both.remainder);
    } else if (name == "__udiv24_8") {
        if (registers("E") != 0 && registers("A") >= registers("E")) {
            throw std::runtime_error("__udiv24_8: the quotient does not fit");
        }
        const Both both = divide(registers("AHL"), registers("E"), 24);
        set_registers("HL", both.quotient);
        set_registers("DE", both.remainder);
    } else if (name == "__udiv32_16") {
        const Both both = divide(registers("DEHL"), registers("BC"), 32);
        set_registers("DEHL", both.quotient);
        set_registers("BC", both.remainder);
    } else if (name == "__udiv32" || name == "__sdiv32") {
        const Both both = divide(registers("DEHL"), cell("__udiv32.cells", 4), 32);
        set_registers("DEHL", both.quotient);
        set_cell("__udiv32.cells", 4, both.remainder);
    } else if (name == "__udiv64" || name == "__sdiv64") {
        const Both both = divide(cell("__wide.a", 8), cell("__wide.b", 8), 64);
        set_cell("__wide.a", 8, both.quotient);
        set_cell("__wide.b", 8, both.remainder);
    } else {
        return false;
    }
    return true;
}

bool Interpreter::shift_routine(const std::string& name) {
    const bool left = name.starts_with("__shl");
    if (!left && !name.starts_with("__lshr") && !name.starts_with("__ashr")) return false;
    const auto bits = static_cast<unsigned>(std::stoul(name.substr(left ? 5 : 6)));
    const bool is_signed = name.starts_with("__ashr");
    const auto shift = [&](uint64_t value, uint64_t count) -> uint64_t {
        if (is_signed) {
            return static_cast<uint64_t>(sign_extended(value, bits) >>
                                         std::min<uint64_t>(count, 63));
        }
        return count >= bits ? 0 : left ? value << count : value >> count;
    };
    if (bits == 8) {
        set_registers("A", shift(registers("A"), registers("E")));
        set_registers("E", kGarbage);
    } else if (bits == 16) {
        set_registers("HL", shift(registers("HL"), registers("A")));
    } else if (bits == 32) {
        set_registers("DEHL", shift(registers("DEHL"), registers("A")));
    } else {
        set_cell("__wide.a", 8, shift(cell("__wide.a", 8), registers("A")));
    }
    return true;
}

bool Interpreter::wide_routine(const std::string& name) {
    if (name != "__mul64") return false;
    set_cell("__wide.a", 8, cell("__wide.a", 8) * cell("__wide.b", 8));
    return true;
}

bool Interpreter::block_routine(const std::string& name) {
    if (name == "__memcpy" || name == "__memmove") {
        copy_block(registers("HL"), registers("DE"), registers("BC"));
    } else if (name == "__memcpy8") {
        copy_block(registers("HL"), registers("DE"), registers("C"));
    } else if (name == "__memset") {
        for (uint64_t i = 0; i < registers("BC"); ++i) {
            memory[static_cast<uint16_t>(registers("HL") + i)] =
                static_cast<uint8_t>(registers("A"));
        }
    } else {
        return false;
    }
    return true;
}

}  // namespace codegen_test
