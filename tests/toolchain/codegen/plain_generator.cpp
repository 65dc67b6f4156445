// plain_generator.cpp - see plain_generator.hpp. Opcodes are spelled as in the Intel tables.
#include "tests/toolchain/codegen/plain_generator.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

namespace codegen_test {

using namespace toolchain::codegen;

namespace {

enum Code : uint8_t {
    kNop = 0x00,
    kRal = 0x17,
    kRar = 0x1F,
    kRim = 0x20,
    kLxiH = 0x21,
    kInxH = 0x23,
    kSim = 0x30,
    kSta = 0x32,
    kDadSp = 0x39,
    kLda = 0x3A,
    kMviA = 0x3E,
    kMovBA = 0x47,
    kMovMA = 0x77,
    kHlt = 0x76,
    kMovAM = 0x7E,
    kAddB = 0x80,
    kAdcB = 0x88,
    kSubB = 0x90,
    kSbbB = 0x98,
    kSbbA = 0x9F,
    kAnaB = 0xA0,
    kXraB = 0xA8,
    kOraB = 0xB0,
    kOraC = 0xB1,
    kOraA = 0xB7,
    kJnz = 0xC2,
    kJmp = 0xC3,
    kJz = 0xCA,
    kRet = 0xC9,
    kCall = 0xCD,
    kOut = 0xD3,
    kSui = 0xD6,
    kIn = 0xDB,
    kAni = 0xE6,
    kXri = 0xEE,
    kDi = 0xF3,
    kPopPsw = 0xF1,
    kPushPsw = 0xF5,
    kSphl = 0xF9,
    kEi = 0xFB
};

constexpr std::array<uint8_t, 4> kPushes = {0xF5, 0xC5, 0xD5, 0xE5};
constexpr std::array<uint8_t, 4> kPops = {0xE1, 0xD1, 0xC1, 0xF1};
constexpr int32_t kTrapVector = 0x24;

uint8_t mov(Register to, Register from) {
    return static_cast<uint8_t>(0x40 | static_cast<unsigned>(to) << 3 |
                                static_cast<unsigned>(from));
}

class Plain {
public:
    Plain(const Module& module, const Function& function)
        : function_(function), jump_index_(find(module, "__jumpindex")) {
        next_label_ = static_cast<uint32_t>(function.blocks.size());
    }

    FunctionCode run() {
        code_.frame_bytes = static_cast<uint32_t>(function_.bytes.size());
        code_.clobbers = kAllRegisters;
        enter();
        for (BlockId id = 0; id < function_.blocks.size(); ++id) {
            label(id);
            const Block& block = function_.blocks[id];
            if (block.loop_bound != 0) {
                code_.items.push_back({CodeItem::Kind::loop_bound, 0, number(block.loop_bound)});
            }
            for (const Operation& operation : block.operations) translate(operation);
            finish(block.terminator);
        }
        return std::move(code_);
    }

private:
    static SymbolId find(const Module& module, const std::string& name) {
        const auto found = module.symbol_ids.find(name);
        return found == module.symbol_ids.end() ? kNone : found->second;
    }

    // -- Instructions ----------------------------------------------------------------------------

    void emit(uint8_t opcode, CodeOperand operand = {}) {
        const uint32_t line = place_.file == kNone ? 0 : place_.line;
        code_.items.push_back({CodeItem::Kind::instruction, opcode, operand, place_.file, line});
        if ((opcode & 0xCF) == 0xC5) pushed_ += 2;
        if ((opcode & 0xCF) == 0xC1) pushed_ -= 2;
        code_.stack_bytes = std::max(code_.stack_bytes, pushed_);
    }
    static CodeOperand number(uint32_t value) {
        return {CodeOperand::Kind::number, CodeOperand::Part::word, 0, static_cast<int32_t>(value)};
    }
    static CodeOperand slot(ByteId byte) {
        return {CodeOperand::Kind::frame, CodeOperand::Part::word, 0, static_cast<int32_t>(byte)};
    }
    static CodeOperand label_operand(uint32_t id) {
        return {CodeOperand::Kind::label, CodeOperand::Part::word, id, 0};
    }
    void label(uint32_t id) {
        code_.items.push_back({CodeItem::Kind::label, 0, label_operand(id)});
    }

    void get(ByteId byte) {
        const ByteInfo& info = function_.bytes[byte];
        switch (info.kind) {
            case ByteInfo::Kind::undefined:
                break;
            case ByteInfo::Kind::constant:
                emit(kMviA, number(info.constant));
                break;
            case ByteInfo::Kind::address_low:
            case ByteInfo::Kind::address_high: {
                const bool low = info.kind == ByteInfo::Kind::address_low;
                emit(kMviA, {CodeOperand::Kind::symbol,
                             low ? CodeOperand::Part::low : CodeOperand::Part::high, info.symbol,
                             info.offset});
                break;
            }
            default:
                emit(kLda, slot(byte));
        }
    }
    void put(ByteId byte) { emit(kSta, slot(byte)); }
    void get_into(Register which, ByteId byte) {
        get(byte);
        if (which != Register::a) emit(mov(which, Register::a));
    }

    // -- Operations ------------------------------------------------------------------------------

    void translate(const Operation& operation) {
        place_ = operation.place;
        switch (operation.opcode) {
            case Opcode::add:
                return chain(operation, kAddB, kAdcB);
            case Opcode::subtract:
                return chain(operation, kSubB, kSbbB);
            case Opcode::bit_and:
                return chain(operation, kAnaB, kAnaB);
            case Opcode::bit_or:
                return chain(operation, kOraB, kOraB);
            case Opcode::bit_xor:
                return chain(operation, kXraB, kXraB);
            case Opcode::shift_left:
            case Opcode::shift_right:
            case Opcode::shift_right_signed:
                return shift(operation);
            case Opcode::sign_fill:
                get(operation.left[0]);
                emit(kRal);
                emit(kSbbA);
                return put(operation.results[0]);
            case Opcode::compare:
                compare(operation.predicate, operation.left, operation.right);
                return put(operation.results[0]);
            case Opcode::load:
            case Opcode::store:
                return memory(operation);
            case Opcode::call:
            case Opcode::call_indirect:
                return call(operation);
            case Opcode::stack_address:
                emit(kLxiH, number(operation.immediate16));
                emit(kDadSp);
                emit(mov(Register::a, Register::l));
                put(operation.results[0]);
                emit(mov(Register::a, Register::h));
                return put(operation.results[1]);
            default:
                return processor(operation);
        }
    }

    void chain(const Operation& operation, uint8_t first, uint8_t rest) {
        for (std::size_t i = 0; i < operation.left.size(); ++i) {
            get_into(Register::b, operation.right[i]);
            get(operation.left[i]);
            emit(i == 0 ? first : rest);
            put(operation.results[i]);
        }
    }

    void shift(const Operation& operation) {
        const std::size_t size = operation.left.size();
        const bool left = operation.opcode == Opcode::shift_left;
        for (unsigned round = 0; round < operation.immediate; ++round) {
            const Bytes& from = round == 0 ? operation.left : operation.results;
            if (operation.opcode == Opcode::shift_right_signed) {
                get(from[size - 1]);
                emit(kRal);
            } else {
                emit(kOraA);
            }
            for (std::size_t i = 0; i < size; ++i) {
                const std::size_t at = left ? i : size - 1 - i;
                get(from[at]);
                emit(left ? kRal : kRar);
                put(operation.results[at]);
            }
        }
    }

    /// A = 1 if it holds, else 0; Z to match.
    void compare(Predicate predicate, const Bytes& left, const Bytes& right) {
        const bool equality = predicate == Predicate::equal || predicate == Predicate::not_equal;
        const std::size_t top = left.size() - 1;
        if (equality) {
            emit(0x0E, number(0));  // MVI C,0
            for (std::size_t i = 0; i <= top; ++i) {
                get_into(Register::b, right[i]);
                get(left[i]);
                emit(kXraB);
                emit(kOraC);
                emit(mov(Register::c, Register::a));
            }
            emit(kSui, number(1));
        } else {
            const bool is_signed = predicate == Predicate::less || predicate == Predicate::not_less;
            get(left[top]);
            if (is_signed) emit(kXri, number(0x80));
            emit(mov(Register::d, Register::a));
            get(right[top]);
            if (is_signed) emit(kXri, number(0x80));
            emit(mov(Register::e, Register::a));
            for (std::size_t i = 0; i <= top; ++i) {
                if (i == top) {
                    emit(mov(Register::b, Register::e));
                    emit(mov(Register::a, Register::d));
                } else {
                    get_into(Register::b, right[i]);
                    get(left[i]);
                }
                emit(i == 0 ? kSubB : kSbbB);
            }
        }
        emit(kSbbA);
        emit(kAni, number(1));
        const bool inverted = predicate == Predicate::not_equal ||
                              predicate == Predicate::not_below || predicate == Predicate::not_less;
        if (inverted) emit(kXri, number(1));
    }

    void memory(const Operation& operation) {
        get_into(Register::l, operation.left[0]);
        get_into(Register::h, operation.left[1]);
        if (operation.opcode == Opcode::load) {
            for (const ByteId byte : operation.results) {
                emit(kMovAM);
                put(byte);
                emit(kInxH);
            }
            return;
        }
        for (const ByteId byte : operation.right) {
            get(byte);
            emit(kMovMA);
            emit(kInxH);
        }
    }

    void bring(const Bytes& bytes, const std::vector<Register>& registers) {
        for (const bool to_a : {false, true}) {
            for (std::size_t i = 0; i < bytes.size(); ++i) {
                if ((registers.at(i) == Register::a) == to_a) get_into(registers[i], bytes[i]);
            }
        }
    }

    void take(const Bytes& bytes, const std::vector<Register>& registers) {
        for (const bool from_a : {true, false}) {
            for (std::size_t i = 0; i < bytes.size(); ++i) {
                if ((registers.at(i) == Register::a) != from_a) continue;
                if (!from_a) emit(mov(Register::a, registers[i]));
                put(bytes[i]);
            }
        }
    }

    void call(const Operation& operation) {
        std::vector<ByteId> saved;
        if (operation.reenters) {
            for (ByteId byte = 0; byte < function_.bytes.size(); ++byte) saved.push_back(byte);
        }
        for (const ByteId byte : saved) {
            emit(kLda, slot(byte));
            emit(kPushPsw);
        }
        bring(operation.arguments.at(0), operation.argument_registers);
        code_.calls.push_back({operation.symbol, operation.signature, pushed_});
        emit(kCall, {CodeOperand::Kind::symbol, CodeOperand::Part::word, operation.symbol, 0});
        take(operation.results, operation.result_registers);
        std::ranges::reverse(saved);
        for (const ByteId byte : saved) {
            emit(kPopPsw);
            if (std::ranges::find(operation.results, byte) == operation.results.end()) put(byte);
        }
    }

    void processor(const Operation& operation) {
        switch (operation.opcode) {
            case Opcode::port_in:
                emit(kIn, number(operation.immediate));
                break;
            case Opcode::port_out:
                get(operation.left.at(0));
                emit(kOut, number(operation.immediate));
                break;
            case Opcode::enable_interrupts:
                emit(kEi);
                break;
            case Opcode::disable_interrupts:
                emit(kDi);
                break;
            case Opcode::halt:
                emit(kHlt);
                break;
            case Opcode::read_mask:
                emit(kRim);
                break;
            case Opcode::set_mask:
                get(operation.left.at(0));
                emit(kSim);
                break;
            default:
                emit(kNop);
        }
        if (!operation.results.empty()) put(operation.results[0]);
    }

    // -- Entry, edges, exit ----------------------------------------------------------------------

    void move_stack(uint32_t by) {
        if (function_.stack_bytes == 0) return;
        emit(kLxiH, number(by));
        emit(kDadSp);
        emit(kSphl);
    }

    void enter() {
        if (function_.interrupt >= 0) {
            for (const uint8_t push : kPushes) emit(push);
        }
        if (function_.interrupt == kTrapVector) {  // the first RIM tells whether they were enabled
            emit(kRim);
            emit(kPushPsw);
        }
        take(function_.blocks[0].parameters, function_.parameter_registers);
        move_stack((0 - function_.stack_bytes) & 0xFFFF);
        pushed_ += function_.stack_bytes;
        code_.stack_bytes = std::max(code_.stack_bytes, pushed_);
    }

    // All arguments are read before any parameter is written.
    void follow(const Edge& edge) {
        for (const ByteId byte : edge.arguments) {
            get(byte);
            emit(kPushPsw);
        }
        const Bytes& parameters = function_.blocks[edge.target].parameters;
        for (std::size_t i = parameters.size(); i-- > 0;) {
            emit(kPopPsw);
            put(parameters[i]);
        }
        emit(kJmp, label_operand(edge.target));
    }

    void finish(const Terminator& end) {
        place_ = end.place;
        switch (end.kind) {
            case Terminator::Kind::jump:
                return follow(end.edges[0]);
            case Terminator::Kind::branch: {
                const uint32_t holds = next_label_++;
                compare(end.predicate, end.left, end.right);
                emit(kJnz, label_operand(holds));
                follow(end.edges[1]);
                label(holds);
                return follow(end.edges[0]);
            }
            case Terminator::Kind::table:
                return table(end);
            case Terminator::Kind::give_back:
                return give_back(end);
            case Terminator::Kind::unreachable:
                return emit(kHlt);
        }
    }

    void table(const Terminator& end) {
        if (jump_index_ == kNone) throw std::runtime_error("__jumpindex is no symbol");
        const uint32_t table = next_label_++;
        emit(kLxiH, label_operand(table));
        get(end.left[0]);
        emit(kJmp, {CodeOperand::Kind::symbol, CodeOperand::Part::word, jump_index_, 0});
        label(table);
        const uint32_t first = next_label_;
        next_label_ += static_cast<uint32_t>(end.edges.size());
        for (uint32_t i = 0; i < end.edges.size(); ++i) {
            code_.items.push_back({CodeItem::Kind::word, 0, label_operand(first + i)});
        }
        for (uint32_t i = 0; i < end.edges.size(); ++i) {
            label(first + i);
            follow(end.edges[i]);
        }
    }

    void leave_interrupt(bool enable) {
        for (const uint8_t pop : kPops) emit(pop);
        if (enable) emit(kEi);
        emit(kRet);
    }

    void give_back(const Terminator& end) {
        const uint32_t pushed = pushed_;
        move_stack(function_.stack_bytes);
        bring(end.left, function_.result_registers);
        if (function_.interrupt == kTrapVector) {
            const uint32_t disabled = next_label_++;
            emit(kPopPsw);
            emit(kAni, number(8));
            const uint32_t saved = pushed_;
            emit(kJz, label_operand(disabled));
            leave_interrupt(true);
            pushed_ = saved;
            label(disabled);
            leave_interrupt(false);
        } else if (function_.interrupt >= 0) {
            leave_interrupt(true);
        } else {
            emit(kRet);
        }
        pushed_ = pushed;
    }

    const Function& function_;
    const SymbolId jump_index_;
    FunctionCode code_;
    SourcePlace place_;
    uint32_t pushed_ = 0;
    uint32_t next_label_ = 0;
};

}  // namespace

FunctionCode plain_code(const Module& module, const Function& function,
                        const GenerateOptions& /*options*/) {
    return Plain(module, function).run();
}

}  // namespace codegen_test
