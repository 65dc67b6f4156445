// assemble.hpp - a source in Intel syntax as one program in flat memory, so that tests hold
// programs
//              and not bytes.
// Depends on   toolchain/asm; the syntax is in toolchain/asm/parse.hpp. Sections are put behind
// each
//              other, whatever their kind, and what is in none begins at 0000H or ORG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace test_support {

/// What a source assembles to: the bytes from the lowest address to the highest, and the values of
/// all labels and EQU names.
struct Assembled {
    uint16_t origin = 0;
    std::vector<uint8_t> bytes;
    std::map<std::string, uint16_t> symbols;
};

/// "line 3: what is wrong".
class AssembleError : public std::runtime_error {
public:
    AssembleError(std::size_t line, const std::string& reason);
    [[nodiscard]] std::size_t line() const { return line_; }

private:
    std::size_t line_;
};

/// Assembles a whole source.
/// @errors  AssembleError; ORG, DS and EQU need names defined above them
[[nodiscard]] Assembled assemble(std::string_view source);

}  // namespace test_support
