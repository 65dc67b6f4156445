// flow_program.hpp - an image's code with a bound for every loop, and the step as one turn of main.
// Depends on   code_graph.hpp, loops.hpp, flow_facts.hpp, tools/budget/image_map.hpp.
// Refuses      a loop without a bound, with its source line; rules and facts that fit nothing.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/bounds/code_graph.hpp"
#include "tools/bounds/flow_facts.hpp"
#include "tools/bounds/loops.hpp"
#include "tools/budget/image_map.hpp"

namespace rover_bounds {

/// A loop and how often its header runs each time the loop is entered.
struct BoundedLoop {
    Loop loop;
    unsigned number = 0;  ///< in its function, from 1, as flow facts name it
    LoopKind kind = LoopKind::turns;
    uint32_t most = 0;
};

/// An interrupt: where it enters, and its procedure's entry.
struct Handler {
    std::string name;  ///< "RST 7.5"
    uint16_t vector = 0;
};

class FlowProgram {
public:
    /// @param image, symbols  must outlive the program
    /// @errors BudgetError: see above
    FlowProgram(const host_sim::Image& image, const host_sim::Symbols& symbols,
                const rover_budget::ImageMap& map, FlowTable table);

    [[nodiscard]] const CodeSource& source() const { return source_; }
    [[nodiscard]] const host_sim::Symbols& symbols() const { return *source_.symbols; }
    [[nodiscard]] const CodeGraph& graph() const { return graph_; }
    [[nodiscard]] const FlowTable& table() const { return table_; }
    [[nodiscard]] const std::vector<BoundedLoop>& loops(uint16_t entry) const {
        return loops_.at(entry);
    }
    /// One turn of the step loop in main; it stands beside the graph's procedures.
    [[nodiscard]] const Procedure& step() const { return step_; }
    [[nodiscard]] const std::vector<BoundedLoop>& step_loops() const { return step_loops_; }
    /// The function that waits for the step's tick: no part of the step's work.
    [[nodiscard]] uint16_t wait() const { return wait_; }
    [[nodiscard]] uint16_t main() const { return main_; }
    [[nodiscard]] const std::vector<Handler>& handlers() const { return handlers_; }
    /// Where the program begins: behind the loader, if there is one.
    [[nodiscard]] uint16_t first() const { return first_; }

private:
    void take_notes(const rover_budget::ImageMap& map);
    void bound_loops(const Procedure& procedure, std::vector<std::string>& unbounded);
    void apply_rules(const Procedure& procedure, std::vector<BoundedLoop>& loops);
    void find_step();
    void check_table() const;

    CodeSource source_;
    FlowTable table_;
    CodeGraph graph_;
    std::map<uint16_t, uint32_t> noted_;  ///< turns by address
    uint16_t first_ = 0;
    std::map<uint16_t, std::vector<BoundedLoop>> loops_;
    Procedure step_;
    std::vector<BoundedLoop> step_loops_;
    std::vector<bool> rule_used_;
    uint16_t main_ = 0, wait_ = 0;
    std::vector<Handler> handlers_;
};

}  // namespace rover_bounds
