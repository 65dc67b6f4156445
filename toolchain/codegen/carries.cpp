// carries.cpp - see carries.hpp.
#include "toolchain/codegen/carries.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace toolchain::codegen {

namespace {

struct Comparison {
    Predicate predicate;
    const Bytes& left;
    const Bytes& right;
};

bool is_constant(const Function& function, const Bytes& bytes) {
    return std::ranges::all_of(
        bytes, [&](ByteId byte) { return function.bytes[byte].kind == ByteInfo::Kind::constant; });
}

/// Is first + second 2^bits + `more`, which is 0 or -1?
bool adds_up(const Function& function, const Bytes& first, const Bytes& second, int more) {
    if (first.size() != second.size() || !is_constant(function, first) ||
        !is_constant(function, second)) {
        return false;
    }
    unsigned carry = more == 0 ? 0 : 1;
    for (std::size_t i = 0; i < first.size(); ++i) {
        const unsigned sum =
            function.bytes[first[i]].constant + function.bytes[second[i]].constant + carry;
        if ((sum & 0xFFU) != 0) return false;
        carry = sum >> 8;
    }
    return carry == 1;
}

/// Does "left below right" say that the sum has a carry, or that it has none?
std::optional<bool> sum_wraps(const Function& function, const Operation& sum,
                              const Comparison& comparison) {
    if (comparison.left == sum.results &&
        (comparison.right == sum.left || comparison.right == sum.right)) {
        return true;
    }
    // x + number wraps unless x is below 2^bits - number.
    if (comparison.left == sum.left && adds_up(function, comparison.right, sum.right, 0)) {
        return false;
    }
    if (comparison.right == sum.left && adds_up(function, comparison.left, sum.right, -1)) {
        return true;
    }
    return std::nullopt;
}

std::optional<bool> carries(const Function& function, const Operation& operation,
                            const Comparison& comparison) {
    if (operation.opcode == Opcode::add) return sum_wraps(function, operation, comparison);
    if (operation.opcode == Opcode::subtract && comparison.left == operation.left &&
        comparison.right == operation.right) {
        return true;
    }
    return std::nullopt;
}

CarryAnswer answer(const Function& function, const Block& block, std::size_t end,
                   const Comparison& comparison) {
    if (comparison.predicate != Predicate::below && comparison.predicate != Predicate::not_below) {
        return {};
    }
    for (std::size_t i = end; i-- > 0;) {
        const auto wraps = carries(function, block.operations[i], comparison);
        if (wraps) return {static_cast<uint32_t>(i), !*wraps};
    }
    return {};
}

}  // namespace

std::vector<CarryAnswer> find_carry_answers(const Function& function, const Block& block) {
    const std::size_t count = block.operations.size();
    std::vector<CarryAnswer> answers(count + 1);
    for (std::size_t i = 0; i < count; ++i) {
        const Operation& operation = block.operations[i];
        if (operation.opcode != Opcode::compare) continue;
        answers[i] =
            answer(function, block, i, {operation.predicate, operation.left, operation.right});
    }
    const Terminator& end = block.terminator;
    if (end.kind == Terminator::Kind::branch) {
        answers[count] = answer(function, block, count, {end.predicate, end.left, end.right});
    }
    return answers;
}

}  // namespace toolchain::codegen
