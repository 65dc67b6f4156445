// coder.hpp - appends instructions and keeps account of what every register and slot then holds.
// One Coder is one way to make code for a piece of a block; the search copies them and compares.
// Depends on   facts.hpp, machine.hpp, toolchain/isa (T-states, bytes, flags).
// Flags        nothing that moves values changes the flags, so carry chains may be interrupted.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "toolchain/codegen/facts.hpp"
#include "toolchain/codegen/machine.hpp"

namespace toolchain::codegen {

enum class Pair : uint8_t { bc = 0, de = 1, hl = 2 };

[[nodiscard]] constexpr Register low_of(Pair pair) {
    return static_cast<Register>(2 * static_cast<unsigned>(pair) + 1);
}
[[nodiscard]] constexpr Register high_of(Pair pair) {
    return static_cast<Register>(2 * static_cast<unsigned>(pair));
}
[[nodiscard]] constexpr RegisterSet set_of(Pair pair) {
    return static_cast<RegisterSet>(3U << 2 * static_cast<unsigned>(pair));
}

inline constexpr std::array<Register, 7> kRegisters = {
    Register::b, Register::c, Register::d, Register::e, Register::h, Register::l, Register::a};
inline constexpr std::array<Pair, 3> kPairs = {Pair::hl, Pair::de, Pair::bc};

/// What registers and slots hold at a point of a block.
struct State {
    std::array<ByteId, 8> content{kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone};
    std::array<Base, 3> sum{};                      ///< of pairs whose bytes have no id
    Bits in_slot{};                                 ///< by local number
    ByteId tested = kNone;                          ///< Z and S tell about this byte
    ByteId sign_in_carry = kNone;                   ///< CY is its top bit
    uint32_t carry_of = kNone;                      ///< CY is the carry of the sum there
    std::array<ByteId, 2> zero_in_k{kNone, kNone};  ///< K tells whether this word is 0

    bool operator==(const State&) const = default;
};

/// What a block finds when it is entered: registers; all else that is live is in its slot.
struct Contract {
    std::array<ByteId, 8> registers{kNone, kNone, kNone, kNone, kNone, kNone, kNone, kNone};
    std::vector<ByteId> not_in_slot{};  ///< sorted; live bytes that are in registers only

    [[nodiscard]] bool in_slot(ByteId byte) const;
    bool operator==(const Contract&) const = default;
    auto operator<=>(const Contract&) const = default;
};

/// What the end of a block should look like, for choices on the way there.
struct Wishes {
    std::vector<uint8_t> slot{};           ///< by local number: store it when it is made
    std::vector<RegisterSet> registers{};  ///< by local number: where successors want it
};

class Coder {
public:
    Coder(const FunctionFacts& facts, const BlockFacts& block, const Wishes& wishes,
          double byte_cost)
        : facts_(&facts), block_(&block), wishes_(&wishes), byte_cost_(byte_cost) {}

    State state{};
    std::vector<CodeItem> items{};  ///< of this operation
    bool only_cost = false;         ///< then `items` stays empty
    uint32_t emitted = 0;           ///< instructions, whether they are kept or not
    bool jumps = false;             ///< emit_jump() was called
    double cost = 0;                ///< T-states, and bytes by their weight
    bool failed = false;            ///< this way leads nowhere
    uint32_t position = 0;          ///< of the operation that is translated
    RegisterSet locks = 0;          ///< registers that hold what the operation needs
    RegisterSet doomed = 0;         ///< vacated: written next, what they still hold is no copy
    /// On an edge: what is still needed, by local number; replaces the uses of the block.
    const std::vector<uint8_t>* edge_needs = nullptr;

    // -- Instructions --------------------------------------------------------------------------
    void emit(uint8_t opcode, CodeOperand operand = {});
    void emit_number(uint8_t opcode, int32_t number);
    /// A jump within the code of one operation, taken with this probability.
    void emit_jump(uint8_t opcode, uint32_t label, double taken);
    void emit_label(uint32_t label);

    // -- What is where -------------------------------------------------------------------------
    [[nodiscard]] const FunctionFacts& facts() const { return *facts_; }
    [[nodiscard]] const BlockFacts& block() const { return *block_; }
    [[nodiscard]] const Wishes& wishes() const { return *wishes_; }
    [[nodiscard]] ByteId content(Register which) const {
        return state.content[static_cast<unsigned>(which)];
    }
    [[nodiscard]] bool holds(Register which, ByteId byte) const;
    [[nodiscard]] bool holds(Pair pair, ByteId low, ByteId high) const {
        return holds(low_of(pair), low) && holds(high_of(pair), high);
    }
    /// A register with the byte, or flags if there is none.
    [[nodiscard]] Register find(ByteId byte, RegisterSet among = kAllRegisters) const;
    [[nodiscard]] bool in_slot(ByteId byte) const;
    [[nodiscard]] bool constant(ByteId byte) const { return !facts_->computed(byte); }
    /// Used by this operation or behind it; `after`: behind it only.
    [[nodiscard]] bool needed(ByteId byte, bool after) const;
    [[nodiscard]] uint32_t next_use(ByteId byte) const;
    /// Would the byte be lost with this register, those of `lost` and the doomed ones?
    [[nodiscard]] bool only_copy(Register which, bool after, RegisterSet lost = 0) const;
    /// Is everything that is needed behind this operation in a register or slot?
    [[nodiscard]] bool complete() const;
    [[nodiscard]] Base sum_in(Pair pair) const;
    [[nodiscard]] uint32_t local(ByteId byte) const { return block_->local.find(byte); }

    void set(Register which, ByteId byte);
    void set(Pair pair, ByteId low, ByteId high) {
        set(low_of(pair), low);
        set(high_of(pair), high);
    }
    void set_sum(Pair pair, const Base& base);
    void forget(RegisterSet which);

    // -- Moving values. All of them keep what is needed and not locked, or fail. -----------------
    void lock(Register which) { locks |= set_of(which); }
    void lock(Pair pair) { locks |= set_of(pair); }
    /// The operation is done: nothing is reserved any more.
    void release() { locks = doomed = 0; }
    void unlock(RegisterSet which) { locks &= static_cast<RegisterSet>(~which); }
    /// Makes a register free to be written. @param after  operands of this operation may be lost
    void vacate(Register which, bool after = false);
    void vacate(Pair pair, bool after = false);
    /// The same without exchanging pairs: the value is also still there.
    void copy_out(Pair pair, bool after_low, bool after_high);
    /// Saves what is needed behind this operation from registers that it destroys.
    void save_from(RegisterSet destroyed);
    void load(Register which, ByteId byte);
    void load(Pair pair, ByteId low, ByteId high);
    /// Puts the byte of a register into the byte's slot.
    void store(Register which);
    void store(Pair pair);
    /// Stores results that successors want in slots.
    void store_wanted(const Bytes& results);
    void spill(Register which);
    /// HL = address of the byte's slot.
    void point_to_slot(ByteId byte);
    /// ADD, ADC, SUB, SBB, ANA, XRA, ORA, CMP (0 to 7) of A with a byte wherever it is.
    void alu(unsigned operation, ByteId byte);
    /// CY is the carry, or the borrow, of this operation, if a comparison will ask for it.
    void leave_carry();
    /// A free register for the byte, best for later uses; flags if there is none.
    [[nodiscard]] Register free_register(ByteId byte, RegisterSet avoid) const;
    [[nodiscard]] CodeOperand slot(ByteId byte) const;
    void mark_stored(ByteId byte);

private:
    bool load_near(Pair pair, const Base& wanted);
    bool load_by_ldhi(const Base& wanted);
    void load_from_slot(Register which, ByteId byte);
    void load_word_from_slot(Pair pair, ByteId low, ByteId high);
    void load_bytes(Pair pair, ByteId low, ByteId high);
    void exchange_halves(Pair pair);
    [[nodiscard]] bool free_now(Register which) const;
    [[nodiscard]] bool locked(Register which) const { return (locks & set_of(which)) != 0; }
    [[nodiscard]] bool locked(Pair pair) const { return (locks & set_of(pair)) != 0; }

    const FunctionFacts* facts_;
    const BlockFacts* block_;
    const Wishes* wishes_;
    double byte_cost_;
};

// Opcodes whose registers are in them.
[[nodiscard]] constexpr uint8_t mov(Register to, Register from) {
    return static_cast<uint8_t>(0x40 | static_cast<unsigned>(to) << 3 |
                                static_cast<unsigned>(from));
}
[[nodiscard]] constexpr uint8_t mov_from_memory(Register to) {
    return static_cast<uint8_t>(0x46 | static_cast<unsigned>(to) << 3);
}
[[nodiscard]] constexpr uint8_t mov_to_memory(Register from) {
    return static_cast<uint8_t>(0x70 | static_cast<unsigned>(from));
}
[[nodiscard]] constexpr uint8_t by_register(uint8_t opcode, Register which) {
    return static_cast<uint8_t>(opcode | static_cast<unsigned>(which) << 3);
}
[[nodiscard]] constexpr uint8_t by_pair(uint8_t opcode, Pair pair) {
    return static_cast<uint8_t>(opcode | static_cast<unsigned>(pair) << 4);
}

namespace op {
inline constexpr uint8_t kNop = 0x00, kLxi = 0x01, kStax = 0x02, kInx = 0x03, kInr = 0x04,
                         kDcr = 0x05, kMvi = 0x06, kRlc = 0x07, kDad = 0x09, kLdax = 0x0A,
                         kDcx = 0x0B, kRrc = 0x0F, kRal = 0x17, kRar = 0x1F, kRim = 0x20,
                         kShld = 0x22, kLhld = 0x2A, kCma = 0x2F, kSim = 0x30, kSta = 0x32,
                         kMviM = 0x36, kStc = 0x37, kLda = 0x3A, kCmc = 0x3F, kHlt = 0x76,
                         kAluImmediate = 0xC6, kPop = 0xC1, kPush = 0xC5, kJnz = 0xC2, kJmp = 0xC3,
                         kRet = 0xC9, kJz = 0xCA, kCall = 0xCD, kJnc = 0xD2, kOut = 0xD3,
                         kJc = 0xDA, kIn = 0xDB, kXthl = 0xE3, kPchl = 0xE9, kXchg = 0xEB,
                         kPopPsw = 0xF1, kJp = 0xF2, kDi = 0xF3, kPushPsw = 0xF5, kSphl = 0xF9,
                         kJm = 0xFA, kEi = 0xFB, kDadSp = 0x39, kLxiSp = 0x31;
// Undocumented: HL = HL - BC; HL to the right, with its sign; DE to the left through the carry;
// DE = HL + d8; a word from and to where DE points; jumps on K.
inline constexpr uint8_t kDsub = 0x08, kArhl = 0x10, kRdel = 0x18, kLdhi = 0x28, kShlx = 0xD9,
                         kJnk = 0xDD, kLhlx = 0xED, kJk = 0xFD;

/// Is it a jump on K? There are no returns and calls on K.
[[nodiscard]] constexpr bool asks_k(uint8_t opcode) {
    return opcode == kJnk || opcode == kJk;
}
/// Of a conditional jump, return or call: the one that is taken where this one is not.
[[nodiscard]] constexpr uint8_t inverted(uint8_t opcode) {
    return static_cast<uint8_t>(opcode ^ (asks_k(opcode) ? kJnk ^ kJk : 0x08));
}
}  // namespace op

namespace alu {
inline constexpr unsigned kAdd = 0, kAdc = 1, kSub = 2, kSbb = 3, kAna = 4, kXra = 5, kOra = 6,
                          kCmp = 7;
}  // namespace alu

}  // namespace toolchain::codegen
