// free_space.hpp - the free addresses of a memory, and taking from them.
// Internal     to link.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "toolchain/asm/program.hpp"

namespace toolchain::assembly {

class FreeSpace {
public:
    explicit FreeSpace(AddressRange range) : gaps_{{range.first, range.size()}} {}

    /// Takes the lowest gap that holds so much. @return its address; nothing if there is none
    [[nodiscard]] std::optional<uint32_t> take(uint32_t size, uint32_t alignment = 1);

    /// Takes the highest addresses of the highest gap that holds so much.
    [[nodiscard]] std::optional<uint32_t> take_top(uint32_t size);

    /// Takes what is free of a region; the rest of it is not looked at.
    void remove(Region region);

    [[nodiscard]] uint32_t free() const;         ///< bytes in all gaps
    [[nodiscard]] uint32_t largest_gap() const;  ///< bytes

private:
    std::vector<Region> gaps_;  ///< ascending, not empty
};

}  // namespace toolchain::assembly
