// simplify.cpp - equal constants get equal ids; operations and parameters nobody needs disappear.
// Depends on   facts.hpp.
#include <algorithm>
#include <tuple>
#include <utility>

#include "toolchain/codegen/facts.hpp"

namespace toolchain::codegen {

namespace {

using Kind = ByteInfo::Kind;

template <typename Action>
void for_each_operand(Operation& operation, Action action) {
    action(operation.left);
    action(operation.right);
    for (Bytes& argument : operation.arguments) action(argument);
}

template <typename Action>
void for_each_operand(Terminator& end, Action action) {
    action(end.left);
    action(end.right);
    for (Edge& edge : end.edges) action(edge.arguments);
}

/// One id for each constant and each part of an address.
void intern_constants(Function& function) {
    std::map<std::tuple<Kind, uint8_t, SymbolId, int32_t>, ByteId> known;
    std::vector<ByteId> same(function.bytes.size());
    for (ByteId byte = 0; byte < function.bytes.size(); ++byte) {
        const ByteInfo& info = function.bytes[byte];
        same[byte] = byte;
        if (info.kind == Kind::computed || info.kind == Kind::parameter) continue;
        same[byte] = known.try_emplace({info.kind, info.constant, info.symbol, info.offset}, byte)
                         .first->second;
    }
    const auto rename = [&](Bytes& bytes) {
        for (ByteId& byte : bytes) byte = same[byte];
    };
    for (Block& block : function.blocks) {
        for (Operation& operation : block.operations) for_each_operand(operation, rename);
        for_each_operand(block.terminator, rename);
    }
}

bool has_effect(const Operation& operation) {
    switch (operation.opcode) {
        case Opcode::load:
            return operation.is_volatile;
        case Opcode::store:
        case Opcode::call:
        case Opcode::call_indirect:
        case Opcode::port_in:
        case Opcode::port_out:
        case Opcode::enable_interrupts:
        case Opcode::disable_interrupts:
        case Opcode::halt:
        case Opcode::read_mask:
        case Opcode::set_mask:
        case Opcode::no_operation:
            return true;
        default:
            return false;
    }
}

/// Is the byte that constant?
bool is_constant(const Function& function, ByteId byte, uint8_t value) {
    const ByteInfo& info = function.bytes[byte];
    return info.kind == Kind::constant && info.constant == value;
}

/// An order does not depend on the lowest bytes where those of the right are 00H (nothing is below
/// them) or those of the left FFH (nothing is above them): a test of the sign needs the top byte.
void shrink_comparison(const Function& function, Predicate predicate, Bytes& left, Bytes& right) {
    if (predicate == Predicate::equal || predicate == Predicate::not_equal) return;
    std::size_t count = 0;
    while (count + 1 < left.size() && (is_constant(function, right[count], 0x00) ||
                                       is_constant(function, left[count], 0xFF))) {
        ++count;
    }
    left.erase(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(count));
    right.erase(right.begin(), right.begin() + static_cast<std::ptrdiff_t>(count));
}

void shrink_comparisons(Function& function) {
    for (Block& block : function.blocks) {
        for (Operation& operation : block.operations) {
            if (operation.opcode != Opcode::compare) continue;
            shrink_comparison(function, operation.predicate, operation.left, operation.right);
        }
        Terminator& end = block.terminator;
        if (end.kind != Terminator::Kind::branch) continue;
        shrink_comparison(function, end.predicate, end.left, end.right);
    }
}

/// Bytes that something with an effect depends on.
class Needs {
public:
    explicit Needs(Function& function) : function_(function), needed_(function.bytes.size()) {
        for (bool again = true; again;) {
            changed_ = false;
            for (auto block = function.blocks.rbegin(); block != function.blocks.rend(); ++block) {
                visit(*block);
            }
            again = changed_;
        }
    }
    [[nodiscard]] bool needed(ByteId byte) const { return needed_[byte]; }
    [[nodiscard]] bool any(const Bytes& bytes) const {
        return std::any_of(bytes.begin(), bytes.end(), [&](ByteId byte) { return needed_[byte]; });
    }

private:
    void need(const Bytes& bytes, std::size_t count = SIZE_MAX) {
        for (std::size_t i = 0; i < std::min(count, bytes.size()); ++i) {
            if (!needed_[bytes[i]]) changed_ = needed_[bytes[i]] = true;
        }
    }
    void visit(Block& block) {
        need(block.terminator.left);
        need(block.terminator.right);
        for (const Edge& edge : block.terminator.edges) {
            const Bytes& wanted = function_.blocks[edge.target].parameters;
            for (std::size_t i = 0; i < wanted.size(); ++i) {
                if (needed_[wanted[i]]) need({edge.arguments[i]});
            }
        }
        for (auto at = block.operations.rbegin(); at != block.operations.rend(); ++at) {
            if (!has_effect(*at) && !any(at->results)) continue;
            // A carry goes up only: the bytes above the highest needed one do not matter.
            std::size_t count = SIZE_MAX;
            if (at->opcode == Opcode::add || at->opcode == Opcode::subtract ||
                at->opcode == Opcode::shift_left) {
                count = at->results.size();
                while (count > 0 && !needed_[at->results[count - 1]]) --count;
            }
            need(at->left, count);
            need(at->right, count);
            for (const Bytes& argument : at->arguments) need(argument);
        }
    }

    Function& function_;
    std::vector<bool> needed_;
    bool changed_ = false;
};

void shrink(Operation& operation, const Needs& needs) {
    const bool from_top = operation.opcode == Opcode::add || operation.opcode == Opcode::subtract ||
                          operation.opcode == Opcode::shift_left ||
                          (operation.opcode == Opcode::load && !operation.is_volatile);
    if (!from_top) return;
    while (operation.results.size() > 1 && !needs.needed(operation.results.back())) {
        operation.results.pop_back();
        if (operation.opcode == Opcode::load) continue;
        operation.left.pop_back();
        if (!operation.right.empty()) operation.right.pop_back();
    }
}

void drop_parameters(Block& block, const Needs& needs) {
    std::vector<uint32_t> sizes;
    std::size_t next = 0;
    for (const uint32_t size : block.parameter_sizes) {
        uint32_t kept = 0;
        for (uint32_t i = 0; i < size && next < block.parameters.size(); ++i, ++next) {
            if (needs.needed(block.parameters[next])) ++kept;
        }
        if (kept != 0) sizes.push_back(kept);
    }
    block.parameter_sizes = std::move(sizes);
    std::erase_if(block.parameters, [&](ByteId byte) { return !needs.needed(byte); });
}

void drop_unneeded(Function& function) {
    const Needs needs(function);
    for (Block& block : function.blocks) {
        std::erase_if(block.operations, [&](const Operation& operation) {
            return !has_effect(operation) && !needs.any(operation.results);
        });
        for (Operation& operation : block.operations) shrink(operation, needs);
        for (Edge& edge : block.terminator.edges) {
            const Bytes& parameters = function.blocks[edge.target].parameters;
            Bytes kept;
            for (std::size_t i = 0; i < parameters.size(); ++i) {
                if (needs.needed(parameters[i])) kept.push_back(edge.arguments[i]);
            }
            edge.arguments = std::move(kept);
        }
    }
    for (std::size_t index = 1; index < function.blocks.size(); ++index) {
        drop_parameters(function.blocks[index], needs);
    }
}

/// Branches keep how likely their edges are when the block that tells it disappears.
void keep_probabilities(Function& function) {
    std::vector<uint32_t> entered(function.blocks.size(), 0);
    for (const Block& block : function.blocks) {
        for (const Edge& edge : block.terminator.edges) ++entered[edge.target];
    }
    for (Block& block : function.blocks) {
        Terminator& end = block.terminator;
        if (end.kind != Terminator::Kind::branch) continue;
        const double own = std::max(block.frequency, 1e-9);
        for (std::size_t i = 0; i < 2; ++i) {
            if (entered[end.edges[i].target] != 1) continue;
            const double share = function.blocks[end.edges[i].target].frequency / own;
            end.edges[i].probability = std::clamp(share, 0.001, 0.999);
            end.edges[1 - i].probability = 1 - end.edges[i].probability;
            break;
        }
    }
}

/// Does nothing but go on, with values from in front of it?
bool is_passage(const Function& function, BlockId index) {
    const Block& block = function.blocks[index];
    return index != 0 && block.operations.empty() && block.parameters.empty() &&
           block.loop_bound == 0 && block.terminator.kind == Terminator::Kind::jump &&
           block.terminator.edges[0].target != index;
}

void drop_blocks(Function& function, const std::vector<bool>& dropped) {
    std::vector<BlockId> number(function.blocks.size());
    std::vector<Block> kept;
    for (BlockId index = 0; index < function.blocks.size(); ++index) {
        number[index] = static_cast<BlockId>(kept.size());
        if (!dropped[index]) kept.push_back(std::move(function.blocks[index]));
    }
    function.blocks = std::move(kept);
    for (Block& block : function.blocks) {
        for (Edge& edge : block.terminator.edges) edge.target = number[edge.target];
    }
}

/// What enters a block without operations goes to its successor at once: the code of both edges
/// of a branch can then meet without a block between.
void drop_passages(Function& function) {
    std::vector<bool> dropped(function.blocks.size(), false);
    for (BlockId index = 0; index < function.blocks.size(); ++index) {
        if (!is_passage(function, index)) continue;
        const Edge onward = function.blocks[index].terminator.edges[0];
        for (Block& block : function.blocks) {
            for (Edge& edge : block.terminator.edges) {
                if (edge.target != index) continue;
                edge.target = onward.target;
                edge.arguments = onward.arguments;
            }
        }
        dropped[index] = true;
    }
    drop_blocks(function, dropped);
}

}  // namespace

void simplify(Function& function, const Steps& steps) {
    intern_constants(function);
    shrink_comparisons(function);
    drop_unneeded(function);
    keep_probabilities(function);
    if (steps.contains(Step::passages)) drop_passages(function);
}

}  // namespace toolchain::codegen
