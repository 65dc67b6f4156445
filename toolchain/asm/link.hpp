// link.hpp - modules to a program: drops what is not reached, places, resolves, encodes.
// Depends on   toolchain/isa.      Design       docs/design/assembler.md.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolchain/asm/object.hpp"
#include "toolchain/asm/program.hpp"
#include "toolchain/asm/startup.hpp"

namespace toolchain::assembly {

struct LinkOptions {
    AddressRange rom{0x0000, 0x7FFF};
    AddressRange ram{0x8000, 0xFEFF};
    uint32_t stack_size = 0;  ///< bytes kept at the top of `ram`
    /// Symbols that have to be reached, besides vectors and start-up. Sections with a fixed address
    /// are always kept.
    std::vector<std::string> roots{};
    /// A JMP to a symbol at an address: 0000H reset, 0024H TRAP, 002CH, 0034H, 003CH, 8 n for RST
    /// n.
    std::map<uint16_t, std::string> vectors{};
    /// Where the vectors stand, instead of at 0000H: for a program behind a loader, which forwards.
    uint16_t vector_base = 0;
    /// The loader's side: TRAP and RST 5.5 to 7.5 go on to the vectors of a program with this base.
    std::optional<uint16_t> forward_to{};
    /// Makes a start-up, with a JMP to it at `vector_base` unless `vectors` has one for 0000H.
    std::optional<StartupOptions> startup{};
};

/// Names that every program has; a module that defines one of them has its own.
///   __frames_start/_end, __data_start/_end, __data_image, __zero_start/_end, __stack_start/_end
[[nodiscard]] std::vector<std::pair<std::string_view, uint16_t>> linker_symbols(
    const Program& program);

/// Links modules. RAM from below: frames, initialised data, cleared data, persistent data; the
/// stack is at the top. Sections of ROM take the lowest gap that holds them, in their order.
/// @errors  Error: names defined twice or not at all, fixed sections that overlap, a range that is
///          full, operands beyond their range
[[nodiscard]] Program link(std::vector<Module> modules, const LinkOptions& options = {});

}  // namespace toolchain::assembly
