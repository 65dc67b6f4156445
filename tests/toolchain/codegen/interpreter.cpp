// interpreter.cpp - see interpreter.hpp.
#include "tests/toolchain/codegen/interpreter.hpp"

#include <stdexcept>
#include <string>

namespace codegen_test {

using namespace toolchain::codegen;

namespace {

/// Behind lower_calls(): one string of arguments, each byte with its register.
bool is_flat(const Operation& operation) {
    return operation.arguments.size() == 1 &&
           operation.arguments[0].size() == operation.argument_registers.size();
}

}  // namespace

Interpreter::Interpreter(const Module& module) : module_(module) {
    uint16_t code = 0x0100;
    for (const Function& function : module.functions) {
        addresses_[function.symbol] = code++;
        for (const FrameObject& object : function.frame)
            place(object.symbol, object.size, object.alignment);
    }
    for (const Variable& variable : module.variables) {
        place(variable.symbol, variable.size, variable.alignment);
    }
    constexpr uint32_t kLargestCell = 8;
    for (SymbolId symbol = 0; symbol < module.symbols.size(); ++symbol) {
        const std::string& name = module.symbols[symbol];
        const bool is_cell = name.starts_with("__wide.") || name.ends_with(".cells");
        if (is_cell) place(symbol, kLargestCell);
    }
    for (const Variable& variable : module.variables) {
        uint16_t address = addresses_[variable.symbol];
        for (const Datum& datum : variable.initial) {
            uint8_t value = datum.value;
            if (datum.symbol != kNone) {
                const auto target =
                    static_cast<uint16_t>(addresses_.at(datum.symbol) + datum.offset);
                value = static_cast<uint8_t>(datum.high ? target >> 8 : target);
            }
            memory[address++] = value;
        }
    }
}

void Interpreter::place(SymbolId symbol, uint32_t size, uint32_t alignment) {
    next_ = static_cast<uint16_t>((next_ + alignment - 1) / alignment * alignment);
    addresses_[symbol] = next_;
    if (size > 0x10000U - next_) throw std::runtime_error("variables do not fit into memory");
    next_ = static_cast<uint16_t>(next_ + size);
}

uint8_t Interpreter::read(const Frame& frame, uint32_t byte) const {
    const ByteInfo& info = frame.function.bytes[byte];
    switch (info.kind) {
        case ByteInfo::Kind::undefined:
            return 0xA5;
        case ByteInfo::Kind::constant:
            return info.constant;
        case ByteInfo::Kind::address_low:
        case ByteInfo::Kind::address_high: {
            const auto address = static_cast<uint16_t>(addresses_.at(info.symbol) + info.offset);
            return static_cast<uint8_t>(info.kind == ByteInfo::Kind::address_low ? address
                                                                                 : address >> 8);
        }
        default:
            return frame.values[byte];
    }
}

Interpreter::Wide Interpreter::number(const Frame& frame, const Bytes& bytes) const {
    Wide value = 0;
    for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8 | read(frame, bytes[i]);
    return value;
}

Interpreter::SignedWide Interpreter::signed_number(const Frame& frame, const Bytes& bytes) const {
    const unsigned unused = 128 - static_cast<unsigned>(bytes.size()) * 8;
    return static_cast<SignedWide>(number(frame, bytes) << unused) >> unused;
}

void Interpreter::set(Frame& frame, const Bytes& bytes, Wide value) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        frame.values[bytes[i]] = static_cast<uint8_t>(i < 16 ? value >> 8 * i : Wide{0});
    }
}

bool Interpreter::holds(const Frame& frame, Predicate predicate, const Bytes& left,
                        const Bytes& right) const {
    switch (predicate) {
        case Predicate::equal:
            return number(frame, left) == number(frame, right);
        case Predicate::not_equal:
            return number(frame, left) != number(frame, right);
        case Predicate::below:
            return number(frame, left) < number(frame, right);
        case Predicate::not_below:
            return number(frame, left) >= number(frame, right);
        case Predicate::less:
            return signed_number(frame, left) < signed_number(frame, right);
        case Predicate::not_less:
            return signed_number(frame, left) >= signed_number(frame, right);
    }
    return false;
}

std::vector<uint8_t> Interpreter::run(const Function& function,
                                      const std::vector<uint8_t>& arguments) {
    const auto stack = stack_;
    stack_ = static_cast<uint16_t>(stack_ - function.stack_bytes);
    Frame frame{function, std::vector<uint8_t>(function.bytes.size()), stack_};
    std::vector<uint8_t> result = run_blocks(frame, arguments);
    stack_ = stack;
    return result;
}

std::vector<uint8_t> Interpreter::run_blocks(Frame& frame, const std::vector<uint8_t>& arguments) {
    const Function& function = frame.function;
    std::size_t next = 0;
    for (const ByteId byte : function.blocks[0].parameters)
        frame.values[byte] = arguments.at(next++);
    BlockId current = 0;
    while (true) {
        const Block& block = function.blocks[current];
        count_step();  // a loop may be empty
        for (const Operation& operation : block.operations) execute(frame, operation);
        const Terminator& end = block.terminator;
        if (end.kind == Terminator::Kind::give_back) {
            std::vector<uint8_t> result;
            for (const ByteId byte : end.left) result.push_back(read(frame, byte));
            return result;
        }
        if (end.kind == Terminator::Kind::unreachable)
            throw std::runtime_error("unreachable reached");
        std::size_t way = 0;
        if (end.kind == Terminator::Kind::branch) {
            way = holds(frame, end.predicate, end.left, end.right) ? 0 : 1;
        } else if (end.kind == Terminator::Kind::table) {
            way = read(frame, end.left[0]);
        }
        const Edge& edge = end.edges.at(way);
        std::vector<uint8_t> values;
        for (const ByteId byte : edge.arguments) values.push_back(read(frame, byte));
        const Bytes& parameters = function.blocks[edge.target].parameters;
        for (std::size_t i = 0; i < parameters.size(); ++i) frame.values[parameters[i]] = values[i];
        current = edge.target;
    }
}

void Interpreter::count_step() {
    if (++steps > step_limit) throw std::runtime_error("too many steps");
}

void Interpreter::execute(Frame& frame, const Operation& operation) {
    count_step();
    const Wide left = number(frame, operation.left);
    const Wide right = number(frame, operation.right);
    switch (operation.opcode) {
        case Opcode::add:
            set(frame, operation.results, left + right);
            break;
        case Opcode::subtract:
            set(frame, operation.results, left - right);
            break;
        case Opcode::bit_and:
            set(frame, operation.results, left & right);
            break;
        case Opcode::bit_or:
            set(frame, operation.results, left | right);
            break;
        case Opcode::bit_xor:
            set(frame, operation.results, left ^ right);
            break;
        case Opcode::shift_left:
            set(frame, operation.results, left << operation.immediate);
            break;
        case Opcode::shift_right:
            set(frame, operation.results, left >> operation.immediate);
            break;
        case Opcode::shift_right_signed:
            set(frame, operation.results,
                static_cast<Wide>(signed_number(frame, operation.left) >> operation.immediate));
            break;
        case Opcode::sign_fill:
            set(frame, operation.results, (left & 0x80) != 0 ? 0xFF : 0);
            break;
        case Opcode::compare:
            set(frame, operation.results,
                holds(frame, operation.predicate, operation.left, operation.right) ? 1 : 0);
            break;
        case Opcode::load:
            for (std::size_t i = 0; i < operation.results.size(); ++i) {
                frame.values[operation.results[i]] = memory[static_cast<uint16_t>(left + i)];
            }
            break;
        case Opcode::store:
            for (std::size_t i = 0; i < operation.right.size(); ++i) {
                memory[static_cast<uint16_t>(left + i)] = read(frame, operation.right[i]);
            }
            break;
        case Opcode::stack_address:
            set(frame, operation.results, frame.stack + operation.immediate16);
            break;
        case Opcode::call:
            if (is_flat(operation)) return call_flat(frame, operation);
            call_symbol(frame, operation, operation.symbol);
            break;
        case Opcode::call_indirect:
            if (is_flat(operation)) return call_flat(frame, operation);
            for (const auto& [symbol, address] : addresses_) {
                if (address == left && module_.find(symbol) != nullptr) {
                    call_symbol(frame, operation, symbol);
                    return;
                }
            }
            throw std::runtime_error("call through a pointer to no function");
        default:
            break;
    }
}

void Interpreter::call_symbol(Frame& frame, const Operation& operation, SymbolId symbol) {
    const Function* callee = module_.find(symbol);
    if (callee == nullptr) {
        if (call_runtime(frame, operation, module_.symbols[symbol])) return;
        throw std::runtime_error("no function " + module_.symbols[symbol]);
    }
    std::vector<uint8_t> arguments;
    for (const Bytes& argument : operation.arguments) {
        for (const ByteId byte : argument) arguments.push_back(read(frame, byte));
    }
    const std::vector<uint8_t> result = run(*callee, arguments);
    for (std::size_t i = 0; i < result.size(); ++i) frame.values[operation.results[i]] = result[i];
}

bool Interpreter::call_runtime(Frame& frame, const Operation& operation, const std::string& name) {
    // The routines' operands have 64 bits at most.
    const auto argument = [&](std::size_t i) {
        return static_cast<uint64_t>(number(frame, operation.arguments.at(i)));
    };
    const auto signed_argument = [&](std::size_t i) {
        return static_cast<int64_t>(signed_number(frame, operation.arguments.at(i)));
    };
    if (name == "__memcpy" || name == "__memmove") {
        copy_block(argument(0), argument(1), argument(2));
        return true;
    }
    if (name == "__memset") {
        for (uint64_t i = 0; i < argument(2); ++i) {
            memory[static_cast<uint16_t>(argument(0) + i)] = static_cast<uint8_t>(argument(1));
        }
        return true;
    }
    const std::size_t size = operation.arguments.at(0).size();
    const Bytes low(operation.results.begin(),
                    operation.results.begin() +
                        static_cast<std::ptrdiff_t>(std::min(size, operation.results.size())));
    const Bytes high(operation.results.begin() + static_cast<std::ptrdiff_t>(low.size()),
                     operation.results.end());
    if (name == "__mul8s" || name == "__smul16w") {
        set(frame, operation.results,
            static_cast<uint64_t>(signed_argument(0) * signed_argument(1)));
    } else if (name == "__mul8_s16w") {
        set(frame, operation.results, argument(0) * static_cast<uint64_t>(signed_argument(1)));
    } else if (name.starts_with("__mul") || name.starts_with("__umul")) {
        set(frame, operation.results, Wide{argument(0)} * argument(1));
    } else if (name.starts_with("__udiv")) {
        const uint64_t divisor = argument(1);
        set(frame, low, divisor == 0 ? 0 : argument(0) / divisor);
        set(frame, high, divisor == 0 ? 0 : argument(0) % divisor);
    } else if (name.starts_with("__sdiv")) {
        const int64_t dividend = signed_argument(0);
        const int64_t divisor = signed_argument(1);
        const bool undefined = divisor == 0 || (divisor == -1 && dividend == INT64_MIN);
        set(frame, low, undefined ? 0 : static_cast<uint64_t>(dividend / divisor));
        set(frame, high, undefined ? 0 : static_cast<uint64_t>(dividend % divisor));
    } else if (name.starts_with("__shl")) {
        set(frame, operation.results, argument(1) > 63 ? 0 : argument(0) << argument(1));
    } else if (name.starts_with("__lshr")) {
        set(frame, operation.results, argument(1) > 63 ? 0 : argument(0) >> argument(1));
    } else if (name.starts_with("__ashr")) {
        set(frame, operation.results,
            static_cast<uint64_t>(signed_argument(0) >> std::min<uint64_t>(argument(1), 63)));
    } else {
        return false;
    }
    return true;
}

void Interpreter::copy_block(uint64_t to, uint64_t from, uint64_t count) {
    std::vector<uint8_t> bytes;
    for (uint64_t i = 0; i < count; ++i) bytes.push_back(memory[static_cast<uint16_t>(from + i)]);
    for (uint64_t i = 0; i < count; ++i) memory[static_cast<uint16_t>(to + i)] = bytes[i];
}

uint64_t Interpreter::call(const std::string& name, const std::vector<uint64_t>& arguments) {
    const auto symbol = module_.symbol_ids.find(name);
    const Function* function =
        symbol == module_.symbol_ids.end() ? nullptr : module_.find(symbol->second);
    if (function == nullptr) throw std::runtime_error("no function " + name);
    std::vector<uint8_t> bytes;
    uint32_t in_memory = 0;
    for (std::size_t i = 0; i < function->parameters.size(); ++i) {
        const Bytes& parameter = function->parameters[i];
        const uint64_t value = arguments.at(i);
        // Behind lower_calls() what is no parameter any more is in memory.
        if (function->bytes[parameter[0]].kind != ByteInfo::Kind::parameter) {
            const auto size = static_cast<unsigned>(parameter.size());
            set_cell(name + "@args", size, value, in_memory);
            in_memory += size;
            continue;
        }
        for (std::size_t k = 0; k < parameter.size(); ++k) {
            bytes.push_back(static_cast<uint8_t>(value >> 8 * k));
        }
    }
    uint64_t result = 0;
    const std::vector<uint8_t> returned = run(*function, bytes);
    for (const FrameObject& object : function->frame) {
        if (module_.symbols[object.symbol] == name + "@result") {
            return variable(name + "@result", object.size);
        }
    }
    for (std::size_t i = returned.size(); i-- > 0;) result = result << 8 | returned[i];
    return result;
}

uint64_t Interpreter::variable(const std::string& name, unsigned size) const {
    const uint16_t from = address(name);
    uint64_t value = 0;
    for (unsigned i = size; i-- > 0;) value = value << 8 | memory[static_cast<uint16_t>(from + i)];
    return value;
}

}  // namespace codegen_test
