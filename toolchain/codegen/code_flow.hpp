// code_flow.hpp - finished code of a function as data flow: what is live behind each instruction,
// and which bytes of the frame an instruction reads or writes.
// Depends on   effects.hpp.
// Bounds       frames of up to kMostSlots bytes; larger ones are left as they are.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "toolchain/codegen/effects.hpp"

namespace toolchain::codegen {

inline constexpr std::size_t kMostSlots = 256;
using SlotSet = std::bitset<kMostSlots>;

/// Registers, flags and bytes of the frame that are read before they are written again.
struct Live {
    ResourceSet registers = 0;
    SlotSet slots{};
    bool operator==(const Live&) const = default;
    void add(const Live& other) {
        registers |= other.registers;
        slots |= other.slots;
    }
};

/// Which bytes of the frame an instruction reaches.
struct SlotAccess {
    static constexpr uint32_t kNowhere = UINT32_MAX, kAnywhere = UINT32_MAX - 1;
    uint32_t first = kNowhere;
    uint32_t size = 0;
    bool reads = false;
    bool writes = false;
    [[nodiscard]] bool known() const { return first < kAnywhere; }
};

/// Labels of jumps and table words from an instruction; `falls`: what follows is reached too.
struct Exits {
    std::vector<uint32_t> labels{};
    bool falls = true;
    bool leaves = false;
};
[[nodiscard]] bool is_instruction(const CodeItem& item);
/// Does control go on behind every instruction, or to labels, or back to the caller?
[[nodiscard]] bool can_be_followed(const std::vector<CodeItem>& items);
[[nodiscard]] std::vector<Exits> find_exits(const std::vector<CodeItem>& items);

/// @param at_return  registers that the caller looks at
[[nodiscard]] std::vector<Live> find_live(const std::vector<CodeItem>& items,
                                          const std::vector<Exits>& exits,
                                          const std::vector<SlotAccess>& accesses,
                                          ResourceSet at_return);

/// Registers that may hold a part of a slot's address in front of each instruction.
[[nodiscard]] std::vector<ResourceSet> find_slot_pointers(const std::vector<CodeItem>& items,
                                                          const std::vector<Exits>& exits);

}  // namespace toolchain::codegen
