// facts.hpp - what code generation knows about a function before it makes any code: liveness,
// variables (places in memory that values share), uses inside a block.
// Depends on   mir.hpp.
// Design note  docs/design/compiler.md, "Register homes".
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

/// A set of small numbers.
class Bits {
public:
    Bits() = default;
    explicit Bits(std::size_t size) : words_((size + 63) / 64) {}
    [[nodiscard]] bool test(std::size_t at) const { return (words_[at / 64] >> at % 64 & 1) != 0; }
    void set(std::size_t at) { words_[at / 64] |= uint64_t{1} << at % 64; }
    void reset(std::size_t at) { words_[at / 64] &= ~(uint64_t{1} << at % 64); }
    bool operator==(const Bits&) const = default;

private:
    std::vector<uint64_t> words_;
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

/// Uses of bytes in one block. Positions: an operation's index; the number of operations for the
/// terminator; one more for what successors need.
struct BlockFacts {
    std::vector<ByteId> live_in{};              ///< parameters that are used included; sorted
    std::vector<ByteId> relevant{};             ///< every byte that matters here, by local number
    std::map<ByteId, uint32_t> local{};         ///< its number
    std::vector<std::vector<uint32_t>> uses{};  ///< by local number, ascending
    std::vector<uint32_t> made{};  ///< by local number: 0 at the entry, else operation + 1
    std::vector<double> edge_probability{};
    std::vector<uint32_t> predecessors{};
    uint32_t end = 0;  ///< position of what successors need
};

/// Everything about a function. The function is a copy that was made simpler: equal constants have
/// equal ids, and what nobody uses is gone.
struct FunctionFacts {
    Function function{};
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
[[nodiscard]] FunctionFacts find_facts(Function function);

/// The byte that an edge hands over for a byte of its target.
[[nodiscard]] ByteId passed_for(const Function& function, const Edge& edge, ByteId wanted);

/// Part of find_facts: gives equal constants and addresses one id, drops results that nobody needs.
void simplify(Function& function);

}  // namespace toolchain::codegen
