// cleanup.cpp - see cleanup.hpp.
#include "toolchain/codegen/cleanup.hpp"

#include <algorithm>
#include <optional>

#include "toolchain/codegen/coder.hpp"
#include "toolchain/codegen/known_values.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

using namespace resource;
using Items = std::vector<CodeItem>;

constexpr unsigned kMemory = 6;
constexpr uint8_t kAni = 0xE6, kXri = 0xEE, kOri = 0xF6, kCpi = 0xFE, kAdi = 0xC6, kSui = 0xD6;
constexpr uint8_t kOraA = 0xB7, kAnaA = 0xA7, kInrA = 0x3C, kDcrA = 0x3D, kXraA = 0xAF;

bool is_move(uint8_t opcode) {
    return opcode >= 0x40 && opcode < 0x80 && opcode != op::kHlt;
}

/// Can every instruction be followed? Stacks of variables and computed jumps are left alone.
bool is_plain(const Items& items, uint32_t frame_bytes) {
    if (frame_bytes > kMostSlots) return false;
    return std::none_of(items.begin(), items.end(), [](const CodeItem& item) {
        if (!is_instruction(item)) return false;
        const uint8_t opcode = item.opcode;
        const bool moves_stack = opcode == op::kXthl || opcode == op::kSphl ||
                                 opcode == op::kDadSp || opcode == op::kLxiSp || opcode == 0x33 ||
                                 opcode == 0x3B;
        const bool jumps_away = opcode == op::kPchl || (opcode & 0xC7) == 0xC7;
        if (moves_stack || jumps_away) return true;
        if (item.operand.kind != CodeOperand::Kind::frame) return false;
        const bool address = (opcode & 0xCF) == op::kLxi;
        const bool direct =
            opcode == op::kLda || opcode == op::kSta || opcode == op::kLhld || opcode == op::kShld;
        return !address && !direct;
    });
}

class Cleanup {
public:
    Cleanup(Items& items, uint32_t frame_bytes, RegisterSet at_return)
        : items_(items), frame_bytes_(frame_bytes), at_return_(of(at_return)) {}

    void run() {
        constexpr unsigned kMostRounds = 6;
        for (unsigned round = 0; round < kMostRounds; ++round) {
            changed_ = false;
            look();
            rewrite_all();
            drop_marked();
            look();
            drop_pushes();
            drop_marked();
            look();
            drop_dead();
            drop_marked();
            if (!changed_) return;
        }
    }

private:
    void look() {
        exits_ = find_exits(items_);
        pointers_ = find_slot_pointers(items_, exits_);
        find_accesses();
        live_ = find_live(items_, exits_, accesses_, at_return_);
        dropped_.assign(items_.size(), false);
        uses_k_ = std::any_of(items_.begin(), items_.end(), [](const CodeItem& item) {
            return is_instruction(item) && op::asks_k(item.opcode);
        });
    }

    void find_accesses() {
        KnownValues known(items_, exits_, frame_bytes_);
        accesses_.clear();
        for (std::size_t i = 0; i < items_.size(); ++i) {
            accesses_.push_back(known.access(items_[i], pointers_[i]));
            known.step(items_[i], exits_[i], accesses_[i]);
        }
    }

    void rewrite_all() {
        KnownValues known(items_, exits_, frame_bytes_);
        known_ = &known;
        for (at_ = 0; at_ < items_.size(); ++at_) {
            if (dropped_[at_]) continue;
            if (is_instruction(items_[at_])) rewrite(items_[at_]);
            if (dropped_[at_]) continue;
            known.step(items_[at_], exits_[at_], access_now());
        }
    }

    // A load from a slot may have become a move.
    [[nodiscard]] SlotAccess access_now() const {
        const bool memory = effects_of(items_[at_]).memory != MemoryAccess::none;
        return memory ? accesses_[at_] : SlotAccess{};
    }

    // -- Questions -------------------------------------------------------------------------------
    [[nodiscard]] bool dead(ResourceSet which) const { return (live_[at_].registers & which) == 0; }
    [[nodiscard]] bool k_is_dead() const { return !uses_k_ || dead(kK); }
    [[nodiscard]] ValueNumber slot(uint32_t i = 0) const {
        return known_->state.slots[accesses_[at_].first + i];
    }
    [[nodiscard]] std::size_t next_instruction() const {
        std::size_t next = at_ + 1;
        while (next < items_.size() && dropped_[next]) ++next;
        return next < items_.size() && is_instruction(items_[next]) ? next : items_.size();
    }

    // -- Changes ---------------------------------------------------------------------------------
    void drop() {
        dropped_[at_] = true;
        changed_ = true;
    }
    void become(uint8_t opcode) {
        items_[at_].opcode = opcode;
        items_[at_].operand = {};
        changed_ = true;
    }
    void move_from(Register to, ValueNumber value) {
        if (const auto from = known_->find(value, set_of(to))) become(mov(to, *from));
    }

    void rewrite(CodeItem& item) {
        const uint8_t opcode = item.opcode;
        if (is_move(opcode)) return rewrite_move(item);
        if ((opcode & 0xCF) == op::kLxi) return rewrite_lxi(item);
        if ((opcode & 0xC7) == op::kMvi) return rewrite_mvi(item);
        if (opcode >= 0x80 && opcode < 0xC0) return rewrite_arithmetic(item);
        switch (opcode) {
            case op::kLda:
                if (!accesses_[at_].known()) return;
                if (slot() == known_->in(Register::a)) return drop();
                return move_from(Register::a, slot());
            case op::kSta:
                if (accesses_[at_].known() && slot() == known_->in(Register::a)) drop();
                return;
            case op::kLhld:
                return rewrite_lhld();
            case op::kShld:
                if (accesses_[at_].known() && slot(0) == known_->in(Register::l) &&
                    slot(1) == known_->in(Register::h)) {
                    drop();
                }
                return;
            case op::kXchg:
                return rewrite_xchg();
            default:
                return rewrite_immediate(item);
        }
    }

    void rewrite_move(const CodeItem& item) {
        const unsigned to = item.opcode >> 3 & 7U;
        const unsigned from = item.opcode & 7U;
        if (to == kMemory) {
            const bool same =
                accesses_[at_].known() && slot() == known_->in(static_cast<Register>(from));
            if (same) drop();
            return;
        }
        const auto target = static_cast<Register>(to);
        if (from == kMemory) {
            if (!accesses_[at_].known()) return skip_between(item);
            if (slot() == known_->in(target)) return drop();
            return move_from(target, slot());
        }
        if (known_->in(static_cast<Register>(from)) == known_->in(target)) return drop();
        skip_between(item);
    }

    // MOV A,x; MOV y,A with A dead is MOV y,x.
    void skip_between(const CodeItem& item) {
        const std::size_t next = next_instruction();
        if (next == items_.size()) return;
        const unsigned to = item.opcode >> 3 & 7U;
        const uint8_t second = items_[next].opcode;
        const bool moves_on = is_move(second) && (second & 7U) == to;
        if (!moves_on || (live_[next].registers & of(to)) != 0) return;
        const unsigned last = second >> 3 & 7U;
        if (last == to) return;
        if (last == kMemory && ((item.opcode & 7U) == kMemory || to == 4 || to == 5)) return;
        items_[next].opcode = static_cast<uint8_t>((second & 0xF8U) | (item.opcode & 7U));
        if ((item.opcode & 7U) == kMemory) accesses_[next] = accesses_[at_];
        drop();
    }

    void rewrite_lxi(CodeItem& item) {
        const unsigned pair = item.opcode >> 4 & 3U;
        if (pair == 3) return;
        const auto low = static_cast<Register>(2 * pair + 1);
        const auto high = static_cast<Register>(2 * pair);
        const ValueNumber wanted_low = known_->loaded(item.operand, CodeOperand::Part::low);
        const ValueNumber wanted_high = known_->loaded(item.operand, CodeOperand::Part::high);
        const bool low_there = known_->in(low) == wanted_low;
        const bool high_there = known_->in(high) == wanted_high;
        if (low_there && high_there) return drop();
        if (near(item, low, high)) return;
        if (take_word(pair, wanted_low, wanted_high)) return;
        if (!low_there && !high_there) return;
        // Half of it is there.
        if (item.operand.kind == CodeOperand::Kind::frame) return;
        const Register missing = low_there ? high : low;
        const bool upper = missing == high;
        if (item.operand.kind == CodeOperand::Kind::number) {
            item.operand.offset = item.operand.offset >> (upper ? 8 : 0) & 0xFF;
        } else {
            item.operand.part = upper ? CodeOperand::Part::high : CodeOperand::Part::low;
        }
        item.opcode = by_register(op::kMvi, missing);
        changed_ = true;
        rewrite_mvi(item);
    }

    // INX or DCX from what the pair holds.
    bool near(const CodeItem& item, Register low, Register high) {
        const ValueInfo& first = known_->info(known_->in(low));
        const ValueInfo& second = known_->info(known_->in(high));
        using Kind = ValueInfo::Kind;
        int32_t distance = 0;
        const bool same = first.symbol == second.symbol && first.number == second.number;
        if (item.operand.kind == CodeOperand::Kind::number) {
            if (first.kind != Kind::constant || second.kind != Kind::constant) return false;
            distance =
                static_cast<int16_t>(item.operand.offset - first.number - 256 * second.number);
        } else if (item.operand.kind == CodeOperand::Kind::symbol) {
            if (first.kind != Kind::symbol_low || second.kind != Kind::symbol_high || !same ||
                first.symbol != item.operand.id) {
                return false;
            }
            distance = item.operand.offset - first.number;
        } else if (item.operand.kind == CodeOperand::Kind::frame) {
            if (first.kind != Kind::slot_low || second.kind != Kind::slot_high || !same) {
                return false;
            }
            distance = item.operand.offset - first.number;
        } else {
            return false;
        }
        if ((distance != 1 && distance != -1) || !k_is_dead()) return false;
        const auto pair = static_cast<Pair>(static_cast<unsigned>(high) / 2);
        become(by_pair(distance == 1 ? op::kInx : op::kDcx, pair));
        return true;
    }

    // A word that is in other registers: XCHG, or a move of the half that is missing, or both.
    bool take_word(unsigned pair, ValueNumber low, ValueNumber high) {
        const auto low_register = static_cast<Register>(2 * pair + 1);
        const auto high_register = static_cast<Register>(2 * pair);
        const bool low_there = known_->in(low_register) == low;
        const bool high_there = known_->in(high_register) == high;
        if (low_there != high_there) {
            const Register missing = low_there ? high_register : low_register;
            const auto from = known_->find(low_there ? high : low, set_of(missing));
            if (!from) return false;
            become(mov(missing, *from));
            return true;
        }
        if (pair == 0) return false;
        const Pair other = pair == 1 ? Pair::hl : Pair::de;
        if (known_->in(low_of(other)) != low || known_->in(high_of(other)) != high) return false;
        if (!dead(other == Pair::hl ? kHl : kDe)) return false;
        become(op::kXchg);
        return true;
    }

    void rewrite_lhld() {
        if (!accesses_[at_].known()) return;
        if (slot(0) == known_->in(Register::l) && slot(1) == known_->in(Register::h)) {
            return drop();
        }
        if (take_word(2, slot(0), slot(1))) return;
        // One half only is wanted.
        for (const Register half : {Register::l, Register::h}) {
            const ResourceSet other = half == Register::l ? of(4U) : of(5U);
            if (!dead(other)) continue;
            const ValueNumber value = slot(half == Register::l ? 0 : 1);
            if (known_->in(half) == value) return drop();
            return move_from(half, value);
        }
    }

    void rewrite_mvi(CodeItem& item) {
        const unsigned to = item.opcode >> 3 & 7U;
        const ValueNumber value = known_->loaded(item.operand, item.operand.part);
        if (to == kMemory) {
            if (accesses_[at_].known() && slot() == value) drop();
            return;
        }
        const auto target = static_cast<Register>(to);
        if (target == Register::a && subtract_from_borrow(item)) return;
        if (known_->in(target) == value) return drop();
        if (known_->find(value, set_of(target))) return move_from(target, value);
        if (dead(kSign) && k_is_dead()) {
            const int distance = distance_to(value, known_->in(target));
            if (distance == 1) return become(by_register(op::kInr, target));
            if (distance == -1) return become(by_register(op::kDcr, target));
        }
        join_halves(item, to);
    }

    // By how much a byte is more than another, if that is known and 1 or -1; else 0.
    [[nodiscard]] int distance_to(ValueNumber wanted, ValueNumber there) const {
        const ValueInfo& to = known_->info(wanted);
        const ValueInfo& from = known_->info(there);
        using Kind = ValueInfo::Kind;
        if (to.kind != from.kind || to.symbol != from.symbol) return 0;
        const int32_t distance = to.number - from.number;
        if (to.kind == Kind::symbol_high) return distance % 256 == 0 ? near_one(distance / 256) : 0;
        if (to.kind != Kind::constant) return 0;
        return near_one(static_cast<int8_t>(distance));
    }
    static int near_one(int32_t distance) { return distance == 1 || distance == -1 ? distance : 0; }

    // MVI A,0; SBB x is SBB A; SUB x if nobody wants the borrow: 0 or FFH, less x.
    bool subtract_from_borrow(const CodeItem& item) {
        constexpr uint8_t kSbbA = 0x9F, kSbb = 0x98, kSub = 0x90;
        const std::size_t next = next_instruction();
        const bool zero =
            item.operand.kind == CodeOperand::Kind::number && (item.operand.offset & 0xFF) == 0;
        if (!zero || next == items_.size()) return false;
        const uint8_t second = items_[next].opcode;
        if ((second & 0xF8U) != kSbb || second == kSbbA) return false;
        if ((live_[next].registers & kCarry) != 0) return false;
        become(kSbbA);
        items_[next].opcode = static_cast<uint8_t>(kSub | (second & 7U));
        return true;
    }

    // MVI of both halves is LXI.
    void join_halves(CodeItem& item, unsigned to) {
        const std::size_t next = next_instruction();
        if (next == items_.size() || to == 7) return;
        const CodeItem& second = items_[next];
        const bool both = second.opcode == by_register(op::kMvi, static_cast<Register>(to ^ 1U)) &&
                          item.operand.kind == CodeOperand::Kind::number &&
                          second.operand.kind == CodeOperand::Kind::number;
        if (!both) return;
        const int32_t high = to % 2 == 0 ? item.operand.offset : second.operand.offset;
        const int32_t low = to % 2 == 0 ? second.operand.offset : item.operand.offset;
        items_[next].opcode = by_pair(op::kLxi, static_cast<Pair>(to / 2));
        items_[next].operand.offset = (high & 0xFF) << 8 | (low & 0xFF);
        drop();
    }

    void rewrite_arithmetic(const CodeItem& item) {
        if ((item.opcode & 7U) == kMemory) {
            if (!accesses_[at_].known()) return;
            const auto from = known_->find(slot(), 0);
            if (from)
                become(static_cast<uint8_t>((item.opcode & 0xF8U) | static_cast<unsigned>(*from)));
            return;
        }
        const bool clears = item.opcode == kXraA && dead(kFlags);
        if (clears && known_->constant_in(Register::a) == 0) return drop();
        const bool tests = item.opcode == kOraA || item.opcode == kAnaA;
        if (tests && dead(kCarry) && k_is_dead() && known_->state.tested == known_->in(Register::a))
            drop();
    }

    void rewrite_xchg() {
        const bool same = known_->in(Register::d) == known_->in(Register::h) &&
                          known_->in(Register::e) == known_->in(Register::l);
        if (same) return drop();
        const std::size_t next = next_instruction();
        if (next == items_.size() || items_[next].opcode != op::kXchg) return;
        dropped_[next] = true;
        drop();
    }

    void rewrite_immediate(const CodeItem& item) {
        if (item.operand.kind != CodeOperand::Kind::number) return;
        const int32_t number = item.operand.offset & 0xFF;
        switch (item.opcode) {
            case kXri:
                if (number == 0xFF && dead(kFlags)) become(op::kCma);
                return;
            case kCpi:
                if (number == 0) become(kOraA);
                return;
            case kAni:
                if (number == 0xFF) become(kOraA);
                return;
            case kOri:
                if (number == 0) become(kOraA);
                return;
            case kAdi:
                if (number == 1 && dead(kCarry)) become(kInrA);
                if (number == 0xFF && dead(kCarry)) become(kDcrA);
                return;
            case kSui:
                if (number == 1 && dead(kCarry)) become(kDcrA);
                if (number == 0xFF && dead(kCarry)) become(kInrA);
                return;
            default:
                return;
        }
    }

    // -- PUSH and POP that keep nothing ----------------------------------------------------------
    void drop_pushes() {
        std::vector<std::size_t> open;
        for (std::size_t i = 0; i < items_.size(); ++i) {
            if (dropped_[i]) continue;
            if (!is_instruction(items_[i]) || !exits_[i].labels.empty() || exits_[i].leaves) {
                open.clear();
                continue;
            }
            const uint8_t opcode = items_[i].opcode;
            if ((opcode & 0xCF) == op::kPush) open.push_back(i);
            if ((opcode & 0xCF) != op::kPop) continue;
            if (open.empty()) continue;
            const std::size_t push = open.back();
            open.pop_back();
            if ((items_[push].opcode | 4U) != (opcode | 4U)) continue;
            if (!keeps_something(push, i)) dropped_[push] = dropped_[i] = changed_ = true;
        }
    }

    // Live behind the POP, and changed between.
    [[nodiscard]] bool keeps_something(std::size_t push, std::size_t pop) const {
        ResourceSet changed = 0;
        for (std::size_t i = push + 1; i < pop; ++i) {
            if (!dropped_[i]) changed |= effects_of(items_[i]).writes;
        }
        const ResourceSet kept = effects_of(items_[pop]).writes;
        return (kept & changed & live_[pop].registers) != 0;
    }

    // -- What nobody reads -----------------------------------------------------------------------
    void drop_marked() {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < items_.size(); ++i) {
            if (dropped_[i]) continue;
            if (kept != i) items_[kept] = std::move(items_[i]);
            ++kept;
        }
        items_.resize(kept);
    }

    void drop_dead() {
        for (std::size_t i = 0; i < items_.size(); ++i) {
            if (is_instruction(items_[i]) && is_dead(i)) dropped_[i] = changed_ = true;
        }
    }

    [[nodiscard]] bool is_dead(std::size_t i) const {
        const Effects effects = effects_of(items_[i]);
        const uint8_t opcode = items_[i].opcode;
        const bool unread = (effects.writes & live_[i].registers) == 0;
        if (effects.pure) return unread;
        const SlotAccess& access = accesses_[i];
        if (!access.known() || effects.memory == MemoryAccess::none) return false;
        if (!unread) return false;
        if (!access.writes) return true;
        for (uint32_t k = 0; k < access.size; ++k) {
            if (live_[i].slots.test(access.first + k)) return false;
        }
        return (opcode & 0xC0) != 0xC0;
    }

    Items& items_;
    uint32_t frame_bytes_;
    ResourceSet at_return_;
    std::vector<Exits> exits_{};
    std::vector<ResourceSet> pointers_{};
    std::vector<SlotAccess> accesses_{};
    std::vector<Live> live_{};
    std::vector<bool> dropped_{};
    KnownValues* known_ = nullptr;
    std::size_t at_ = 0;
    bool uses_k_ = false;  ///< some jump asks for K
    bool changed_ = false;
};

}  // namespace

void clean_up(std::vector<CodeItem>& items, uint32_t frame_bytes, RegisterSet at_return) {
    if (is_plain(items, frame_bytes)) Cleanup(items, frame_bytes, at_return).run();
}

}  // namespace toolchain::codegen
