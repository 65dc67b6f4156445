// coverage.hpp - which opcodes and which bytes of memory a run has used.
// Depends on   host_sim/cpu/step_record.hpp, host_sim/image, toolchain/isa.
// Formats      docs/design/trace.md; the .info of lcov: geninfo(1), "FILES".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host_sim/cpu/step_record.hpp"
#include "host_sim/image/image.hpp"
#include "host_sim/image/symbols.hpp"

namespace host_sim {

/// How often each opcode was executed and each address executed, read and written.
class Coverage {
public:
    /// Takes the next step. Stack accesses of interrupts count as writes.
    void observe(const StepRecord& step);

    /// Executions of an opcode, those brought by an interrupt acknowledge not among them.
    [[nodiscard]] uint64_t opcode_count(uint8_t opcode) const { return opcodes_[opcode]; }
    /// Executions of the instruction that starts at an address.
    [[nodiscard]] uint64_t executed(uint16_t address) const { return executed_[address]; }
    [[nodiscard]] uint64_t read(uint16_t address) const { return read_[address]; }
    [[nodiscard]] uint64_t written(uint16_t address) const { return written_[address]; }

    /// "239 of 246 documented opcodes executed; not: DAA, ..." and the same for undocumented ones.
    [[nodiscard]] std::string opcode_text() const;

private:
    std::array<uint64_t, 256> opcodes_{};
    std::vector<uint64_t> executed_ = std::vector<uint64_t>(kAddressSpaceSize);
    std::vector<uint64_t> read_ = std::vector<uint64_t>(kAddressSpaceSize);
    std::vector<uint64_t> written_ = std::vector<uint64_t>(kAddressSpaceSize);
};

/// A program as text, a line for each instruction or byte of data.
struct Listing {
    struct Line {
        uint16_t address = 0;
        bool code = false;  ///< an instruction; otherwise data or a heading
    };
    std::string text;
    std::vector<Line> lines;  ///< in the order of the text
};

/// Disassembles an image. Functions of the symbols are code, everything else is data unless it was
/// executed; without symbols everything is taken for code. An executed instruction always starts
/// a line.
[[nodiscard]] Listing make_listing(const Image& image, const Symbols* symbols,
                                   const Coverage& coverage);

/// Coverage of the listing, as .info: each instruction is a line.
/// @param listing_file  name of the file that holds listing.text
[[nodiscard]] std::string lcov_of_listing(const Listing& listing, std::string_view listing_file,
                                          const Symbols* symbols, const Coverage& coverage);

/// Coverage of the source lines that the symbols name, as .info: a line was executed as often as
/// its most executed instruction. Empty when no symbol has a source line.
[[nodiscard]] std::string lcov_of_sources(const Symbols& symbols, const Coverage& coverage);

}  // namespace host_sim
