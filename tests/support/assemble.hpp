// assemble.hpp - a two-pass assembler in Intel syntax, so that tests hold programs and not bytes.
// Depends on   toolchain/isa (its table is the list of instructions, undocumented ones included).
// Syntax       [label:] [instruction | directive] [; comment]
//              ORG n      go on at n, not backwards; the gap is 00
//              DB  n,'text',...    DW n,...    DS n (n bytes 00)    NAME EQU n    END
//              n: terms joined by + and -; a term is 10, 0AH, 101B, 'A', $ (address of this line's
//              first byte) or a symbol. Symbols tell upper from lower case, the rest does not.
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
