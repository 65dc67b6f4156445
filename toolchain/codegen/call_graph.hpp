// call_graph.hpp - who calls whom, directly and through pointers.
// Depends on   mir.hpp with address_taken and signatures (mark_signatures()).
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

/// Finds the functions whose address is taken, by code or by data, and gives them and the calls
/// through pointers their signatures. An indirect call may reach every function with its signature.
void mark_signatures(Module& module);

/// A call from one function to another.
struct GraphEdge {
    std::size_t callee = 0;  ///< index into Module::functions
    SourcePlace place{};
    bool through_pointer = false;
};

class CallGraph {
public:
    explicit CallGraph(const Module& module);

    /// Of a function by its index, in the order of the code; callees may repeat.
    [[nodiscard]] const std::vector<GraphEdge>& callees(std::size_t function) const {
        return edges_[function];
    }
    /// Functions that a call of this signature may reach.
    [[nodiscard]] const std::vector<std::size_t>& targets(SymbolId signature) const;
    /// Index of a function, or kNoFunction.
    [[nodiscard]] std::size_t index_of(SymbolId symbol) const;
    /// Functions that can come back to one another have the same group.
    [[nodiscard]] std::size_t group(std::size_t function) const { return group_[function]; }
    [[nodiscard]] bool is_recursive(std::size_t function) const { return recursive_[function]; }
    /// Callees before callers, but for recursion.
    [[nodiscard]] const std::vector<std::size_t>& bottom_up() const { return bottom_up_; }
    /// The functions of the shortest way from a recursive function back to itself, it first.
    [[nodiscard]] std::vector<GraphEdge> cycle(std::size_t function) const;

    static constexpr std::size_t kNoFunction = SIZE_MAX;

private:
    void add_edges(const Module& module, std::size_t function);
    void find_groups();

    std::map<SymbolId, std::size_t> indices_;
    std::map<SymbolId, std::vector<std::size_t>> targets_;
    std::vector<std::vector<GraphEdge>> edges_;
    std::vector<std::size_t> group_;
    std::vector<bool> recursive_;
    std::vector<std::size_t> bottom_up_;
};

}  // namespace toolchain::codegen
