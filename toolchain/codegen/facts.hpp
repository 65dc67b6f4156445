// facts.hpp - what code generation knows about a function before it makes any code: liveness,
// variables (places in memory that values share), uses inside a block.
// Depends on   mir.hpp.
// Design note  docs/design/compiler.md, "Register homes".
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "toolchain/codegen/carries.hpp"
#include "toolchain/codegen/mir.hpp"
#include "toolchain/codegen/steps.hpp"

namespace toolchain::codegen {

/// A set of small numbers. Up to 256 of them need no memory of their own: sets are copied a lot.
class Bits {
public:
    Bits() = default;
    explicit Bits(std::size_t size) : more_(size > kInside ? (size - kInside + 63) / 64 : 0) {}
    [[nodiscard]] bool test(std::size_t at) const { return (word(at) >> at % 64 & 1) != 0; }
    void set(std::size_t at) { word(at) |= uint64_t{1} << at % 64; }
    void reset(std::size_t at) { word(at) &= ~(uint64_t{1} << at % 64); }
    bool operator==(const Bits&) const = default;

private:
    static constexpr std::size_t kInside = 256;
    [[nodiscard]] const uint64_t& word(std::size_t at) const {
        return at < kInside ? inside_[at / 64] : more_[(at - kInside) / 64];
    }
    [[nodiscard]] uint64_t& word(std::size_t at) {
        return at < kInside ? inside_[at / 64] : more_[(at - kInside) / 64];
    }

    std::array<uint64_t, kInside / 64> inside_{};
    std::vector<uint64_t> more_;
};

/// A word as base plus delta, so that INX and DCX can make one address of another.
struct Base {
    uint32_t low = kNone;  ///< byte id, or a symbol or variable as `high` says
    uint32_t high = kNone;
    int32_t delta = 0;

    static constexpr uint32_t kSymbol = UINT32_MAX - 1;  ///< in `high`: low is a symbol
    static constexpr uint32_t kSlot = UINT32_MAX - 2;    ///< in `high`: low is a variable
    static constexpr uint32_t kNumber = UINT32_MAX - 3;  ///< in `high`: delta is all

    [[nodiscard]] bool known() const { return high != kNone; }
    [[nodiscard]] bool same_base(const Base& other) const {
        return known() && low == other.low && high == other.high;
    }
    bool operator==(const Base&) const = default;
};

/// Numbers from 0 for the bytes that matter in a block: an open hash table.
class LocalNumbers {
public:
    /// The byte's number, a new one if it has none.
    uint32_t add(ByteId byte);
    /// kNone if it has none.
    [[nodiscard]] uint32_t find(ByteId byte) const {
        for (std::size_t at = byte & mask_;; at = (at + 1) & mask_) {
            if (table_[at].byte == byte || table_[at].byte == kNone) return table_[at].number;
        }
    }

private:
    struct Entry {
        ByteId byte = kNone;
        uint32_t number = kNone;
    };
    void put(const Entry& entry);

    std::vector<Entry> table_ = std::vector<Entry>(16);
    std::size_t mask_ = 15;
    uint32_t count_ = 0;
};

/// Uses of bytes in one block. Positions: an operation's index; the number of operations for the
/// terminator; one more for what successors need.
struct BlockFacts {
    std::vector<ByteId> live_in{};              ///< parameters that are used included; sorted
    std::vector<ByteId> relevant{};             ///< every byte that matters here, by local number
    LocalNumbers local{};                       ///< its number
    std::vector<std::vector<uint32_t>> uses{};  ///< by local number, ascending
    std::vector<std::vector<uint32_t>> same_place{};  ///< by local number: others in its place
    std::vector<uint32_t> last_use{};                 ///< by local number; kNone: never
    std::vector<uint32_t> made{};  ///< by local number: 0 at the entry, else operation + 1
    std::vector<double> edge_probability{};
    std::vector<uint32_t> predecessors{};
    std::vector<CarryAnswer> carry_answers{};  ///< by position
    std::vector<uint32_t> carry_until{};       ///< by position: the last comparison that asks, or 0
    uint32_t end = 0;                          ///< position of what successors need
};

/// Everything about a function. The function is a copy that was made simpler: equal constants have
/// equal ids, and what nobody uses is gone.
struct FunctionFacts {
    Function function{};
    Steps steps{};                          ///< to be taken
    std::vector<uint32_t> variable{};       ///< of each byte that may be stored, else kNone
    std::vector<uint32_t> index{};          ///< of each byte in its variable
    std::vector<uint32_t> variable_size{};  ///< bytes
    std::vector<BlockFacts> blocks{};
    std::vector<Base> sum_of{};      ///< by low byte: the word with it is base + delta
    std::vector<ByteId> sum_high{};  ///< by low byte: that word's high byte
    std::vector<std::vector<uint32_t>> interferes{};  ///< variables that may not share memory

    [[nodiscard]] bool computed(ByteId byte) const {
        const ByteInfo::Kind kind = function.bytes[byte].kind;
        return kind == ByteInfo::Kind::computed || kind == ByteInfo::Kind::parameter;
    }
    [[nodiscard]] bool undefined(ByteId byte) const {
        return function.bytes[byte].kind == ByteInfo::Kind::undefined;
    }
    [[nodiscard]] bool constant(ByteId byte) const {
        return function.bytes[byte].kind == ByteInfo::Kind::constant;
    }
    /// Can LHLD and SHLD reach both?
    [[nodiscard]] bool adjacent(ByteId low, ByteId high) const {
        return computed(low) && computed(high) && variable[low] == variable[high] &&
               index[low] + 1 == index[high];
    }
    [[nodiscard]] bool same_place(ByteId first, ByteId second) const {
        return variable[first] == variable[second] && index[first] == index[second];
    }
    [[nodiscard]] Base base_of(ByteId low, ByteId high) const;
};

/// @param function  behind lower_calls()
/// @param steps     at first those for documented instructions
[[nodiscard]] FunctionFacts find_facts(Function function,
                                       const Steps& steps = Steps().documented());

/// The byte that an edge hands over for a byte of its target.
[[nodiscard]] ByteId passed_for(const Function& function, const Edge& edge, ByteId wanted);

/// Part of find_facts: gives equal constants and addresses one id, drops results that nobody needs.
void simplify(Function& function, const Steps& steps = {});

}  // namespace toolchain::codegen
