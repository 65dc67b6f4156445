// known_values.hpp - which registers and bytes of the frame hold the same value, along finished
// code; constants and addresses by name.
// Depends on   code_flow.hpp.
// Labels       what all ways to a label agree on is known behind it, if they all come from above.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "toolchain/codegen/code_flow.hpp"

namespace toolchain::codegen {

/// A value: equal numbers are equal bytes. 0 is none.
using ValueNumber = uint32_t;

struct ValueInfo {
    enum class Kind : uint8_t { other, constant, symbol_low, symbol_high, slot_low, slot_high };
    Kind kind = Kind::other;
    uint32_t symbol = 0;
    int32_t number = 0;  ///< the constant, or the offset
    auto operator<=>(const ValueInfo&) const = default;
};

class KnownValues {
public:
    struct State {
        std::array<ValueNumber, 8> registers{};
        std::vector<ValueNumber> slots{};
        ValueNumber tested = 0;  ///< S and Z tell about it
        std::vector<std::array<ValueNumber, 2>> pushed{};
    };

    KnownValues(const std::vector<CodeItem>& items, const std::vector<Exits>& exits,
                uint32_t frame_bytes);

    /// What is known in front of the next item.
    State state{};

    [[nodiscard]] ValueNumber in(Register which) const {
        return state.registers[static_cast<unsigned>(which)];
    }
    [[nodiscard]] ValueNumber number_of(const ValueInfo& info);
    [[nodiscard]] const ValueInfo& info(ValueNumber number) const { return infos_[number]; }
    /// The byte that MVI loads, or that half of the word that LXI loads.
    [[nodiscard]] ValueNumber loaded(const CodeOperand& operand, CodeOperand::Part part);
    [[nodiscard]] std::optional<int32_t> constant_in(Register which) const;
    /// Where in the frame a pair points.
    [[nodiscard]] std::optional<uint32_t> slot_at(unsigned pair) const;
    /// @param pointers  registers that may hold parts of a slot's address
    [[nodiscard]] SlotAccess access(const CodeItem& item, ResourceSet pointers) const;
    /// A register other than `but` with the value.
    [[nodiscard]] std::optional<Register> find(ValueNumber value, ResourceSet but) const;

    /// Behind an item at that place of the code as it was.
    void step(const CodeItem& item, const Exits& exits, const SlotAccess& access);

private:
    ValueNumber fresh();
    void set(unsigned which, ValueNumber value);
    void arrive(uint32_t label);
    void enter(uint32_t label);
    void step_instruction(const CodeItem& item, const SlotAccess& access);
    bool step_move(const CodeItem& item, const SlotAccess& access);
    bool step_count(const CodeItem& item);
    void forget_all();
    [[nodiscard]] ValueNumber moved(ValueNumber low, ValueNumber high, int32_t by, bool of_high);

    std::map<ValueInfo, ValueNumber> numbers_{};
    std::vector<ValueInfo> infos_{};
    std::map<uint32_t, uint32_t> expected_{};  ///< ways to a label that have not come yet
    std::map<uint32_t, State> arrived_{};
    bool reached_ = true;
    uint32_t frame_bytes_;
};

}  // namespace toolchain::codegen
