// encode.hpp - values of operands, and the bytes of items.
// Internal     to link.cpp, listing.cpp and verify.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "toolchain/asm/object.hpp"
#include "toolchain/asm/program.hpp"
#include "toolchain/asm/source_lines.hpp"

namespace toolchain::assembly {

/// The values of a program's names.
class SymbolValues {
public:
    explicit SymbolValues(const Program& program);

    /// @param section  index into Program::sections, where local names are looked up first
    [[nodiscard]] std::optional<uint16_t> find(const std::string& name, std::size_t section) const;

private:
    std::unordered_map<std::string, uint16_t> global_;
    std::vector<std::unordered_map<std::string, uint16_t>> local_;  ///< by section
};

/// An operand as the source would say it: "LOW(table+3)", "12".
[[nodiscard]] std::string operand_text(const Operand& operand);

/// The bytes of an item, without its effect on the place counter.
/// @errors  Mistake: a name that is not defined, a value beyond the operand's range
[[nodiscard]] std::vector<uint8_t> encode(const Item& item, std::size_t section,
                                          const SymbolValues& values);

}  // namespace toolchain::assembly
