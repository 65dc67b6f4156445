// expression.hpp - values and conditions that people type, read from the board when needed.
// Depends on   names.hpp, registers.hpp, host_sim/board.
// Syntax       terms joined by + and -: numbers, registers (A, HL, $, CY, T ...), symbols,
//              [ADDRESS] a byte of memory, word[ADDRESS] two, M for [HL]. Registers win over
//              symbols of the same name. A condition compares two values with == != < <= > >=;
//              several are joined by "and". Everything is unsigned unless subtraction makes it
//              less.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host_sim/board/board_state.hpp"
#include "tools/debug/names.hpp"
#include "tools/debug/registers.hpp"

namespace debug_console {

/// A value such as "HL+2", "main", "[buffer+1]".
class Expression {
public:
    /// @errors DebugError naming the part that is neither number, register nor symbol
    static Expression parse(std::string_view text, const Names& names);

    [[nodiscard]] int64_t value(const host_sim::BoardState& state) const;

private:
    struct Term {
        enum class Kind : uint8_t { number, name, byte, word };
        Kind kind = Kind::number;
        bool subtract = false;
        int64_t number = 0;
        Register which = Register::a;
        std::vector<Expression> address;  ///< of byte and word: one
    };
    static Term parse_term(std::string_view text, const Names& names);
    static int64_t term_value(const Term& term, const host_sim::BoardState& state);

    std::vector<Term> terms_;
};

/// "A == 5 and [HL] < 80H". The empty one always holds.
class Condition {
public:
    Condition() = default;
    /// @errors DebugError
    static Condition parse(std::string_view text, const Names& names);

    [[nodiscard]] bool holds(const host_sim::BoardState& state) const;
    /// As written; empty for the condition that always holds.
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    enum class Operator : uint8_t { equal, unequal, less, less_equal, greater, greater_equal };
    struct Comparison {
        Expression left;
        Operator how = Operator::equal;
        Expression right;
    };
    static Comparison parse_comparison(std::string_view text, const Names& names);

    std::string text_;
    std::vector<Comparison> comparisons_;
};

}  // namespace debug_console
