// mir_verify.cpp - checks that a function means something before code is made of it.
// Depends on   mir.hpp.
#include <fmt/format.h>

#include <algorithm>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

namespace {

using Defined = std::vector<bool>;

bool needs_no_definition(const ByteInfo& info) {
    return info.kind != ByteInfo::Kind::computed && info.kind != ByteInfo::Kind::parameter;
}

/// The bytes that are defined on every way to a block: a fixed point over the blocks.
std::vector<Defined> defined_at_entry(const Function& function) {
    const Defined all(function.bytes.size(), true);
    std::vector<Defined> entry(function.blocks.size(), all);
    entry[0].assign(function.bytes.size(), false);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t index = 0; index < function.blocks.size(); ++index) {
            const Block& block = function.blocks[index];
            Defined now = entry[index];
            for (const ByteId byte : block.parameters) now[byte] = true;
            for (const Operation& operation : block.operations) {
                for (const ByteId byte : operation.results) now[byte] = true;
            }
            for (const Edge& edge : block.terminator.edges) {
                Defined& target = entry[edge.target];
                for (std::size_t byte = 0; byte < now.size(); ++byte) {
                    if (target[byte] && !now[byte]) {
                        target[byte] = false;
                        changed = true;
                    }
                }
            }
        }
    }
    return entry;
}

class Checker {
public:
    explicit Checker(const Function& function) : function_(function) {}

    std::string check() {
        if (function_.blocks.empty()) return "no block";
        for (const Block& block : function_.blocks) check_edges(block);
        if (!message_.empty()) return message_;
        const std::vector<Defined> entry = defined_at_entry(function_);
        Defined once(function_.bytes.size(), false);
        for (std::size_t index = 0; index < function_.blocks.size(); ++index) {
            block_ = index;
            check_block(function_.blocks[index], entry[index], once);
        }
        return message_;
    }

private:
    void fail(const std::string& what) {
        if (message_.empty()) message_ = fmt::format("block {}: {}", block_, what);
    }

    void check_edges(const Block& block) {
        using Kind = Terminator::Kind;
        const Kind kind = block.terminator.kind;
        std::size_t wanted = kind == Kind::jump ? 1 : kind == Kind::branch ? 2 : 0;
        if (kind == Kind::table) wanted = std::max<std::size_t>(1, block.terminator.edges.size());
        if (block.terminator.edges.size() != wanted) return fail("wrong number of edges");
        for (const Edge& edge : block.terminator.edges) {
            if (edge.target == 0 || edge.target >= function_.blocks.size()) {
                return fail("an edge to the entry or to nowhere");
            }
            if (edge.arguments.size() != function_.blocks[edge.target].parameters.size()) {
                return fail("an edge with the wrong number of arguments");
            }
        }
    }

    void use(const Bytes& bytes, const Defined& defined) {
        for (const ByteId byte : bytes) {
            if (byte >= function_.bytes.size()) return fail("no such byte");
            if (!needs_no_definition(function_.bytes[byte]) && !defined[byte]) {
                return fail(fmt::format("b{} is used where it is not defined", byte));
            }
        }
    }

    void define(const Bytes& bytes, Defined& defined, Defined& once, ByteInfo::Kind kind) {
        for (const ByteId byte : bytes) {
            if (once[byte]) fail(fmt::format("b{} is defined twice", byte));
            if (function_.bytes[byte].kind != kind) fail(fmt::format("b{} is no result", byte));
            once[byte] = true;
            defined[byte] = true;
        }
    }

    void check_block(const Block& block, Defined defined, Defined& once) {
        define(block.parameters, defined, once, ByteInfo::Kind::parameter);
        for (const Operation& operation : block.operations) {
            use(operation.left, defined);
            use(operation.right, defined);
            for (const Bytes& argument : operation.arguments) use(argument, defined);
            check_sizes(operation);
            define(operation.results, defined, once, ByteInfo::Kind::computed);
        }
        const Terminator& end = block.terminator;
        use(end.left, defined);
        use(end.right, defined);
        if (end.kind == Terminator::Kind::branch && end.left.size() != end.right.size()) {
            fail("a branch compares values of different sizes");
        }
        if (end.kind == Terminator::Kind::give_back && end.left.size() != function_.result_size) {
            fail("a result of the wrong size");
        }
        for (const Edge& edge : end.edges) use(edge.arguments, defined);
    }

    void check_sizes(const Operation& operation) {
        const std::size_t left = operation.left.size();
        const std::size_t right = operation.right.size();
        const std::size_t results = operation.results.size();
        bool fits = true;
        switch (operation.opcode) {
            case Opcode::add:
            case Opcode::subtract:
                fits = left == right && left == results && left > 0;
                break;
            case Opcode::bit_and:
            case Opcode::bit_or:
            case Opcode::bit_xor:
                fits = left == 1 && right == 1 && results == 1;
                break;
            case Opcode::shift_left:
            case Opcode::shift_right:
            case Opcode::shift_right_signed:
                fits = left == results && left > 0 && operation.immediate >= 1 &&
                       operation.immediate <= 7;
                break;
            case Opcode::sign_fill:
                fits = left == 1 && results == 1;
                break;
            case Opcode::compare:
                fits = left == right && left > 0 && results == 1;
                break;
            case Opcode::load:
                fits = left == 2 && results > 0;
                break;
            case Opcode::store:
                fits = left == 2 && right > 0;
                break;
            case Opcode::call_indirect:  // behind lower_calls() the target is among the arguments
                fits = left == 2 || (left == 0 && operation.argument_registers.size() >= 2);
                break;
            case Opcode::stack_address:
                fits = results == 2;
                break;
            default:
                break;
        }
        if (!fits) fail("an operation whose sizes do not fit");
    }

    const Function& function_;
    std::size_t block_ = 0;
    std::string message_;
};

}  // namespace

std::string verify(const Function& function) {
    return Checker(function).check();
}

}  // namespace toolchain::codegen
