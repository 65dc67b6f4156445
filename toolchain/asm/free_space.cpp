// free_space.cpp - see free_space.hpp.
#include "toolchain/asm/free_space.hpp"

#include <algorithm>

namespace toolchain::assembly {

std::optional<uint32_t> FreeSpace::take(uint32_t size, uint32_t alignment) {
    for (const Region& gap : gaps_) {
        const uint32_t address = (gap.first + alignment - 1) / alignment * alignment;
        if (address + size > gap.end()) continue;
        remove({address, size});
        return address;
    }
    return {};
}

std::optional<uint32_t> FreeSpace::take_top(uint32_t size) {
    for (auto gap = gaps_.rbegin(); gap != gaps_.rend(); ++gap) {
        if (gap->size < size) continue;
        const uint32_t address = gap->end() - size;
        remove({address, size});
        return address;
    }
    return {};
}

void FreeSpace::remove(Region region) {
    std::vector<Region> left;
    for (const Region& gap : gaps_) {
        const uint32_t below = std::clamp(region.first, gap.first, gap.end());
        const uint32_t above = std::clamp(region.end(), below, gap.end());
        if (below > gap.first) left.push_back({gap.first, below - gap.first});
        if (gap.end() > above) left.push_back({above, gap.end() - above});
    }
    gaps_ = std::move(left);
}

uint32_t FreeSpace::free() const {
    uint32_t bytes = 0;
    for (const Region& gap : gaps_) bytes += gap.size;
    return bytes;
}

uint32_t FreeSpace::largest_gap() const {
    uint32_t bytes = 0;
    for (const Region& gap : gaps_) bytes = std::max(bytes, gap.size);
    return bytes;
}

}  // namespace toolchain::assembly
