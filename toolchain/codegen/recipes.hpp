// recipes.hpp - the ways to make code for one operation; the block generator keeps the best.
// Depends on   coder.hpp.
// How to add   a way is a piece of code that takes a copy of the Coder, emits, names its results
//              and is added to the list. One that cannot work sets `failed`; the others remain.
//              Every operation needs a way that works whatever the registers hold.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "toolchain/codegen/coder.hpp"

namespace toolchain::codegen {

/// The condition of a jump, the first eight as in its opcode. K is set by a signed "less", and by a
/// count that passes 0; undocumented.
enum class Condition : uint8_t { nz, z, nc, c, po, pe, p, m, nk, k };

[[nodiscard]] constexpr Condition inverse(Condition condition) {
    return static_cast<Condition>(static_cast<uint8_t>(condition) ^ 1U);
}
[[nodiscard]] constexpr uint8_t jump_if(Condition condition) {
    if (condition == Condition::nk) return op::kJnk;
    if (condition == Condition::k) return op::kJk;
    return static_cast<uint8_t>(0xC2 | static_cast<unsigned>(condition) << 3);
}

/// A way to decide a comparison. Jumps of its own leave for `label_true` and `label_false`; behind
/// its last instruction the flags say it.
struct Decision {
    Coder coder;
    Condition condition = Condition::nz;  ///< holds if the predicate does
};

/// Labels that a decision may jump to.
struct Targets {
    uint32_t label_true = 0;
    uint32_t label_false = 0;
};

using Ways = std::vector<Coder>;

inline constexpr std::size_t kUsualItems = 12;

/// Tries a way: `action` works on a copy of `start`.
template <typename Action>
void add_way(Ways& ways, const Coder& start, Action action) {
    Coder coder = start;
    coder.items.clear();
    if (!coder.only_cost) coder.items.reserve(kUsualItems);
    action(coder);
    coder.release();
    if (!coder.failed) ways.push_back(std::move(coder));
}

/// What recipes need besides the Coder.
struct RecipeContext {
    uint32_t* next_label = nullptr;
    RegisterSet (*clobbers_of)(const void*, SymbolId) = nullptr;
    const void* clobbers_data = nullptr;

    [[nodiscard]] uint32_t label() const { return (*next_label)++; }
};

/// All ways for an operation. @errors std::logic_error if there is none
[[nodiscard]] Ways translate(const Coder& start, const Operation& operation,
                             const RecipeContext& context);

// -- One file each -------------------------------------------------------------------------------
void add_sums(Ways& ways, const Coder& start, const Operation& operation,
              const RecipeContext& context);
void add_logic(Ways& ways, const Coder& start, const Operation& operation);
void add_shifts(Ways& ways, const Coder& start, const Operation& operation);
void add_undocumented_shifts(Ways& ways, const Coder& start, const Operation& operation);
void add_loads(Ways& ways, const Coder& start, const Operation& operation);
void add_stores(Ways& ways, const Coder& start, const Operation& operation);
void add_compare(Ways& ways, const Coder& start, const Operation& operation,
                 const RecipeContext& context);
void add_calls(Ways& ways, const Coder& start, const Operation& operation,
               const RecipeContext& context);

/// Ways to decide predicate(left, right).
[[nodiscard]] std::vector<Decision> decide(const Coder& start, Predicate predicate,
                                           const Bytes& left, const Bytes& right,
                                           const Targets& targets);

/// Bytes that registers shall hold; kNone: nothing wanted.
using Wanted = std::array<ByteId, 8>;

/// Brings values into registers, all at once. False if this order of doing it fails.
[[nodiscard]] bool bring(Coder& coder, const Wanted& wanted);

/// Loads a byte into A, or a word into HL, for being destroyed.
void take_a(Coder& coder, ByteId byte);
void take_hl(Coder& coder, ByteId low, ByteId high);

/// A way to do A = A operation byte with A kept from being used for anything else.
void alu_on_a(Coder& coder, unsigned operation, ByteId byte);

/// Brings the words at `at` to HL, whose value may then be destroyed, and BC; bytes of both above
/// them are kept. @return  false: it failed
bool load_for_dsub(Coder& coder, const Bytes& left, const Bytes& right, std::size_t at);

/// Does the byte occur among those?
[[nodiscard]] bool occurs(const Bytes& bytes, ByteId byte, std::size_t from = 0);

/// Where results of a chain go: a register, or flags for the slot.
using Places = std::vector<Register>;

/// Places that are worth trying for a result of that many bytes.
[[nodiscard]] std::vector<Places> places_for(std::size_t size);

/// A holds a result: brings it to its place. @param left, right  operands still to be read
void place_result(Coder& coder, ByteId result, Register place, const Bytes& left,
                  const Bytes& right, std::size_t from);

}  // namespace toolchain::codegen
