// loops.cpp - see loops.hpp. Strongly connected components, and again in each without its header.
#include "tools/bounds/loops.hpp"

#include <algorithm>
#include <set>

#include "tools/budget/budget_error.hpp"

namespace rover_bounds {
namespace {

using Blocks = std::set<std::size_t>;

/// Blocks that can be reached from `start` within `inside`, forward or backward; `start` only if
/// a way leads back to it.
Blocks reachable(const Procedure& procedure, std::size_t start, const Blocks& inside,
                 bool forward) {
    Blocks found;
    std::vector<std::size_t> open = {start};
    while (!open.empty()) {
        const std::size_t block = open.back();
        open.pop_back();
        for (const Edge& edge : procedure.edges) {
            if (!edge.to || (forward ? edge.from : *edge.to) != block) continue;
            const std::size_t next = forward ? *edge.to : edge.from;
            if (inside.contains(next) && found.insert(next).second) open.push_back(next);
        }
    }
    return found;
}

class LoopFinder {
public:
    LoopFinder(const Procedure& procedure, const host_sim::Symbols& symbols)
        : procedure_(procedure), symbols_(symbols) {}

    std::vector<Loop> run() {
        Blocks all;
        for (std::size_t i = 0; i < procedure_.blocks.size(); ++i) all.insert(i);
        split(all);
        std::ranges::stable_sort(loops_, {}, &Loop::address);
        return std::move(loops_);
    }

private:
    void split(Blocks blocks) {
        while (!blocks.empty()) {
            const std::size_t first = *blocks.begin();
            const Blocks behind = reachable(procedure_, first, blocks, true);
            const Blocks before = reachable(procedure_, first, blocks, false);
            Blocks loop;
            std::ranges::set_intersection(behind, before, std::inserter(loop, loop.end()));
            blocks.erase(first);
            if (loop.empty()) continue;
            for (const std::size_t block : loop) blocks.erase(block);
            take(loop);
        }
    }

    void take(Blocks blocks) {
        Loop loop;
        std::set<std::size_t> heads;
        if (blocks.contains(0)) heads.insert(0);
        for (const Edge& edge : procedure_.edges) {
            if (edge.to && blocks.contains(*edge.to) && !blocks.contains(edge.from)) {
                heads.insert(*edge.to);
            }
        }
        loop.header = *heads.begin();
        loop.address = procedure_.blocks[loop.header].first;
        if (heads.size() != 1) {
            throw rover_budget::BudgetError(
                source_place(symbols_, loop.address), 0,
                "the loop in " + procedure_.name + " is entered at more than one place",
                "write it as for, while or do");
        }
        loop.blocks.assign(blocks.begin(), blocks.end());
        loop.entered_with_procedure = loop.header == 0;
        for (std::size_t i = 0; i < procedure_.edges.size(); ++i) {
            const Edge& edge = procedure_.edges[i];
            if (edge.to != loop.header) continue;
            (blocks.contains(edge.from) ? loop.turns : loop.entries).push_back(i);
        }
        blocks.erase(loop.header);
        loops_.push_back(std::move(loop));
        split(std::move(blocks));
    }

    const Procedure& procedure_;
    const host_sim::Symbols& symbols_;
    std::vector<Loop> loops_;
};

}  // namespace

std::vector<Loop> find_loops(const Procedure& procedure, const host_sim::Symbols& symbols) {
    return LoopFinder(procedure, symbols).run();
}

}  // namespace rover_bounds
