// step_profile.hpp - T-states by module and by control step, interrupt load and latency, from the
// steps of the simulated processor.
// Depends on   host_sim/trace/call_stack.hpp, host_sim/cpu, placement.hpp, modules.hpp.
// Rules        docs/design/budget.md, "What is counted where".
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/trace/call_stack.hpp"
#include "tools/budget/modules.hpp"

namespace rover_budget {

/// Where something was worst.
struct WorstPlace {
    std::string log;
    uint64_t step = 0;  ///< from 0

    bool operator==(const WorstPlace&) const = default;
};

/// T-states of something, added up by step.
struct StepTime {
    uint64_t total_t = 0;
    uint64_t steps = 0;  ///< in which it took any time
    uint64_t worst_t = 0;
    WorstPlace worst;
    uint64_t run_t = 0;        ///< of the steps in a row with any time, the last one included
    uint64_t worst_run_t = 0;  ///< the most of all such rows: work that is spread over steps

    void take(uint64_t t, const std::string& log, uint64_t step);
};

/// One interrupt input over all steps.
struct InterruptTime {
    uint64_t accepted = 0;
    uint64_t total_t = 0;          ///< from acceptance to return, without interrupts in between
    uint64_t worst_t = 0;          ///< the longest one
    uint64_t worst_latency_t = 0;  ///< from the request to the first instruction at the vector
};

enum class InterruptInput : uint8_t { trap, rst75, rst65, rst55 };
inline constexpr std::size_t kInterruptInputCount = 4;
[[nodiscard]] std::string_view input_name(InterruptInput input);

struct ProfileFigures {
    uint64_t steps = 0;
    uint64_t total_t = 0;  ///< of all steps, with waiting
    uint64_t boot_t = 0;   ///< the longest time from reset to the end of the boot
    StepTime main_line;    ///< work of the main line in a step: no interrupts, no waiting, no boot
    StepTime interrupts;   ///< in all handlers
    std::vector<StepTime> modules;
    std::array<InterruptTime, kInterruptInputCount> inputs;
    uint64_t stack_bytes = 0;  ///< the deepest seen
};

/// Adds up runs of the image, one board after the other.
class StepProfile final : private host_sim::CallListener {
public:
    struct Program {
        const host_sim::Symbols* symbols = nullptr;
        const std::vector<Module>* modules = nullptr;
        const std::vector<uint16_t>* module_of = nullptr;  ///< by address
        uint16_t step_count_address = 0;  ///< of the u16 that the image counts its steps with
        uint32_t stack_end = 0;           ///< where SP starts
        uint16_t first = 0;               ///< where it begins: behind a loader
    };
    /// Called at the end of every step that counts. @param main_t, interrupt_t  of that step
    std::function<void(uint64_t main_t, uint64_t interrupt_t)> step_ended;

    /// What `program` points to must outlive the profile.
    explicit StepProfile(const Program& program);

    /// A board begins to run. Its boot counts, its steps do not yet.
    void begin(const std::string& log);

    /// The steps of the log begin here. @pre  the image stands between two steps
    void count_steps();

    /// Takes the next step of the processor and how it leaves it.
    void observe(const host_sim::StepRecord& step, const host_sim::CpuState& after);

    /// Of the complete steps so far.
    [[nodiscard]] const ProfileFigures& figures() const { return figures_; }

private:
    void frame_begins(const host_sim::Frame&, bool) override {}
    void frame_ends(const host_sim::Frame& frame) override;
    void time_passes(const host_sim::Frame& frame, uint64_t t) override;
    [[nodiscard]] std::size_t owner() const;
    void out_of_reset();
    void clear_step();
    void accept(const host_sim::StepRecord& step, const host_sim::CpuState& after);
    void watch_masks(const host_sim::CpuState& after);
    void watch_step_count(const host_sim::StepRecord& step);
    void watch_stack(const host_sim::CpuState& after);
    uint64_t take_boot();
    void end_step();

    Program program_;
    std::optional<host_sim::CallStack> stack_;
    ProfileFigures figures_;
    std::string log_;
    uint64_t log_step_ = 0;
    bool counting_ = false;
    uint16_t step_count_ = 0;  ///< as last written, byte by byte
    uint16_t steps_counted_ = 0;
    uint8_t masks_ = 0;
    std::array<uint64_t, kInterruptInputCount> unmasked_t_{};  ///< since when the mask is open
    std::vector<uint64_t> module_t_;                           ///< of this step
    uint64_t main_t_ = 0;
    uint64_t interrupt_t_ = 0;
    uint64_t elapsed_t_ = 0;
    std::array<InterruptTime, kInterruptInputCount> inputs_{};  ///< of this step
};

}  // namespace rover_budget
