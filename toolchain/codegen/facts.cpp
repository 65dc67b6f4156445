// facts.cpp - liveness, variables and their coalescing; see facts.hpp.
#include "toolchain/codegen/facts.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace toolchain::codegen {

namespace {

class Finder {
public:
    Finder(Function function, const Steps& steps) {
        facts_.function = std::move(function);
        facts_.steps = steps;
        simplify(facts_.function, steps);
    }

    FunctionFacts run() {
        find_liveness();
        make_variables();
        find_interference();
        coalesce();
        for (uint32_t index = 0; index < blocks().size(); ++index) find_uses(index);
        find_carries();
        find_probabilities();
        find_sums();
        return std::move(facts_);
    }

private:
    [[nodiscard]] std::vector<Block>& blocks() { return facts_.function.blocks; }

    template <typename Action>
    static void for_each_use(const Operation& operation, Action action) {
        for (const ByteId byte : operation.left) action(byte);
        for (const ByteId byte : operation.right) action(byte);
        for (const Bytes& argument : operation.arguments) {
            for (const ByteId byte : argument) action(byte);
        }
    }

    // Bytes that are needed at a block's end, successors' parameters translated.
    void add_live_out(const Block& block, std::set<ByteId>& live) {
        for (const Edge& edge : block.terminator.edges) {
            for (const ByteId wanted : live_[edge.target]) {
                const ByteId byte = passed_for(facts_.function, edge, wanted);
                if (facts_.computed(byte)) live.insert(byte);
            }
        }
    }

    void find_liveness() {
        live_.resize(blocks().size());
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t index = blocks().size(); index-- > 0;) {
                const Block& block = blocks()[index];
                std::set<ByteId> live;
                add_live_out(block, live);
                const auto use = [&](ByteId byte) {
                    if (facts_.computed(byte)) live.insert(byte);
                };
                for (const ByteId byte : block.terminator.left) use(byte);
                for (const ByteId byte : block.terminator.right) use(byte);
                for (auto at = block.operations.rbegin(); at != block.operations.rend(); ++at) {
                    for (const ByteId byte : at->results) live.erase(byte);
                    for_each_use(*at, use);
                }
                if (live.size() != live_[index].size()) {
                    live_[index] = std::move(live);
                    changed = true;
                }
            }
        }
        facts_.blocks.resize(blocks().size());
        for (std::size_t index = 0; index < blocks().size(); ++index) {
            facts_.blocks[index].live_in.assign(live_[index].begin(), live_[index].end());
        }
    }

    void make_variable(std::span<const ByteId> bytes) {
        if (bytes.empty()) return;
        const auto id = static_cast<uint32_t>(facts_.variable_size.size());
        facts_.variable_size.push_back(static_cast<uint32_t>(bytes.size()));
        for (uint32_t i = 0; i < bytes.size(); ++i) {
            facts_.variable[bytes[i]] = id;
            facts_.index[bytes[i]] = i;
        }
    }

    // One for the results of each operation and for each parameter.
    void make_variables() {
        facts_.variable.assign(facts_.function.bytes.size(), kNone);
        facts_.index.assign(facts_.function.bytes.size(), 0);
        for (std::size_t index = 0; index < blocks().size(); ++index) {
            const Block& block = blocks()[index];
            const std::span<const ByteId> parameters(block.parameters);
            std::size_t next = 0;
            if (index == 0) {
                for (const Bytes& parameter : facts_.function.parameters) make_variable(parameter);
                next = parameters.size();
                for (const ByteId byte : parameters) {
                    if (facts_.variable[byte] == kNone) make_variable({&byte, 1});
                }
            }
            for (const uint32_t size : block.parameter_sizes) {
                if (next + size > parameters.size()) break;
                make_variable(parameters.subspan(next, size));
                next += size;
            }
            for (; next < parameters.size(); ++next) make_variable(parameters.subspan(next, 1));
            for (const Operation& operation : block.operations) make_variable(operation.results);
        }
    }

    void interfere(ByteId defined, const std::set<ByteId>& live) {
        const uint32_t first = facts_.variable[defined];
        for (const ByteId other : live) {
            const uint32_t second = facts_.variable[other];
            if (first == second) continue;
            pairs_.insert({std::min(first, second), std::max(first, second)});
        }
    }

    // Two variables interfere where one is defined while the other is live. On an edge a parameter
    // is written while the arguments of the others are still to be read.
    void find_interference() {
        for (std::size_t index = 0; index < blocks().size(); ++index) {
            const Block& block = blocks()[index];
            std::set<ByteId> live;
            add_live_out(block, live);
            for (const ByteId byte : block.terminator.left) use(live, byte);
            for (const ByteId byte : block.terminator.right) use(live, byte);
            for (auto at = block.operations.rbegin(); at != block.operations.rend(); ++at) {
                for (const ByteId byte : at->results) interfere(byte, live);
                for (const ByteId byte : at->results) live.erase(byte);
                for_each_use(*at, [&](ByteId byte) { use(live, byte); });
                // A routine may write its first result before it reads its last operand.
                if (at->results.size() > 1) {
                    for (const ByteId byte : at->results) {
                        std::set<ByteId> operands;
                        for_each_use(*at, [&](ByteId operand) { use(operands, operand); });
                        for (const ByteId operand : operands) {
                            const uint32_t first = facts_.variable[byte];
                            const uint32_t second = facts_.variable[operand];
                            if (first != second) {
                                soft_pairs_.insert(
                                    {std::min(first, second), std::max(first, second)});
                            }
                        }
                    }
                }
            }
            for (const ByteId byte : block.parameters) interfere(byte, live);
        }
    }

    void use(std::set<ByteId>& live, ByteId byte) const {
        if (facts_.computed(byte)) live.insert(byte);
    }

    [[nodiscard]] uint32_t root(uint32_t variable) {
        while (parent_[variable] != variable) {
            variable = parent_[variable] = parent_[parent_[variable]];
        }
        return variable;
    }

    [[nodiscard]] bool interfering(uint32_t first, uint32_t second) const {
        for (const uint32_t one : members_[first]) {
            for (const uint32_t other : members_[second]) {
                if (pairs_.contains({std::min(one, other), std::max(one, other)})) return true;
            }
        }
        return false;
    }

    void try_merge(ByteId parameter, ByteId argument) {
        if (!facts_.computed(argument)) return;
        const uint32_t first = root(facts_.variable[parameter]);
        const uint32_t second = root(facts_.variable[argument]);
        if (first == second || facts_.index[parameter] != facts_.index[argument] ||
            facts_.variable_size[first] != facts_.variable_size[second] ||
            interfering(first, second)) {
            return;
        }
        parent_[second] = first;
        members_[first].insert(members_[first].end(), members_[second].begin(),
                               members_[second].end());
        members_[second].clear();
    }

    // A parameter and what edges hand over share their memory where they can: the most frequent
    // edges first, since what is shared needs no copying.
    void coalesce() {
        const std::size_t count = facts_.variable_size.size();
        parent_.resize(count);
        std::iota(parent_.begin(), parent_.end(), 0U);
        members_.resize(count);
        for (uint32_t variable = 0; variable < count; ++variable) members_[variable] = {variable};
        std::vector<std::pair<double, const Edge*>> edges;
        for (const Block& block : blocks()) {
            for (const Edge& edge : block.terminator.edges) {
                edges.emplace_back(block.frequency, &edge);
            }
        }
        std::stable_sort(edges.begin(), edges.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        for (const auto& [frequency, edge] : edges) {
            const Bytes& parameters = blocks()[edge->target].parameters;
            for (std::size_t i = 0; i < parameters.size(); ++i) {
                try_merge(parameters[i], edge->arguments[i]);
            }
        }
        for (uint32_t& variable : facts_.variable) {
            if (variable != kNone) variable = root(variable);
        }
        facts_.interferes.resize(count);
        const auto keep = [&](const std::set<std::pair<uint32_t, uint32_t>>& pairs) {
            for (const auto& [one, other] : pairs) {
                const uint32_t first = root(one);
                const uint32_t second = root(other);
                if (first == second) continue;
                facts_.interferes[first].push_back(second);
                facts_.interferes[second].push_back(first);
            }
        };
        keep(pairs_);
        keep(soft_pairs_);
        add_edge_interference();
    }

    void add_edge_interference() {
        for (const Block& block : blocks()) {
            for (const Edge& edge : block.terminator.edges) {
                for (const ByteId parameter : blocks()[edge.target].parameters) {
                    for (const ByteId argument : edge.arguments) {
                        if (!facts_.computed(argument)) continue;
                        const uint32_t first = facts_.variable[parameter];
                        const uint32_t second = facts_.variable[argument];
                        if (first == second) continue;
                        facts_.interferes[first].push_back(second);
                        facts_.interferes[second].push_back(first);
                    }
                }
            }
        }
    }

    void find_uses(uint32_t index) {
        const Block& block = blocks()[index];
        BlockFacts& facts = facts_.blocks[index];
        const auto count = static_cast<uint32_t>(block.operations.size());
        facts.end = count + 1;
        const auto number = [&](ByteId byte) {
            const uint32_t at = facts.local.add(byte);
            if (at == facts.relevant.size()) {
                facts.relevant.push_back(byte);
                facts.uses.emplace_back();
                facts.made.push_back(0);
            }
            return at;
        };
        const auto use_at = [&](ByteId byte, uint32_t position) {
            if (!facts_.computed(byte)) return;
            std::vector<uint32_t>& uses = facts.uses[number(byte)];
            if (uses.empty() || uses.back() != position) uses.push_back(position);
        };
        for (const ByteId byte : facts.live_in) (void)number(byte);
        for (const ByteId byte : block.parameters) (void)number(byte);
        for (uint32_t position = 0; position < count; ++position) {
            for_each_use(block.operations[position], [&](ByteId byte) { use_at(byte, position); });
            for (const ByteId byte : block.operations[position].results) {
                facts.made[number(byte)] = position + 1;
            }
        }
        for (const ByteId byte : block.terminator.left) use_at(byte, count);
        for (const ByteId byte : block.terminator.right) use_at(byte, count);
        for (const Edge& edge : block.terminator.edges) {
            for (const ByteId wanted : facts_.blocks[edge.target].live_in) {
                use_at(passed_for(facts_.function, edge, wanted), facts.end);
            }
            std::vector<uint32_t>& from = facts_.blocks[edge.target].predecessors;
            if (std::find(from.begin(), from.end(), index) == from.end()) from.push_back(index);
        }
        std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> places;
        for (uint32_t i = 0; i < facts.relevant.size(); ++i) {
            const ByteId byte = facts.relevant[i];
            places[{facts_.variable[byte], facts_.index[byte]}].push_back(i);
        }
        for (const ByteId byte : facts.relevant) {
            facts.same_place.push_back(places[{facts_.variable[byte], facts_.index[byte]}]);
        }
        for (const std::vector<uint32_t>& uses : facts.uses) {
            facts.last_use.push_back(uses.empty() ? kNone : uses.back());
        }
    }

    void find_carries() {
        for (std::size_t index = 0; index < blocks().size(); ++index) {
            BlockFacts& facts = facts_.blocks[index];
            const std::size_t positions = blocks()[index].operations.size() + 1;
            facts.carry_answers.resize(positions);
            facts.carry_until.resize(positions, 0);
            if (!facts_.steps.contains(Step::carry_answers)) continue;
            facts.carry_answers = find_carry_answers(facts_.function, blocks()[index]);
            for (uint32_t at = 0; at < facts.carry_answers.size(); ++at) {
                const uint32_t from = facts.carry_answers[at].from;
                if (from != kNone) facts.carry_until[from] = at;
            }
        }
    }

    void find_probabilities() {
        for (std::size_t index = 0; index < blocks().size(); ++index) {
            const Terminator& end = blocks()[index].terminator;
            std::vector<double>& result = facts_.blocks[index].edge_probability;
            result.assign(end.edges.size(),
                          end.edges.empty() ? 1 : 1.0 / static_cast<double>(end.edges.size()));
            if (end.kind != Terminator::Kind::branch) continue;
            if (end.edges[0].probability >= 0) {
                result = {end.edges[0].probability, end.edges[1].probability};
                continue;
            }
            if (end.edges[0].target == end.edges[1].target) continue;
            const double own = std::max(blocks()[index].frequency, 1e-9);
            for (std::size_t i = 0; i < 2; ++i) {
                const BlockId target = end.edges[i].target;
                if (facts_.blocks[target].predecessors.size() != 1) continue;
                result[i] = std::clamp(blocks()[target].frequency / own, 0.001, 0.999);
                result[1 - i] = 1 - result[i];
                break;
            }
        }
    }

    void find_sums() {
        facts_.sum_of.resize(facts_.function.bytes.size());
        facts_.sum_high.assign(facts_.function.bytes.size(), kNone);
        for (const Block& block : blocks()) {
            for (const Operation& operation : block.operations) {
                if (operation.opcode != Opcode::add || operation.results.size() != 2) continue;
                const ByteId low = operation.right[0];
                const ByteId high = operation.right[1];
                if (!facts_.constant(low) || !facts_.constant(high)) continue;
                const auto number = static_cast<int16_t>(facts_.function.bytes[low].constant |
                                                         facts_.function.bytes[high].constant << 8);
                Base base = facts_.base_of(operation.left[0], operation.left[1]);
                base.delta += number;
                facts_.sum_of[operation.results[0]] = base;
                facts_.sum_high[operation.results[0]] = operation.results[1];
            }
        }
    }

    FunctionFacts facts_;
    std::vector<std::set<ByteId>> live_;
    std::set<std::pair<uint32_t, uint32_t>> pairs_;
    std::set<std::pair<uint32_t, uint32_t>> soft_pairs_;
    std::vector<uint32_t> parent_;
    std::vector<std::vector<uint32_t>> members_;
};

}  // namespace

uint32_t LocalNumbers::add(ByteId byte) {
    const uint32_t known = find(byte);
    if (known != kNone) return known;
    if (2 * (count_ + 1) > table_.size()) {
        const std::vector<Entry> old = std::exchange(table_, std::vector<Entry>(2 * table_.size()));
        mask_ = table_.size() - 1;
        for (const Entry& entry : old) {
            if (entry.byte != kNone) put(entry);
        }
    }
    put({byte, count_});
    return count_++;
}

void LocalNumbers::put(const Entry& entry) {
    std::size_t at = entry.byte & mask_;
    while (table_[at].byte != kNone) at = (at + 1) & mask_;
    table_[at] = entry;
}

ByteId passed_for(const Function& function, const Edge& edge, ByteId wanted) {
    const Bytes& parameters = function.blocks[edge.target].parameters;
    const auto at = std::find(parameters.begin(), parameters.end(), wanted);
    return at == parameters.end()
               ? wanted
               : edge.arguments[static_cast<std::size_t>(at - parameters.begin())];
}

Base FunctionFacts::base_of(ByteId low, ByteId high) const {
    const ByteInfo& first = function.bytes[low];
    const ByteInfo& second = function.bytes[high];
    using Kind = ByteInfo::Kind;
    if (first.kind == Kind::constant && second.kind == Kind::constant) {
        return {0, Base::kNumber, static_cast<int16_t>(first.constant | second.constant << 8)};
    }
    if (first.kind == Kind::address_low && second.kind == Kind::address_high &&
        first.symbol == second.symbol && first.offset == second.offset) {
        return {first.symbol, Base::kSymbol, first.offset};
    }
    if (low < sum_of.size() && sum_of[low].known() && sum_high[low] == high) return sum_of[low];
    return {low, high, 0};
}

FunctionFacts find_facts(Function function, const Steps& steps) {
    return Finder(std::move(function), steps).run();
}

}  // namespace toolchain::codegen
