// parse.hpp - assembly source in Intel syntax to a module.
// Syntax       [label:] [instruction | directive] [; comment]
//              SECTION name,kind[,options]   go on in that section; kinds and options are in
//                         docs/design/assembler.md
//              ORG n      of a section at a fixed address, or to fix one: go on at n, not
//              backwards;
//                         the gap is 00
//              DB  n,'text',...    DW n,...    DS n (n bytes 00)    NAME EQU n    END
//              ;@text     a note about this address, for the map
//              n: see expression.hpp. Symbols tell upper from lower case, the rest does not. A
//              symbol is letters, digits, _ ? @ . or anything in double quotes; one that begins
//              with . or ? is known in its section only.
// Depends on   toolchain/isa (its table is the list of instructions, undocumented ones included).
// Design       docs/design/assembler.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "toolchain/asm/object.hpp"

namespace toolchain::assembly {

struct ParseOptions {
    std::string file = "source";  ///< name for messages and locations
    /// Address of the section that is there before any SECTION, `code`. Nothing: relocatable.
    std::optional<uint16_t> origin{};
    /// Takes the comments that describe a routine of the runtime library (docs/spec/runtime.md): a
    /// comment line `;   key text` with key one of in, out, clobbers, t, calls, stack is the note
    /// `key text`, and the next label is a function.
    bool routine_comments = false;
};

/// Assembles a source as far as one can without knowing other modules.
/// @errors  Error with all mistakes; SECTION options, ORG, DS and EQU need names defined above them
[[nodiscard]] Module parse(std::string_view source, const ParseOptions& options = {});

}  // namespace toolchain::assembly
