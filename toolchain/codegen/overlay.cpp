// overlay.cpp - see overlay.hpp.
#include "toolchain/codegen/overlay.hpp"

#include <algorithm>
#include <map>

namespace toolchain::codegen {

// Groups of functions that call one another lie behind each other like one frame, callers first.
Overlay overlay_frames(const CallGraph& graph, std::span<const std::size_t> roots,
                       std::span<const uint32_t> sizes, uint32_t start,
                       std::span<const uint32_t> alignments) {
    Overlay overlay;
    overlay.offsets.assign(sizes.size(), start);
    overlay.end = start;
    std::map<std::size_t, uint32_t> base;  // of a group that is reached
    for (const std::size_t root : roots) base[graph.group(root)] = start;
    const auto& bottom_up = graph.bottom_up();
    for (std::size_t at = bottom_up.size(); at > 0;) {
        const std::size_t group = graph.group(bottom_up[at - 1]);
        const std::size_t last = at;
        while (at > 0 && graph.group(bottom_up[at - 1]) == group) --at;
        const auto place = base.find(group);
        if (place == base.end()) continue;
        uint32_t next = place->second;
        for (std::size_t i = at; i < last; ++i) {
            const uint32_t alignment = alignments.empty() ? 1 : alignments[bottom_up[i]];
            if (sizes[bottom_up[i]] != 0) next = aligned(next, alignment);
            overlay.offsets[bottom_up[i]] = next;
            next += sizes[bottom_up[i]];
        }
        overlay.end = std::max(overlay.end, next);
        for (std::size_t i = at; i < last; ++i) {
            for (const GraphEdge& edge : graph.callees(bottom_up[i])) {
                const std::size_t callee = graph.group(edge.callee);
                if (callee == group) continue;
                uint32_t& wanted = base.try_emplace(callee, start).first->second;
                wanted = std::max(wanted, next);
            }
        }
    }
    return overlay;
}

}  // namespace toolchain::codegen
