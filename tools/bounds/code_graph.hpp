// code_graph.hpp - the control-flow graph of an image, from its bytes.
// Depends on   host_sim/image, toolchain/isa.
// Procedures   begin where something calls, interrupts or jumps to another function's first
//              instruction. A jump to the first instruction of another function is a call behind
//              which the procedure returns.
// Refuses      PCHL, RST and bytes that are no program: nothing would be known of what follows.
// Design note  docs/design/bounds.md
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host_sim/image/image.hpp"
#include "host_sim/image/symbols.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace rover_bounds {

/// One instruction of the image.
struct Decoded {
    const toolchain::isa::Instruction* entry = nullptr;
    uint16_t address = 0;
    uint16_t operand = 0;  ///< of three bytes: the last two

    [[nodiscard]] uint16_t behind() const { return static_cast<uint16_t>(address + entry->bytes); }
};

/// Instructions in a row that are all executed when the first one is, a call's behind it left out.
struct Block {
    uint16_t first = 0, last = 0;  ///< addresses of the first and the last instruction
};

/// One way out of a block.
struct Edge {
    std::size_t from = 0;
    std::optional<std::size_t> to;   ///< nothing: the procedure ends
    uint32_t t = 0;                  ///< T-states of the block, its last instruction as on this way
    std::optional<uint16_t> callee;  ///< runs between the blocks
};

struct Procedure {
    uint16_t entry = 0;
    std::string name;
    std::vector<Block> blocks;  ///< the first one is entered first
    std::vector<Edge> edges;
    /// T-states of a call at most as the source states and tests them: its code is not looked at.
    std::optional<uint32_t> stated_t;
};

struct CodeGraph {
    std::map<uint16_t, Procedure> procedures;  ///< by entry

    [[nodiscard]] const Procedure& at(uint16_t entry) const { return procedures.at(entry); }
    /// A procedure and all that it calls, directly or not.
    [[nodiscard]] std::set<uint16_t> reached_from(uint16_t entry) const;
};

/// What is known of an image before its code is followed.
struct CodeSource {
    const host_sim::Image* image = nullptr;
    const host_sim::Symbols* symbols = nullptr;
    std::map<uint16_t, uint32_t> stated_t;  ///< by entry
};

/// @errors BudgetError: see above
[[nodiscard]] Decoded decode(const CodeSource& source, uint16_t address);

/// Everything that runs from `roots` on.
[[nodiscard]] CodeGraph read_code(const CodeSource& source, const std::vector<uint16_t>& roots);

/// One turn of an endless loop as a procedure of its own, which ends where it would begin anew.
/// @param header  the loop's first instruction
[[nodiscard]] Procedure read_turn(const CodeSource& source, const CodeGraph& graph,
                                  uint16_t header);

/// "file:line", or "address 1234H" where the symbols know no line.
[[nodiscard]] std::string source_place(const host_sim::Symbols& symbols, uint16_t address);

}  // namespace rover_bounds
