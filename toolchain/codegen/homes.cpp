// homes.cpp - see homes.hpp.
#include "toolchain/codegen/homes.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>

namespace toolchain::codegen {

namespace {

/// A byte or word that may get a home: a part of a variable.
struct Unit {
    uint32_t variable;
    uint32_t index;
    uint32_t size;  ///< 1 or 2
    double weight;  ///< how often it crosses a block boundary
};

class HomeSearch {
public:
    HomeSearch(const FunctionFacts& facts, const HomesOptions& options)
        : facts_(facts), options_(options), blocks_(facts.function.blocks) {
        place_blocks();
        start_contracts();
        costs_.resize(blocks_.size());
        for (BlockId block = 0; block < blocks_.size(); ++block) remake(block);
    }

    FunctionBlocks run() {
        if (options_.by_chance != 0) choose_by_chance();
        if (options_.search) search();
        FunctionBlocks result;
        for (BlockId block = 0; block < blocks_.size(); ++block) {
            result.cost += cost_of(block);
            result.blocks.push_back(best_effort(setting_of(block)));
        }
        result.order = std::move(order_);
        return result;
    }

private:
    // -- Placement: the likelier successor follows ------------------------------------------------
    void place_blocks() {
        std::vector<bool> placed(blocks_.size(), false);
        for (BlockId first = 0; first < blocks_.size(); ++first) {
            for (BlockId at = first; at != kNone && !placed[at];) {
                placed[at] = true;
                order_.push_back(at);
                at = best_successor(at, placed);
            }
        }
        next_.assign(blocks_.size(), kNone);
        for (std::size_t i = 0; i + 1 < order_.size(); ++i) next_[order_[i]] = order_[i + 1];
    }

    [[nodiscard]] BlockId best_successor(BlockId block, const std::vector<bool>& placed) const {
        BlockId best = kNone;
        double most = -1;
        const std::vector<Edge>& edges = blocks_[block].terminator.edges;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const double probability = facts_.blocks[block].edge_probability[i];
            if (!placed[edges[i].target] && probability > most) {
                most = probability;
                best = edges[i].target;
            }
        }
        for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
            if (edges.size() != 2 || placed[edges[side].target]) continue;
            if (!facts_.steps.contains(Step::detours)) continue;
            if (is_detour(block, side)) best = edges[side].target;
        }
        return best;
    }

    // A block that only this one enters, and that comes back to this one's other successor. Between
    // the two it saves the jump back; apart, the way without it saves 3 T-states.
    [[nodiscard]] bool is_detour(BlockId block, std::size_t side) const {
        const std::vector<Edge>& edges = blocks_[block].terminator.edges;
        const BlockId detour = edges[side].target;
        const Terminator& end = blocks_[detour].terminator;
        const bool comes_back = end.kind == Terminator::Kind::jump &&
                                end.edges[0].target == edges[1 - side].target &&
                                facts_.blocks[detour].predecessors.size() == 1;
        if (!comes_back || detour == edges[1 - side].target) return false;
        const double probability = facts_.blocks[block].edge_probability[side];
        const double bytes = 3 * options_.byte_cost / frequency(block);
        return 3 * (1 - probability) < 13 * probability + bytes;
    }

    // -- Contracts -------------------------------------------------------------------------------
    void start_contracts() {
        contracts_.resize(blocks_.size());
        Contract& entry = contracts_[0];
        const Bytes& parameters = blocks_[0].parameters;
        const std::vector<Register>& registers = facts_.function.parameter_registers;
        for (std::size_t i = 0; i < parameters.size() && i < registers.size(); ++i) {
            const std::vector<ByteId>& live = facts_.blocks[0].live_in;
            if (!std::binary_search(live.begin(), live.end(), parameters[i])) continue;
            entry.registers[static_cast<unsigned>(registers[i])] = parameters[i];
            entry.not_in_slot.push_back(parameters[i]);
        }
        std::sort(entry.not_in_slot.begin(), entry.not_in_slot.end());
    }

    [[nodiscard]] double frequency(BlockId block) const {
        constexpr double kRare = 0.01;
        return std::max(blocks_[block].frequency, kRare);
    }

    [[nodiscard]] double cost_of(BlockId block) const { return costs_[block] * frequency(block); }

    void remake(BlockId block) {
        std::vector<Contract> key{contracts_[block]};
        for (const Edge& edge : blocks_[block].terminator.edges) {
            key.push_back(contracts_[edge.target]);
        }
        auto& memory = memory_[block];
        const auto known = memory.find(key);
        if (known != memory.end()) {
            costs_[block] = known->second;
            return;
        }
        BlockSetting setting = setting_of(block);
        setting.only_cost = true;
        costs_[block] = best_effort(setting).cost;
        spent_ += blocks_[block].operations.size() + 2;
        memory.emplace(std::move(key), costs_[block]);
    }

    // A narrow beam may lose the only states from which an operation can be translated.
    [[nodiscard]] BlockCode best_effort(BlockSetting setting) const {
        try {
            return make_block(facts_, setting);
        } catch (const NoWay&) {
            setting.beam *= kWider;
        }
        try {
            return make_block(facts_, setting);
        } catch (const NoWay&) {
            if (!setting.only_cost) throw;
        }
        BlockCode hopeless;
        hopeless.cost = kHopeless;
        return hopeless;
    }

    [[nodiscard]] BlockSetting setting_of(BlockId block) const {
        BlockSetting setting;
        setting.block = block;
        setting.next = next_[block];
        setting.byte_cost = std::min(options_.byte_cost / frequency(block), kMostForByte);
        setting.beam = kBeam;
        setting.recipes = options_.recipes;
        setting.entry = &contracts_[block];
        setting.contracts = &contracts_;
        setting.jump_index = options_.jump_index;
        return setting;
    }

    // -- The search ------------------------------------------------------------------------------
    void find_units() {
        std::map<std::pair<uint32_t, uint32_t>, double> bytes;
        members_.resize(blocks_.size());
        for (BlockId block = 1; block < blocks_.size(); ++block) {
            for (const ByteId byte : facts_.blocks[block].live_in) {
                const auto place = std::pair{facts_.variable[byte], facts_.index[byte]};
                members_[block][place] = byte;
                bytes[place] += frequency(block);
            }
        }
        for (const auto& [place, weight] : bytes) {
            const auto high = bytes.find({place.first, place.second + 1});
            const bool low_half = place.second % 2 == 0;
            if (low_half && high != bytes.end()) {
                units_.push_back({place.first, place.second, 2, weight + high->second});
            }
            const bool paired =
                low_half ? high != bytes.end() : bytes.contains({place.first, place.second - 1});
            if (!paired) units_.push_back({place.first, place.second, 1, weight});
        }
        std::stable_sort(units_.begin(), units_.end(),
                         [](const Unit& a, const Unit& b) { return a.weight > b.weight; });
    }

    // Sets of blocks in which a unit may have one home: everything; each loop, found as what a
    // frequency and more is contiguous around; each block.
    void find_regions() {
        std::set<std::vector<BlockId>> regions;
        std::vector<BlockId> all;
        for (BlockId block = 1; block < blocks_.size(); ++block) all.push_back(block);
        if (!all.empty()) regions.insert(all);
        for (BlockId block = 1; block < blocks_.size(); ++block) {
            regions.insert({block});
            const std::vector<BlockId> loop = loop_of(block);
            if (!loop.empty()) regions.insert(loop);
        }
        regions_.assign(regions.begin(), regions.end());
        std::stable_sort(regions_.begin(), regions_.end(),
                         [&](const auto& a, const auto& b) { return heat(a) > heat(b); });
    }

    [[nodiscard]] double heat(const std::vector<BlockId>& region) const {
        double most = 0;
        for (const BlockId block : region) most = std::max(most, frequency(block));
        return most * (region.size() > 1 ? 1.5 : 1);
    }

    // The natural loop of a block that one of its descendants in placement jumps back to.
    [[nodiscard]] std::vector<BlockId> loop_of(BlockId header) const {
        std::set<BlockId> body{header};
        std::vector<BlockId> open;
        for (const BlockId from : facts_.blocks[header].predecessors) {
            if (from >= header && body.insert(from).second) open.push_back(from);
            if (from == header) body.insert(from);
        }
        const bool loops = !open.empty() || jumps_to_itself(header);
        if (!loops) return {};
        while (!open.empty()) {
            const BlockId block = open.back();
            open.pop_back();
            for (const BlockId from : facts_.blocks[block].predecessors) {
                if (from > header && body.insert(from).second) open.push_back(from);
            }
        }
        return {body.begin(), body.end()};
    }

    [[nodiscard]] bool jumps_to_itself(BlockId block) const {
        const std::vector<uint32_t>& from = facts_.blocks[block].predecessors;
        return std::find(from.begin(), from.end(), block) != from.end();
    }

    [[nodiscard]] ByteId member(BlockId block, uint32_t variable, uint32_t index) const {
        const auto at = members_[block].find({variable, index});
        return at == members_[block].end() ? kNone : at->second;
    }

    /// Removes a byte from a contract's registers.
    static void take_out(Contract& contract, ByteId byte) {
        for (ByteId& there : contract.registers) {
            if (there == byte) there = kNone;
        }
        std::erase(contract.not_in_slot, byte);
    }

    static void only_in_register(Contract& contract, ByteId byte) {
        const auto at =
            std::lower_bound(contract.not_in_slot.begin(), contract.not_in_slot.end(), byte);
        if (at == contract.not_in_slot.end() || *at != byte) contract.not_in_slot.insert(at, byte);
    }

    /// @param home  register of the low byte; flags: the slot
    bool set_home(BlockId block, const Unit& unit, Register home, bool both) {
        Contract contract = contracts_[block];
        bool lives = false;
        for (uint32_t i = 0; i < unit.size; ++i) {
            const ByteId byte = member(block, unit.variable, unit.index + i);
            if (byte == kNone) continue;
            lives = true;
            take_out(contract, byte);
            if (home == Register::flags) continue;
            const auto number = static_cast<unsigned>(home) - (i == 1 ? 1U : 0U);
            ByteId& there = contract.registers[number];
            if (there != kNone) std::erase(contract.not_in_slot, there);
            there = byte;
            if (!both) only_in_register(contract, byte);
        }
        if (!lives || contract == contracts_[block]) return false;
        contracts_[block] = std::move(contract);
        return true;
    }

    /// Tries homes for units in a region; keeps the change if it pays.
    struct Change {
        const Unit* unit;
        Register home;
        bool both;
    };
    bool try_changes(const std::vector<BlockId>& region, const std::vector<Change>& changes) {
        std::vector<BlockId> changed;
        std::vector<std::pair<BlockId, Contract>> before;
        for (const BlockId block : region) {
            const Contract old = contracts_[block];
            bool any = false;
            for (const Change& change : changes) {
                any = set_home(block, *change.unit, change.home, change.both) || any;
            }
            if (!any || contracts_[block] == old) continue;
            before.emplace_back(block, old);
            changed.push_back(block);
        }
        if (changed.empty()) return false;
        std::set<BlockId> touched(changed.begin(), changed.end());
        for (const BlockId block : changed) {
            for (const BlockId from : facts_.blocks[block].predecessors) touched.insert(from);
        }
        double old_cost = 0;
        double new_cost = 0;
        std::vector<std::pair<BlockId, double>> old_costs;
        bool better = true;
        for (const BlockId block : touched) old_cost += cost_of(block);
        for (const BlockId block : touched) {
            old_costs.emplace_back(block, costs_[block]);
            remake(block);
            new_cost += cost_of(block);
            if (new_cost >= old_cost - kWorthIt) {
                better = false;
                break;
            }
        }
        if (better) return true;
        for (auto& [block, contract] : before) contracts_[block] = std::move(contract);
        for (const auto& [block, cost] : old_costs) costs_[block] = cost;
        return false;
    }

    bool improve_unit(const std::vector<BlockId>& region, const Unit& unit) {
        static constexpr std::array<Register, 3> kLows = {Register::c, Register::e, Register::l};
        bool better = false;
        const bool word = unit.size == 2;
        for (const bool both : {false, true}) {
            if (word) {
                for (const Register home : kLows) {
                    better = try_changes(region, {{&unit, home, both}}) || better;
                }
            } else {
                for (const Register home : kRegisters) {
                    better = try_changes(region, {{&unit, home, both}}) || better;
                }
            }
        }
        return try_changes(region, {{&unit, Register::flags, false}}) || better;
    }

    void choose_by_chance() {
        std::mt19937_64 random(options_.by_chance);
        find_units();
        for (BlockId block = 1; block < blocks_.size(); ++block) {
            for (const Unit& unit : units_) {
                if (random() % 3 == 0) continue;
                Register home = kRegisters[random() % kRegisters.size()];
                if (unit.size == 2) home = low_of(kPairs[random() % kPairs.size()]);
                (void)set_home(block, unit, home, random() % 2 == 0);
            }
        }
        for (BlockId block = 0; block < blocks_.size(); ++block) remake(block);
    }

    void search() {
        if (units_.empty()) find_units();
        find_regions();
        uint64_t size = 0;
        for (const Block& block : blocks_) size += block.operations.size() + 2;
        const uint64_t budget =
            options_.budget != 0 ? options_.budget : std::min<uint64_t>(kMostWork, kRounds * size);
        for (bool again = true; again && spent_ < budget;) {
            again = false;
            for (const std::vector<BlockId>& region : regions_) {
                for (const Unit& unit : units_) {
                    if (spent_ >= budget) break;
                    if (!lives_in(region, unit)) continue;
                    again = improve_unit(region, unit) || again;
                }
            }
        }
    }

    [[nodiscard]] bool lives_in(const std::vector<BlockId>& region, const Unit& unit) const {
        return std::any_of(region.begin(), region.end(), [&](BlockId block) {
            return member(block, unit.variable, unit.index) != kNone ||
                   (unit.size == 2 && member(block, unit.variable, unit.index + 1) != kNone);
        });
    }

    static constexpr double kMostForByte = 30;
    static constexpr unsigned kBeam = 4;
    static constexpr unsigned kWider = 32;
    static constexpr double kHopeless = 1e15;
    static constexpr double kWorthIt = 0.01;
    static constexpr uint64_t kMostWork = 200'000;
    static constexpr uint64_t kRounds = 400;

    const FunctionFacts& facts_;
    const HomesOptions& options_;
    const std::vector<Block>& blocks_;
    std::vector<BlockId> order_;
    std::vector<BlockId> next_;
    std::vector<Contract> contracts_;
    std::vector<double> costs_;  ///< of one execution of each block
    std::map<BlockId, std::map<std::vector<Contract>, double>> memory_;
    std::vector<std::map<std::pair<uint32_t, uint32_t>, ByteId>> members_;
    std::vector<Unit> units_;
    std::vector<std::vector<BlockId>> regions_;
    uint64_t spent_ = 0;
};

}  // namespace

FunctionBlocks make_blocks(const FunctionFacts& facts, const HomesOptions& options) {
    return HomeSearch(facts, options).run();
}

}  // namespace toolchain::codegen
