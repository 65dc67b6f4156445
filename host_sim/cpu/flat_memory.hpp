// flat_memory.hpp - the 64 KB that the fast interpreter reads without asking anyone.
// Depends on   the standard library.
#pragma once

#include <array>
#include <cstdint>

namespace host_sim {

inline constexpr unsigned kPageSize = 256;
inline constexpr unsigned kPageCount = 0x10000 / kPageSize;

/// What a read of every address yields, and the pages that a write may simply change. A write to
/// any other page goes through the bus.
struct FlatMemory {
    std::array<uint8_t, 0x10000> bytes{};
    std::array<bool, kPageCount> page_writable{};

    [[nodiscard]] bool writable(uint16_t address) const {
        return page_writable[address / kPageSize];
    }

    bool operator==(const FlatMemory&) const = default;
};

/// 64 KB of RAM.
[[nodiscard]] inline FlatMemory all_ram() {
    FlatMemory memory;
    memory.page_writable.fill(true);
    return memory;
}

}  // namespace host_sim
