// operation_table.hpp - integer operations as functions of a generated program, with what they
// must give.
// Depends on   the standard library; expected values are computed in 128 bits on the host.
// Program      operands are in the variables `in_a` and `in_b`, results go to `out[k]`; function
//              `case_N()` does case N. C for the widths that C has, LLVM IR for all others (clang
//              has no _BitInt for this target).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace target_test {

/// Holds every result of two 64-bit operands.
__extension__ using Wide = __int128;
__extension__ using UnsignedWide = unsigned __int128;

/// An integer type. Values are kept in 64 bits, zero above `bits`.
struct IntType {
    unsigned bits = 8;
    bool is_signed = false;

    [[nodiscard]] std::string c_name() const;   ///< u16, s16
    [[nodiscard]] std::string ir_name() const;  ///< i16
    [[nodiscard]] uint64_t mask() const { return ~uint64_t{0} >> (64 - bits); }
    [[nodiscard]] Wide number(uint64_t value) const;  ///< with its sign
    [[nodiscard]] unsigned bytes() const { return (bits + 7) / 8; }
    bool operator==(const IntType&) const = default;
};

/// Nothing where the language leaves the result undefined.
using Expected = std::function<std::optional<uint64_t>(uint64_t a, uint64_t b)>;

/// What lands in out[k], k being the index in Case::outputs.
struct Output {
    IntType type{};
    Expected expected{};
    std::string what{};  ///< for messages
};

struct Case {
    std::string name{};
    IntType left{};
    IntType right{};
    bool unary = false;
    /// Of the function's text; the function is `void case_N(void)`, N its place in the list.
    std::string text{};
    std::vector<Output> outputs{};
};

/// 0, 1, 2, the ends and halves of the range, alternating bits, powers of two and neighbours.
[[nodiscard]] std::vector<uint64_t> corners(IntType type);

/// A binary operation by name: add sub mul div rem and or xor shl shr min max addsat subsat rotl
/// rotr; addov subov mulov: the wrapped result, its lowest bit inverted if it overflowed; cmp: a
/// bit for each of == != < <= > >= from the lowest. Nothing where C leaves the result undefined.
[[nodiscard]] std::optional<uint64_t> evaluate(const std::string& operation, IntType type,
                                               uint64_t a, uint64_t b);

/// Operations written in C, on 8, 16, 32 and 64 bits: operands at run time through arguments, and
/// constants on either side.
[[nodiscard]] std::vector<Case> c_cases(const std::vector<unsigned>& widths);

/// Operations in LLVM IR on odd widths.
[[nodiscard]] std::vector<Case> ir_cases(const std::vector<unsigned>& widths);

/// Random structs of bit-fields, set, changed, copied and read, in C. One seed a case.
[[nodiscard]] std::vector<Case> field_cases(uint64_t first_seed, unsigned count);

/// The cases' functions: C or LLVM IR, as their texts are.
[[nodiscard]] std::string c_functions(const std::vector<Case>& cases);
[[nodiscard]] std::string ir_functions(const std::vector<Case>& cases);
/// C source of the mailbox, of a table of `count` cases, and of main, which stops (HLT) to let its
/// user fill the mailbox, then does case number `request`.
[[nodiscard]] std::string c_main(std::size_t count);

/// Slots of `out`.
inline constexpr unsigned kOutputSlots = 64;

}  // namespace target_test
