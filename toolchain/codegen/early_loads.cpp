// early_loads.cpp - see early_loads.hpp.
#include "toolchain/codegen/early_loads.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "toolchain/codegen/code_flow.hpp"
#include "toolchain/codegen/coder.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

using namespace resource;
using Items = std::vector<CodeItem>;

constexpr uint8_t kXraA = 0xAF;
constexpr uint32_t kMostT = 14;  ///< of loads in front of a branch
constexpr uint32_t kMostTInLoop = 7;

bool is_label(const CodeItem& item) {
    return item.kind == CodeItem::Kind::label;
}

bool is_frame(const CodeItem& item) {
    return item.operand.kind == CodeOperand::Kind::frame;
}

/// Writes registers and nothing else, and may come early: memory that is not the frame's may be
/// volatile.
bool is_load(const CodeItem& item) {
    if (!is_instruction(item)) return false;
    const uint8_t opcode = item.opcode;
    if (opcode == kXraA) return true;  // MVI A,0
    if (opcode == op::kLda || opcode == op::kLhld) return is_frame(item);
    const Effects effects = effects_of(item);
    const bool moves = (opcode & 0xC7) == op::kMvi || (opcode & 0xCF) == op::kLxi ||
                       (opcode >= 0x40 && opcode < 0x80);
    return moves && effects.pure;
}

bool branches(const CodeItem& item) {
    return is_instruction(item) && item.operand.kind == CodeOperand::Kind::label &&
           isa::instruction(item.opcode).flow == isa::Flow::jump &&
           isa::instruction(item.opcode).conditional();
}

bool ends_flow(const CodeItem& item) {
    return is_instruction(item) && (item.opcode == op::kJmp || item.opcode == op::kRet);
}

class EarlyLoads {
public:
    EarlyLoads(Items& items, RegisterSet at_return) : items_(items), at_return_(of(at_return)) {}

    bool run_once() {
        look();
        for (std::size_t i = 0; i + 1 < items_.size(); ++i) {
            if (!branches(items_[i])) continue;
            if (const auto found = find(i)) {
                apply(i, *found);
                return true;
            }
            if (const auto found = find_passed(i)) {
                apply_passed(i, *found);
                return true;
            }
        }
        return false;
    }

private:
    /// Loads from `first` to `end`, where a jump, a return or a label stands.
    struct Found {
        std::size_t first = 0;
        std::size_t end = 0;
    };

    void look() {
        exits_ = find_exits(items_);
        live_ = find_live(items_, exits_, std::vector<SlotAccess>(items_.size()), at_return_);
        places_.clear();
        uses_.clear();
        for (std::size_t i = 0; i < items_.size(); ++i) {
            if (is_label(items_[i])) places_[items_[i].operand.id] = i;
            for (const uint32_t label : exits_[i].labels) ++uses_[label];
        }
    }

    // Where the branch goes; nobody else comes there.
    [[nodiscard]] std::optional<Found> find(std::size_t branch) const {
        const uint32_t label = items_[branch].operand.id;
        const std::size_t place = places_.at(label);
        if (uses_.at(label) != 1 || place == 0 || !ends_flow(items_[place - 1])) return {};
        const auto found = loads_from(place + 1);
        if (!found || !may_redirect(branch, *found)) return {};
        if (!may_come_early(*found, branch, branch + 1)) return {};
        return found;
    }

    /// There is no return on K.
    [[nodiscard]] bool may_redirect(std::size_t branch, const Found& found) const {
        const CodeItem& behind = items_[found.end];
        const bool returns = is_instruction(behind) && behind.opcode == op::kRet;
        return !returns || !op::asks_k(items_[branch].opcode);
    }

    // Between the branch and where it goes.
    [[nodiscard]] std::optional<Found> find_passed(std::size_t branch) const {
        const auto found = loads_from(branch + 1);
        if (!found || is_label(items_[found->end])) return {};
        const std::size_t place = places_.at(items_[branch].operand.id);
        if (!may_redirect(branch, *found)) return {};
        const bool over = place == found->end + 1 && may_come_early(*found, branch, place);
        return over ? found : std::nullopt;
    }

    [[nodiscard]] std::optional<Found> loads_from(std::size_t first) const {
        Found found{first, first};
        while (found.end < items_.size() && is_load(items_[found.end])) ++found.end;
        if (found.first == found.end || found.end == items_.size()) return {};
        const CodeItem& behind = items_[found.end];
        const bool jumps = is_instruction(behind) && behind.opcode == op::kJmp &&
                           behind.operand.kind == CodeOperand::Kind::label;
        const bool returns = is_instruction(behind) && behind.opcode == op::kRet;
        if (!jumps && !returns && !is_label(behind)) return {};
        return found;
    }

    /// @param other  where control goes that does not want the loads
    [[nodiscard]] bool may_come_early(const Found& found, std::size_t branch,
                                      std::size_t other) const {
        ResourceSet written = 0;
        uint32_t t_states = 0;
        for (std::size_t i = found.first; i < found.end; ++i) {
            const ResourceSet writes = effects_of(items_[i]).writes;
            if ((writes & kFlags & live_[i].registers) != 0) return false;
            written = static_cast<ResourceSet>(written | (writes & ~kFlags));
            t_states += isa::instruction(items_[i].opcode).t_not_taken;
        }
        if ((written & live_in(other)) != 0 || t_states > kMostT) return false;
        return !is_in_loop(branch) || is_loaded_at_once(other, written, t_states);
    }

    [[nodiscard]] ResourceSet live_in(std::size_t at) const {
        const ResourceSet behind = live_[at].registers;
        if (!is_instruction(items_[at])) return behind;
        const Effects effects = effects_of(items_[at]);
        return static_cast<ResourceSet>((behind & ~effects.writes) | effects.reads);
    }

    [[nodiscard]] bool is_loaded_at_once(std::size_t at, ResourceSet written,
                                         uint32_t t_states) const {
        while (at < items_.size() && is_label(items_[at])) ++at;
        if (at == items_.size()) return false;
        return t_states <= kMostTInLoop && is_load(items_[at]) &&
               (effects_of(items_[at]).writes & written) != 0;
    }

    /// Can an item be reached from itself?
    [[nodiscard]] bool is_in_loop(std::size_t item) const {
        std::vector<bool> seen(items_.size(), false);
        std::vector<std::size_t> open{item};
        const auto reach = [&](std::size_t at) {
            if (at >= items_.size() || seen[at]) return;
            seen[at] = true;
            open.push_back(at);
        };
        while (!open.empty()) {
            const std::size_t at = open.back();
            open.pop_back();
            if (exits_[at].falls) reach(at + 1);
            for (const uint32_t label : exits_[at].labels) reach(places_.at(label));
        }
        return seen[item];
    }

    [[nodiscard]] Items taken_out(const Found& found) const {
        Items loads(items_.begin() + static_cast<std::ptrdiff_t>(found.first),
                    items_.begin() + static_cast<std::ptrdiff_t>(found.end));
        for (CodeItem& load : loads) {
            if (load.opcode != kXraA) continue;
            load.opcode = by_register(op::kMvi, Register::a);
            load.operand = {CodeOperand::Kind::number, CodeOperand::Part::word, 0, 0};
        }
        return loads;
    }

    /// The branch goes where the loads go on to.
    void redirect(CodeItem& branch, const CodeItem& behind) const {
        if (is_instruction(behind) && behind.opcode == op::kRet) {
            branch.opcode &= 0xF8;  // Jcc and Rcc differ in their low bits
            branch.operand = {};
        } else {
            branch.operand.id = behind.operand.id;
        }
    }

    void erase(std::size_t first, std::size_t end) {
        items_.erase(items_.begin() + static_cast<std::ptrdiff_t>(first),
                     items_.begin() + static_cast<std::ptrdiff_t>(end));
    }

    // What is left of the way there is reached no more.
    void apply(std::size_t branch, const Found& found) {
        const Items loads = taken_out(found);
        redirect(items_[branch], items_[found.end]);
        erase(found.first - 1, found.end);
        const std::size_t at = found.first < branch ? branch - loads.size() - 1 : branch;
        items_.insert(items_.begin() + static_cast<std::ptrdiff_t>(at), loads.begin(), loads.end());
    }

    void apply_passed(std::size_t branch, const Found& found) {
        const Items loads = taken_out(found);
        items_[branch].opcode = op::inverted(items_[branch].opcode);
        redirect(items_[branch], items_[found.end]);
        erase(found.first, found.end + 1);
        items_.insert(items_.begin() + static_cast<std::ptrdiff_t>(branch), loads.begin(),
                      loads.end());
    }

    Items& items_;
    ResourceSet at_return_;
    std::vector<Exits> exits_{};
    std::vector<Live> live_{};
    std::map<uint32_t, std::size_t> places_{};
    std::map<uint32_t, uint32_t> uses_{};
};

}  // namespace

void load_early(std::vector<CodeItem>& items, RegisterSet at_return) {
    if (!can_be_followed(items)) return;
    EarlyLoads pass(items, at_return);
    while (pass.run_once()) {
    }
}

}  // namespace toolchain::codegen
