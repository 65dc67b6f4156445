// assemble_lines.hpp - taking a line of assembly source apart: fields, operands, expressions.
// Internal     to assemble.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace test_support {

/// A source line in its fields.
struct SourceLine {
    std::size_t number = 0;             ///< from 1
    std::string label;                  ///< in front of a colon, or of EQU
    std::string operation;              ///< upper case; empty: none
    std::vector<std::string> operands;  ///< split at commas outside of quotes
};

/// Takes all lines apart, up to END. @errors AssembleError
[[nodiscard]] std::vector<SourceLine> split_source(std::string_view source);

[[nodiscard]] std::string upper_case(std::string_view text);

/// Letter or one of _ ? @, then those and digits; not a register's name.
[[nodiscard]] bool is_symbol(std::string_view text);

/// The text of an operand that is a string: 'it''s' is it's. Nothing for other operands.
/// A single character is one too.
[[nodiscard]] std::optional<std::string> string_operand(std::string_view operand);

using Symbols = std::map<std::string, uint16_t>;

/// Evaluates expressions of one line.
class Evaluator {
public:
    /// @param line  its number, for errors
    /// @param here  the value of $
    Evaluator(const Symbols& symbols, std::size_t line, uint16_t here)
        : symbols_(symbols), line_(line), here_(here) {}

    /// @errors  AssembleError: no expression, an unknown symbol, beyond -32768 to 65535
    [[nodiscard]] int value(std::string_view expression) const;

private:
    [[nodiscard]] int term(std::string_view text) const;

    const Symbols& symbols_;
    std::size_t line_;
    uint16_t here_;
};

}  // namespace test_support
