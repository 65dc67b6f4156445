// overlay.hpp - pass: places of static frames, so that functions which are never active together
// share memory.
// Why          a fixed address costs 13 T-states, a slot on the stack 27; and RAM is scarce.
// Invariant    two frames overlap only if no way from a root leads through both functions.
// Depends on   call_graph.hpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "toolchain/codegen/call_graph.hpp"

namespace toolchain::codegen {

struct Overlay {
    std::vector<uint32_t> offsets{};  ///< by function; of those reached from the roots
    uint32_t end = 0;                 ///< first byte behind all frames
};

/// A frame begins where the longest of its callers' frames ends; the roots' at `start`.
/// @param sizes       bytes of the frames, by function
/// @param alignments  powers of two, by function; empty: all 1
[[nodiscard]] Overlay overlay_frames(const CallGraph& graph, std::span<const std::size_t> roots,
                                     std::span<const uint32_t> sizes, uint32_t start,
                                     std::span<const uint32_t> alignments = {});

/// The next multiple of a power of two.
[[nodiscard]] constexpr uint32_t aligned(uint32_t offset, uint32_t alignment) {
    return (offset + alignment - 1) & ~(alignment - 1);
}

}  // namespace toolchain::codegen
