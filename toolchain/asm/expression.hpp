// expression.hpp - operands of assembly source: terms joined by + and -.
// A term       10, 0AH, 101B, 'A', $ (address of the line's first byte), a symbol, (expression),
//              LOW(expression), HIGH(expression).
// Internal     to parse.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolchain/asm/object.hpp"

namespace toolchain::assembly {

/// An address that is not known yet: a label, or a place in a section.
struct Base {
    std::string symbol{};          ///< empty: the start of `section`
    std::optional<int> section{};  ///< index in the module; nothing: defined elsewhere
    int32_t offset = 0;            ///< in the section
    bool negative = false;
};

/// A sum: a number and addresses.
struct Value {
    int32_t number = 0;
    std::vector<Base> bases{};
    Part part = Part::word;  ///< not word: of exactly one address and the number
};

/// What the parser knows about names.
struct Names {
    /// @errors  Mistake
    std::function<Value(const std::string& symbol)> symbol;
    std::function<Value()> here;  ///< $
    /// The address of a section if it is fixed.
    std::function<std::optional<int32_t>(int section)> address;
};

/// Evaluates an expression as far as it can be: differences within a section are numbers, and so
/// is what cannot be said as one address plus a number but lies in sections with a fixed address.
/// @return  a number, or one address that is not negative
/// @errors  Mistake: no expression, beyond -32768 to 65535, an address negated or added to another
[[nodiscard]] Value evaluate(std::string_view expression, const Names& names);

}  // namespace toolchain::assembly
