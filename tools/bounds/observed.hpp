// observed.hpp - compares what runs with the bounds: T-states, turns of loops, flow facts, stack.
// Depends on   bounds.hpp, host_sim/trace/call_stack.hpp.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/trace/call_stack.hpp"
#include "tools/bounds/bounds.hpp"

namespace rover_bounds {

/// What the runs have shown.
struct Observed {
    uint64_t steps = 0;
    uint64_t step_t = 0;                        ///< main line of the longest step
    std::map<uint16_t, uint64_t> function_t;    ///< longest call, by entry
    std::map<std::string, uint64_t> handler_t;  ///< longest run, acceptance included
    uint32_t stack_bytes = 0;                   ///< deepest
    std::set<std::string> violations;           ///< a line each
};

/// Listens to the processor, from a reset on or from wherever it stands between two steps.
class Observer final : private host_sim::CallListener {
public:
    /// @param stack_end  where SP starts. What is referred to must outlive the observer.
    Observer(const FlowProgram& program, const Bounds& bounds, uint32_t stack_end);

    void observe(const host_sim::StepRecord& step, const host_sim::CpuState& after);
    /// Another board begins.
    void restart();

    [[nodiscard]] const Observed& observed() const { return observed_; }

private:
    static constexpr uint32_t kDeepestBelievable = 0x400;  ///< else SP is not yet the program's

    /// Main line or one interrupt: T-states, and counts by index of the facts' items.
    struct Level {
        std::vector<int64_t> counts;
        uint64_t t = 0;
    };
    /// Where a function that is active stands.
    struct Activation {
        uint16_t last_pc = 0;
        bool fresh = true;  ///< no instruction yet
    };
    struct WatchedLoop {
        const BoundedLoop* loop = nullptr;
        const Procedure* procedure = nullptr;
        uint16_t address = 0;  ///< of its header
        std::vector<std::pair<uint16_t, uint16_t>> ranges{};
        uint64_t turns = 0;  ///< since it was entered
        std::vector<std::size_t> items{};

        [[nodiscard]] bool holds(uint16_t pc) const {
            for (const auto& [first, last] : ranges) {
                if (pc >= first && pc <= last) return true;
            }
            return false;
        }
    };

    void watch(const Procedure& procedure, const BoundedLoop& loop);
    void watch(const FlowItem& item, std::size_t index);
    void frame_begins(const host_sim::Frame& frame, bool called) override;
    void frame_ends(const host_sim::Frame& frame) override;
    void time_passes(const host_sim::Frame& frame, uint64_t t) override;
    void watch_stack(uint16_t sp);
    void watch_loops(uint16_t pc);
    void count_turn(WatchedLoop& loop, const Activation& activation);
    void begin_step();
    void end_handler(const std::string& name);
    void check_facts(const Level& level, const std::string& where);
    void violated(std::string what);

    const FlowProgram& program_;
    const Bounds& bounds_;
    uint32_t stack_end_;
    Observed observed_;
    std::optional<host_sim::CallStack> stack_;
    std::vector<Activation> activations_;  ///< one for each frame of the stack
    std::vector<Level> levels_;            ///< the main line's, then one for each interrupt
    std::vector<WatchedLoop> loops_;       ///< by address
    std::vector<int32_t> loops_at_;        ///< by address: the first loop that begins there, or -1
    std::map<uint16_t, std::vector<std::size_t>> call_items_;          ///< by entry
    std::vector<std::vector<std::pair<std::size_t, int64_t>>> facts_;  ///< item and factor
    std::size_t items_ = 0;
    unsigned waiting_ = 0;  ///< activations of rover_wait
    bool in_step_ = false;
};

}  // namespace rover_bounds
