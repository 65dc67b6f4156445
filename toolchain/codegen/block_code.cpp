// block_code.cpp - see block_code.hpp.
#include "toolchain/codegen/block_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <numeric>
#include <set>
#include <stdexcept>

namespace toolchain::codegen {

namespace {

/// The code of one state, as a chain back to the block's start.
struct Link {
    const Link* before = nullptr;
    std::vector<CodeItem> items{};
};

struct Candidate {
    Coder coder;
    const Link* code = nullptr;
    double score = 0;
};

class BlockMaker {
public:
    BlockMaker(const FunctionFacts& facts, const BlockSetting& setting)
        : facts_(facts),
          setting_(setting),
          block_(facts.function.blocks[setting.block]),
          block_facts_(facts.blocks[setting.block]) {
        make_wishes();
    }

    BlockCode run() {
        std::vector<Candidate> beam{{enter(), nullptr, 0}};
        for (uint32_t position = 0; position < block_.operations.size(); ++position) {
            beam = step(beam, position);
        }
        return finish(beam);
    }

private:
    Coder enter() {
        Coder coder(facts_, block_facts_, wishes_, setting_.byte_cost);
        coder.only_cost = setting_.only_cost;
        coder.state.in_slot = Bits(block_facts_.relevant.size());
        for (const ByteId byte : block_facts_.live_in) {
            if (setting_.entry->in_slot(byte))
                coder.state.in_slot.set(block_facts_.local.find(byte));
        }
        for (const Register which : kRegisters) {
            coder.set(which, setting_.entry->registers[static_cast<unsigned>(which)]);
        }
        return coder;
    }

    // Where successors want values, the likelier ones first.
    void make_wishes() {
        constexpr double kMostly = 0.5;
        wishes_.slot.assign(block_facts_.relevant.size(), 0);
        wishes_.registers.assign(block_facts_.relevant.size(), 0);
        std::vector<double> weight(block_facts_.relevant.size(), 0);
        const std::vector<Edge>& edges = block_.terminator.edges;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const Contract& target = (*setting_.contracts)[edges[i].target];
            for (const ByteId byte : facts_.blocks[edges[i].target].live_in) {
                const ByteId source = passed_for(facts_.function, edges[i], byte);
                const uint32_t at = block_facts_.local.find(source);
                if (at == kNone) continue;
                if (target.in_slot(byte) && facts_.same_place(byte, source)) {
                    weight[at] += block_facts_.edge_probability[i];
                }
                for (const Register which : kRegisters) {
                    if (target.registers[static_cast<unsigned>(which)] == byte) {
                        wishes_.registers[at] |= set_of(which);
                    }
                }
            }
        }
        for (std::size_t i = 0; i < weight.size(); ++i) {
            wishes_.slot[i] = weight[i] >= kMostly ? 1 : 0;
        }
    }

    // What a state is worth beyond its cost: values at hand that are needed soon. A second copy is
    // worth nothing more, or every load would be followed by a move.
    [[nodiscard]] double promise(const Coder& coder) const {
        double sum = 0;
        std::array<ByteId, kRegisters.size()> seen{};
        std::size_t seen_count = 0;
        for (const Register which : kRegisters) {
            const ByteId byte = coder.content(which);
            if (byte == kNone) continue;
            const auto seen_end = seen.begin() + static_cast<std::ptrdiff_t>(seen_count);
            const bool again = std::find(seen.begin(), seen_end, byte) != seen_end;
            if (!again) seen[seen_count++] = byte;
            const bool computed = facts_.computed(byte);
            if (!computed) {
                sum += 0.5;
                continue;
            }
            const uint32_t use = coder.next_use(byte);
            if (use == kNone || use < coder.position) continue;
            const double distance = use - coder.position;
            if (!again) sum += (coder.in_slot(byte) ? 6.0 : 12.0) / (1.5 + 0.25 * distance);
            if ((wishes_.registers[block_facts_.local.find(byte)] & set_of(which)) != 0) sum += 4;
        }
        if (coder.state.carry_of != kNone) sum += 8;
        return sum;
    }

    std::vector<Candidate> step(const std::vector<Candidate>& beam, uint32_t position) {
        const Operation& operation = block_.operations[position];
        std::vector<Candidate> next;
        for (const Candidate& candidate : beam) {
            Coder start = candidate.coder;
            start.position = position;
            for (Coder& way : translate(start, operation, setting_.recipes)) {
                way.store_wanted(operation.results);
                if (way.failed) continue;
                if (!way.complete()) {
                    continue;
                }
                for (CodeItem& item : way.items) place(item, operation.place);
                if (!setting_.only_cost) {
                    links_.push_back({candidate.code, std::move(way.items)});
                    way.items.clear();
                }
                way.position = position + 1;
                drop_dead(way);
                const double score = way.cost - promise(way);
                next.push_back(
                    {std::move(way), setting_.only_cost ? nullptr : &links_.back(), score});
            }
        }
        if (next.empty()) {
            throw NoWay(fmt::format("block {}, operation {} ({}): no way to translate it",
                                    setting_.block, position, static_cast<int>(operation.opcode)));
        }
        return keep_best(std::move(next));
    }

    static void place(CodeItem& item, const SourcePlace& place) {
        item.file = place.file;
        item.line = place.line;
    }

    // What nobody reads any more must not make two states look different.
    void drop_dead(Coder& coder) const {
        uint32_t& carry = coder.state.carry_of;
        if (carry != kNone && block_facts_.carry_until[carry] < coder.position) carry = kNone;
        for (const Register which : kRegisters) {
            const ByteId byte = coder.content(which);
            if (byte != kNone && facts_.computed(byte) && !coder.needed(byte, false) &&
                !is_base(coder, byte)) {
                const Base sum = which == Register::a
                                     ? Base{}
                                     : coder.state.sum[static_cast<unsigned>(which) / 2];
                coder.set(which, kNone);
                if (which != Register::a) {
                    coder.state.sum[static_cast<unsigned>(which) / 2] = sum;
                }
            }
        }
    }

    // A dead address in a pair may still be near a later one.
    [[nodiscard]] bool is_base(const Coder& coder, ByteId byte) const {
        for (const Pair pair : kPairs) {
            const ByteId low = coder.content(low_of(pair));
            const ByteId high = coder.content(high_of(pair));
            if (low == kNone || high == kNone) continue;
            if ((low == byte || high == byte) && bases_.contains(key(low, high))) return true;
        }
        return false;
    }

    [[nodiscard]] uint64_t key(ByteId low, ByteId high) const {
        const Base base = facts_.base_of(low, high);
        return uint64_t{base.low} << 32 | base.high;
    }

    std::vector<Candidate> keep_best(std::vector<Candidate> all) {
        std::vector<uint32_t> order(all.size());
        std::iota(order.begin(), order.end(), 0U);
        std::stable_sort(order.begin(), order.end(),
                         [&](uint32_t a, uint32_t b) { return all[a].score < all[b].score; });
        std::vector<Candidate> best;
        for (const uint32_t index : order) {
            const bool seen = std::any_of(best.begin(), best.end(), [&](const Candidate& other) {
                return other.coder.state == all[index].coder.state;
            });
            if (seen) continue;
            best.push_back(std::move(all[index]));
            if (best.size() == setting_.beam) break;
        }
        return best;
    }

    // -- The end of the block --------------------------------------------------------------------

    struct EdgeCode {
        std::vector<CodeItem> items{};
        bool empty = true;
        double cost = 0;
    };

    EdgeCode edge_code(const Coder& end, std::size_t which) {
        Coder coder = end;
        coder.items.clear();
        const double before = coder.cost;
        const uint32_t emitted = coder.emitted;
        const Edge& edge = block_.terminator.edges[which];
        coder.position = block_facts_.end;
        cross(coder, edge, (*setting_.contracts)[edge.target]);
        if (coder.failed) throw NoWay("an edge that cannot be crossed");
        return {std::move(coder.items), coder.emitted == emitted, coder.cost - before};
    }

    [[nodiscard]] uint32_t label_of(BlockId block) const {
        return setting_.first_block_label + block;
    }

    static CodeItem jump_item(uint8_t opcode, uint32_t label) {
        CodeItem item;
        item.opcode = opcode;
        item.operand = {CodeOperand::Kind::label, CodeOperand::Part::word, label, 0};
        return item;
    }

    static CodeItem label_item(uint32_t label) {
        CodeItem item = jump_item(0, label);
        item.kind = CodeItem::Kind::label;
        return item;
    }

    /// T-states and bytes of a jump.
    [[nodiscard]] double jump_cost() const { return 10 + 3 * setting_.byte_cost; }

    BlockCode finish(std::vector<Candidate>& beam) {
        switch (block_.terminator.kind) {
            case Terminator::Kind::jump:
                for (const Candidate& candidate : beam) finish_jump(candidate);
                break;
            case Terminator::Kind::branch:
                for (const Candidate& candidate : beam) finish_branch(candidate);
                break;
            case Terminator::Kind::table:
                for (const Candidate& candidate : beam) finish_table(candidate);
                break;
            case Terminator::Kind::give_back:
                for (const Candidate& candidate : beam) finish_return(candidate);
                break;
            case Terminator::Kind::unreachable:
                offer(beam.front(), {}, {}, beam.front().coder.cost);
                break;
        }
        if (!found_) throw NoWay(fmt::format("block {}: no end", setting_.block));
        for (CodeItem& item : best_.items) {
            if (item.file == UINT32_MAX && item.line == 0) place(item, block_.terminator.place);
        }
        return std::move(best_);
    }

    void offer(const Candidate& candidate, std::vector<CodeItem> tail, std::vector<CodeItem> cold,
               double cost) {
        if (found_ && cost >= best_.cost) return;
        found_ = true;
        best_.cost = cost;
        if (setting_.only_cost) return;
        std::vector<const Link*> links;
        for (const Link* link = candidate.code; link != nullptr; link = link->before) {
            links.push_back(link);
        }
        best_.items.clear();
        for (auto link = links.rbegin(); link != links.rend(); ++link) {
            best_.items.insert(best_.items.end(), (*link)->items.begin(), (*link)->items.end());
        }
        for (CodeItem& item : tail) place(item, block_.terminator.place);
        for (CodeItem& item : cold) place(item, block_.terminator.place);
        best_.items.insert(best_.items.end(), tail.begin(), tail.end());
        best_.cold = std::move(cold);
    }

    void append_jump(std::vector<CodeItem>& items, double& cost, BlockId target, double weight) {
        if (target == setting_.next) return;
        items.push_back(jump_item(op::kJmp, label_of(target)));
        cost += weight * 10 + 3 * setting_.byte_cost;
    }

    void finish_jump(const Candidate& candidate) {
        EdgeCode code = edge_code(candidate.coder, 0);
        double cost = candidate.coder.cost + code.cost;
        append_jump(code.items, cost, block_.terminator.edges[0].target, 1);
        offer(candidate, std::move(code.items), {}, cost);
    }

    void finish_branch(const Candidate& candidate) {
        const Terminator& end = block_.terminator;
        const Targets targets{setting_.recipes.label(), setting_.recipes.label()};
        Coder start = candidate.coder;
        start.position = static_cast<uint32_t>(block_.operations.size());
        for (const Decision& decision :
             decide(start, end.predicate, end.left, end.right, targets)) {
            if (!decision.coder.complete()) {
                continue;
            }
            arrange(candidate, decision, targets);
        }
    }

    // Which edge falls through, and which is jumped to.
    void arrange(const Candidate& candidate, const Decision& decision, const Targets& targets) {
        const std::array<EdgeCode, 2> edges{edge_code(decision.coder, 0),
                                            edge_code(decision.coder, 1)};
        for (const std::size_t inside : {std::size_t{0}, std::size_t{1}}) {
            part(candidate, decision, targets, edges, inside);
        }
    }

    void part(const Candidate& candidate, const Decision& decision, const Targets& targets,
              const std::array<EdgeCode, 2>& edges, std::size_t inside) {
        const std::array<uint32_t, 2> labels{targets.label_true, targets.label_false};
        const std::size_t outside = 1 - inside;
        const double leaving = block_facts_.edge_probability[outside];
        std::vector<CodeItem> items = decision.coder.items;
        double cost = decision.coder.cost;
        const Condition condition = outside == 0 ? decision.condition : inverse(decision.condition);
        items.push_back(jump_item(jump_if(condition), labels[outside]));
        cost += 7 + 3 * leaving + 3 * setting_.byte_cost;
        items.push_back(label_item(labels[inside]));
        items.insert(items.end(), edges[inside].items.begin(), edges[inside].items.end());
        // Edge costs hold both T-states and bytes; bytes are there whether it is taken or not,
        // but a rarely taken edge is cheap all the same.
        cost += edges[inside].cost * (1 - leaving) + edges[outside].cost * leaving;
        append_jump(items, cost, block_.terminator.edges[inside].target, 1 - leaving);
        std::vector<CodeItem> cold;
        cold.push_back(label_item(labels[outside]));
        cold.insert(cold.end(), edges[outside].items.begin(), edges[outside].items.end());
        cold.push_back(jump_item(op::kJmp, label_of(block_.terminator.edges[outside].target)));
        if (!edges[outside].empty) cost += leaving * 10 + 3 * setting_.byte_cost;
        offer(candidate, std::move(items), std::move(cold), cost);
    }

    void finish_table(const Candidate& candidate) {
        Coder coder = candidate.coder;
        coder.position = static_cast<uint32_t>(block_.operations.size());
        coder.items.clear();
        const ByteId index = block_.terminator.left[0];
        coder.load(Register::a, index);
        coder.vacate(Register::a, true);
        coder.lock(Register::a);
        coder.vacate(Pair::hl, true);
        if (coder.failed || !coder.holds(Register::a, index)) return;
        const uint32_t table = setting_.recipes.label();
        CodeOperand operand{CodeOperand::Kind::label, CodeOperand::Part::word, table, 0};
        coder.emit(by_pair(op::kLxi, Pair::hl), operand);
        coder.emit(op::kJmp,
                   {CodeOperand::Kind::symbol, CodeOperand::Part::word, setting_.jump_index, 0});
        const auto used = static_cast<RegisterSet>(set_of(Register::a) | set_of(Pair::hl));
        coder.forget(used);
        coder.release();
        std::vector<CodeItem> items = coder.items;
        if (!items.empty()) {
            items.back().reads = used;
            items.back().writes = static_cast<RegisterSet>(used | set_of(Register::flags));
        }
        std::vector<CodeItem> cold;
        double cost = coder.cost + 80;  // of __jumpindex
        items.push_back(label_item(table));
        for (std::size_t i = 0; i < block_.terminator.edges.size(); ++i) {
            EdgeCode code = edge_code(coder, i);
            const BlockId target = block_.terminator.edges[i].target;
            uint32_t label = label_of(target);
            if (!code.empty) {
                label = setting_.recipes.label();
                cold.push_back(label_item(label));
                cold.insert(cold.end(), code.items.begin(), code.items.end());
                cold.push_back(jump_item(op::kJmp, label_of(target)));
                cost += code.cost * block_facts_.edge_probability[i];
            }
            CodeItem word = jump_item(0, label);
            word.kind = CodeItem::Kind::word;
            items.push_back(word);
            cost += 2 * setting_.byte_cost;
        }
        offer(candidate, std::move(items), std::move(cold), cost);
    }

    void finish_return(const Candidate& candidate) {
        Coder coder = candidate.coder;
        coder.items.clear();
        coder.position = static_cast<uint32_t>(block_.operations.size());
        Wanted wanted;
        wanted.fill(kNone);
        const Bytes& value = block_.terminator.left;
        const std::vector<Register>& registers = facts_.function.result_registers;
        for (std::size_t i = 0; i < registers.size() && i < value.size(); ++i) {
            if (!facts_.undefined(value[i])) {
                wanted[static_cast<unsigned>(registers[i])] = value[i];
            }
        }
        if (!bring(coder, wanted)) return;
        coder.emit(op::kRet);
        offer(candidate, coder.items, {}, coder.cost);
    }

public:
    void find_bases() {
        for (const Operation& operation : block_.operations) {
            if (operation.opcode == Opcode::add && operation.results.size() == 2 &&
                facts_.sum_of[operation.results[0]].known()) {
                bases_.insert(key(operation.results[0], operation.results[1]));
            }
        }
    }

private:
    const FunctionFacts& facts_;
    const BlockSetting& setting_;
    const Block& block_;
    const BlockFacts& block_facts_;
    Wishes wishes_;
    std::deque<Link> links_;
    std::set<uint64_t> bases_;
    BlockCode best_;
    bool found_ = false;
};

}  // namespace

BlockCode make_block(const FunctionFacts& facts, const BlockSetting& setting) {
    BlockMaker maker(facts, setting);
    maker.find_bases();
    return maker.run();
}

}  // namespace toolchain::codegen
