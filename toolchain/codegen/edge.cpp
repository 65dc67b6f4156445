// edge.cpp - see edge.hpp.
#include "toolchain/codegen/edge.hpp"

#include <algorithm>

namespace toolchain::codegen {

namespace {

/// A byte that has to get into the place of another in memory.
struct Copy {
    ByteId place;
    ByteId source;
};

class Crossing {
public:
    Crossing(Coder& coder, const Edge& edge, const Contract& target)
        : coder_(coder), needs_(coder.block().relevant.size(), 0) {
        const FunctionFacts& facts = coder.facts();
        wanted_.fill(kNone);
        for (const ByteId byte : facts.blocks[edge.target].live_in) {
            const ByteId source = passed_for(facts.function, edge, byte);
            if (facts.undefined(source)) continue;
            if (!target.in_slot(byte)) continue;
            if (facts.computed(source) && facts.same_place(byte, source) && coder.in_slot(source)) {
                kept_.push_back(source);
                continue;
            }
            copies_.push_back({byte, source});
        }
        for (const Register which : kRegisters) {
            const ByteId byte = target.registers[static_cast<unsigned>(which)];
            if (byte == kNone) continue;
            const ByteId source = passed_for(facts.function, edge, byte);
            if (!facts.undefined(source)) wanted_[static_cast<unsigned>(which)] = source;
        }
    }

    void run() {
        const Coder start = coder_;
        coder_.position = coder_.block().end;
        coder_.edge_needs = &needs_;
        while (!copies_.empty() && !coder_.failed) copy_one();
        update_needs();
        if (!coder_.failed && bring(coder_, wanted_)) {
            coder_.edge_needs = nullptr;
            return;
        }
        coder_ = start;
        over_the_stack();
    }

private:
    void need(ByteId byte) {
        const uint32_t at = coder_.block().local.find(byte);
        if (at != kNone) needs_[at] = 1;
    }

    void update_needs() {
        std::fill(needs_.begin(), needs_.end(), uint8_t{0});
        for (const Copy& copy : copies_) need(copy.source);
        for (const ByteId byte : wanted_) {
            if (byte != kNone) need(byte);
        }
    }

    [[nodiscard]] bool wanted_byte(ByteId byte) const {
        return std::find(wanted_.begin(), wanted_.end(), byte) != wanted_.end();
    }

    /// Would writing this place lose a value that something still has to read?
    [[nodiscard]] ByteId lost_by(ByteId place) const {
        const FunctionFacts& facts = coder_.facts();
        const auto lost = [&](ByteId source) {
            return facts.computed(source) && facts.same_place(source, place) &&
                   coder_.in_slot(source) && coder_.find(source) == Register::flags;
        };
        for (const Copy& other : copies_) {
            if (other.place != place && lost(other.source)) return other.source;
        }
        for (const ByteId byte : wanted_) {
            if (byte != kNone && lost(byte)) return byte;
        }
        return kNone;
    }

    // The next copy that destroys nothing; words before bytes.
    void copy_one() {
        update_needs();
        for (std::size_t i = 0; i < copies_.size(); ++i) {
            for (std::size_t j = 0; j < copies_.size(); ++j) {
                if (!coder_.facts().adjacent(copies_[i].place, copies_[j].place)) continue;
                if (!possible(i, j)) continue;
                if (copy_word(i, j)) return;
            }
        }
        for (std::size_t i = 0; i < copies_.size(); ++i) {
            if (lost_by(copies_[i].place) != kNone) continue;
            copy_byte(i);
            return;
        }
        // All wait for each other: what the first would destroy goes to a register.
        const ByteId saved = lost_by(copies_[0].place);
        const Register to = coder_.free_register(saved, 0);
        if (to == Register::flags) {
            coder_.failed = true;
            return;
        }
        coder_.load(to, saved);
    }

    [[nodiscard]] bool possible(std::size_t low, std::size_t high) const {
        const auto fine = [&](ByteId place, ByteId own_low, ByteId own_high) {
            const ByteId lost = lost_by(place);
            return lost == kNone || lost == own_low || lost == own_high;
        };
        const ByteId first = copies_[low].source;
        const ByteId second = copies_[high].source;
        if (!fine(copies_[low].place, first, second) || !fine(copies_[high].place, first, second)) {
            return false;
        }
        // A source that is read by another copy too must not be lost.
        for (std::size_t i = 0; i < copies_.size(); ++i) {
            if (i == low || i == high) continue;
            if (copies_[i].source == first || copies_[i].source == second) {
                if (lost_by(copies_[low].place) != kNone || lost_by(copies_[high].place) != kNone)
                    return false;
            }
        }
        return !((wanted_byte(first) || wanted_byte(second)) &&
                 (lost_by(copies_[low].place) != kNone || lost_by(copies_[high].place) != kNone));
    }

    void finish(std::size_t at) {
        // The place now holds the target's value: nothing of this block is in it.
        const ByteId place = copies_[at].place;
        for (uint32_t other = 0; other < coder_.block().relevant.size(); ++other) {
            if (coder_.facts().same_place(coder_.block().relevant[other], place)) {
                coder_.state.in_slot.reset(other);
            }
        }
    }

    void finish_word(std::size_t low, std::size_t high) {
        finish(low);
        finish(high);
        copies_.erase(copies_.begin() + static_cast<std::ptrdiff_t>(std::max(low, high)));
        copies_.erase(copies_.begin() + static_cast<std::ptrdiff_t>(std::min(low, high)));
    }

    bool copy_word(std::size_t low, std::size_t high) {
        const Copy first = copies_[low];
        const Copy second = copies_[high];
        if (coder_.holds(Pair::de, first.source, second.source)) {
            coder_.emit(op::kXchg);
            coder_.emit(op::kShld, coder_.slot(first.place));
            coder_.emit(op::kXchg);
            finish_word(low, high);
            return true;
        }
        Coder way = coder_;
        way.load(Pair::hl, first.source, second.source);
        if (way.failed) return false;
        way.emit(op::kShld, way.slot(first.place));
        coder_ = std::move(way);
        finish_word(low, high);
        return true;
    }

    void copy_byte(std::size_t at) {
        const Copy copy = copies_[at];
        Coder way = coder_;
        way.load(Register::a, copy.source);
        if (!way.failed) {
            way.emit(op::kSta, way.slot(copy.place));
            coder_ = std::move(way);
        } else {
            coder_.failed = true;
            return;
        }
        finish(at);
        copies_.erase(copies_.begin() + static_cast<std::ptrdiff_t>(at));
    }

    // -- The way that always works ---------------------------------------------------------------

    /// A = source. A's own value waits in the spare byte of the frame.
    void fetch(ByteId source, ByteId in_a) {
        const Register from = coder_.find(source, 0x3F);
        if (from != Register::flags) {
            coder_.emit(mov(Register::a, from));
        } else if (source == in_a) {
            coder_.emit(op::kLda, spare());
        } else if (coder_.in_slot(source)) {
            coder_.emit(op::kLda, coder_.slot(source));
        } else if (coder_.constant(source)) {
            coder_.set(Register::a, kNone);
            coder_.locks = 0x3F;
            coder_.load(Register::a, source);
            coder_.locks = 0;
        } else {
            coder_.failed = true;
        }
    }

    [[nodiscard]] static CodeOperand spare() {
        return {CodeOperand::Kind::frame, CodeOperand::Part::word, kNone, 0};
    }

    void over_the_stack() {
        std::vector<Copy> copies = first_copies_;
        const Wanted wanted = wanted_;
        std::fill(needs_.begin(), needs_.end(), uint8_t{0});
        coder_.edge_needs = &needs_;
        const ByteId in_a = coder_.content(Register::a);
        const auto a_index = static_cast<unsigned>(Register::a);
        if (in_a != kNone) coder_.emit(op::kSta, spare());
        coder_.set(Register::a, kNone);
        if (wanted[a_index] != kNone) {
            fetch(wanted[a_index], in_a);
            coder_.emit(op::kPushPsw);
        }
        for (const Copy& copy : copies) {
            fetch(copy.source, in_a);
            coder_.emit(op::kPushPsw);
        }
        for (const Register which : kRegisters) {
            if (which == Register::a || wanted[static_cast<unsigned>(which)] == kNone) continue;
            fetch(wanted[static_cast<unsigned>(which)], in_a);
            coder_.emit(op::kPushPsw);
        }
        for (auto which = kRegisters.rbegin(); which != kRegisters.rend(); ++which) {
            if (*which == Register::a || wanted[static_cast<unsigned>(*which)] == kNone) continue;
            coder_.emit(op::kPopPsw);
            coder_.emit(mov(*which, Register::a));
        }
        for (auto copy = copies.rbegin(); copy != copies.rend(); ++copy) {
            coder_.emit(op::kPopPsw);
            coder_.emit(op::kSta, coder_.slot(copy->place));
        }
        if (wanted[a_index] != kNone) coder_.emit(op::kPopPsw);
        coder_.edge_needs = nullptr;
    }

public:
    void remember() { first_copies_ = copies_; }

private:
    Coder& coder_;
    std::vector<uint8_t> needs_;
    Wanted wanted_{};
    std::vector<Copy> copies_;
    std::vector<Copy> first_copies_;
    std::vector<ByteId> kept_;
};

}  // namespace

void cross(Coder& coder, const Edge& edge, const Contract& target) {
    Crossing crossing(coder, edge, target);
    crossing.remember();
    crossing.run();
}

}  // namespace toolchain::codegen
