// call_graph.cpp - see call_graph.hpp.
#include "toolchain/codegen/call_graph.hpp"

#include <algorithm>
#include <set>

#include "toolchain/codegen/abi.hpp"

namespace toolchain::codegen {

namespace {

std::vector<std::size_t> sizes_of(const std::vector<Bytes>& values) {
    std::vector<std::size_t> sizes;
    for (const Bytes& value : values) sizes.push_back(value.size());
    return sizes;
}

/// Symbols whose address is a value in a function; the callee of a direct call is none.
void add_addresses(const Function& function, std::set<SymbolId>& symbols) {
    const auto add = [&](const Bytes& bytes) {
        for (const ByteId byte : bytes) {
            const ByteInfo& info = function.bytes[byte];
            if (info.symbol != kNone) symbols.insert(info.symbol);
        }
    };
    for (const Block& block : function.blocks) {
        for (const Operation& operation : block.operations) {
            add(operation.left);
            add(operation.right);
            for (const Bytes& argument : operation.arguments) add(argument);
        }
        add(block.terminator.left);
        add(block.terminator.right);
        for (const Edge& edge : block.terminator.edges) add(edge.arguments);
    }
}

}  // namespace

void mark_signatures(Module& module) {
    std::set<SymbolId> addresses;
    for (const Function& function : module.functions) add_addresses(function, addresses);
    for (const Variable& variable : module.variables) {
        for (const Datum& datum : variable.initial) addresses.insert(datum.symbol);
    }
    for (Function& function : module.functions) {
        function.address_taken = addresses.contains(function.symbol);
        if (function.address_taken) {
            function.signature =
                module.intern(signature_text(sizes_of(function.parameters), function.result_size));
        }
        for (Block& block : function.blocks) {
            for (Operation& operation : block.operations) {
                if (operation.opcode != Opcode::call_indirect) continue;
                operation.signature = module.intern(
                    signature_text(sizes_of(operation.arguments), operation.results.size()));
            }
        }
    }
}

CallGraph::CallGraph(const Module& module) : edges_(module.functions.size()) {
    for (std::size_t i = 0; i < module.functions.size(); ++i) {
        const Function& function = module.functions[i];
        indices_[function.symbol] = i;
        if (function.address_taken) targets_[function.signature].push_back(i);
    }
    for (std::size_t i = 0; i < module.functions.size(); ++i) add_edges(module, i);
    find_groups();
}

void CallGraph::add_edges(const Module& module, std::size_t function) {
    for (const Block& block : module.functions[function].blocks) {
        for (const Operation& operation : block.operations) {
            if (operation.opcode == Opcode::call) {
                const std::size_t callee = index_of(operation.symbol);
                if (callee != kNoFunction) {
                    edges_[function].push_back({callee, operation.place, false});
                }
            } else if (operation.opcode == Opcode::call_indirect) {
                for (const std::size_t callee : targets(operation.signature)) {
                    edges_[function].push_back({callee, operation.place, true});
                }
            }
        }
    }
}

const std::vector<std::size_t>& CallGraph::targets(SymbolId signature) const {
    static const std::vector<std::size_t> kNobody;
    const auto found = targets_.find(signature);
    return found == targets_.end() ? kNobody : found->second;
}

std::size_t CallGraph::index_of(SymbolId symbol) const {
    const auto found = indices_.find(symbol);
    return found == indices_.end() ? kNoFunction : found->second;
}

// Tarjan's algorithm with a stack of its own; groups are complete callees first.
void CallGraph::find_groups() {
    const std::size_t count = edges_.size();
    constexpr std::size_t kUnseen = SIZE_MAX;
    std::vector<std::size_t> number(count, kUnseen);
    std::vector<std::size_t> lowest(count, 0);
    std::vector<std::size_t> open;
    group_.assign(count, kUnseen);
    recursive_.assign(count, false);
    std::size_t next = 0;
    std::size_t groups = 0;
    struct Visit {
        std::size_t function;
        std::size_t edge;
    };
    for (std::size_t start = 0; start < count; ++start) {
        if (number[start] != kUnseen) continue;
        std::vector<Visit> visits = {{start, 0}};
        while (!visits.empty()) {
            const auto [function, edge] = visits.back();
            if (edge == 0) {
                number[function] = lowest[function] = next++;
                open.push_back(function);
            }
            if (edge < edges_[function].size()) {
                const std::size_t callee = edges_[function][edge].callee;
                ++visits.back().edge;
                if (callee == function) recursive_[function] = true;
                if (number[callee] == kUnseen) {
                    visits.push_back({callee, 0});
                } else if (group_[callee] == kUnseen) {
                    lowest[function] = std::min(lowest[function], number[callee]);
                }
                continue;
            }
            visits.pop_back();
            if (!visits.empty()) {
                std::size_t& above = lowest[visits.back().function];
                above = std::min(above, lowest[function]);
            }
            if (lowest[function] != number[function]) continue;
            const bool alone = open.back() == function;
            std::size_t member = kUnseen;
            do {
                member = open.back();
                open.pop_back();
                group_[member] = groups;
                if (!alone) recursive_[member] = true;
                bottom_up_.push_back(member);
            } while (member != function);
            ++groups;
        }
    }
}

std::vector<GraphEdge> CallGraph::cycle(std::size_t function) const {
    // Breadth first within the group.
    std::map<std::size_t, std::pair<std::size_t, GraphEdge>> reached_by;
    std::vector<std::size_t> queue = {function};
    for (std::size_t i = 0; i < queue.size() && !reached_by.contains(function); ++i) {
        for (const GraphEdge& edge : edges_[queue[i]]) {
            if (group_[edge.callee] != group_[function]) continue;
            if (reached_by.try_emplace(edge.callee, queue[i], edge).second) {
                queue.push_back(edge.callee);
            }
        }
    }
    std::vector<GraphEdge> way;
    if (!reached_by.contains(function)) return way;
    std::size_t current = function;
    do {
        const auto& [caller, edge] = reached_by.at(current);
        way.insert(way.begin(), edge);
        current = caller;
    } while (current != function);
    return way;
}

}  // namespace toolchain::codegen
