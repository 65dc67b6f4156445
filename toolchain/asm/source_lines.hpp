// source_lines.hpp - taking a line of assembly source apart into its fields.
// Internal     to parse.cpp and expression.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace toolchain::assembly {

/// What is wrong with a line; whoever knows the line adds it.
class Mistake : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A source line in its fields.
struct SourceLine {
    std::string label{};                  ///< in front of a colon, or of EQU; quotes removed
    std::string operation{};              ///< upper case; empty: none
    std::vector<std::string> operands{};  ///< split at commas outside of quotes and parentheses
    std::string note{};                   ///< behind ;@
};

/// @errors  Mistake
[[nodiscard]] SourceLine split_line(std::string_view text);

[[nodiscard]] std::string upper_case(std::string_view text);
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Position of the first of `wanted` outside of quotes and parentheses, or the size.
[[nodiscard]] std::size_t find_outside(std::string_view text, std::string_view wanted);

/// Letter or one of _ ? @ . and then those and digits, but not a register's name; or anything in
/// double quotes.
[[nodiscard]] bool is_symbol(std::string_view text);

/// A symbol as it is known: without its double quotes.
[[nodiscard]] std::string symbol_name(std::string_view text);

/// A symbol as source text: quoted if it has to be.
[[nodiscard]] std::string symbol_text(std::string_view name);

/// The text of an operand that is a string: 'it''s' is it's. Nothing for other operands.
/// A single character is one too.
[[nodiscard]] std::optional<std::string> string_operand(std::string_view operand);

}  // namespace toolchain::assembly
