// call_profile.cpp - adding up; call_profile_report.cpp writes the result.
#include "host_sim/trace/call_profile.hpp"

#include <algorithm>

#include "toolchain/isa/disassemble.hpp"

namespace host_sim {
namespace {

std::size_t input_index(StepRecord::Kind source) {
    return static_cast<std::size_t>(source) - static_cast<std::size_t>(StepRecord::Kind::trap);
}

}  // namespace

void CallProfile::observe(const StepRecord& step) {
    total_t_ += step.t_end - step.t_begin;
    if (step.kind == StepRecord::Kind::halt) halt_t_ += step.t_end - step.t_begin;
    stack_.observe(step);
}

void CallProfile::frame_begins(const Frame& frame, bool called) {
    if (frame.interrupt) {
        ++interrupts_[input_index(frame.source)].accepted;
    } else if (called) {
        ++functions_[frame.function].calls;
    }
}

void CallProfile::frame_ends(const Frame& frame) {
    if (frame.interrupt) {
        InterruptProfile& input = interrupts_[input_index(frame.source)];
        input.total_t += frame.t_inside;
        ++input.completed;
        input.worst_t = std::max(input.worst_t, frame.t_inside);
    } else if (frame.outermost) {
        FunctionProfile& function = functions_[frame.function];
        function.inclusive_t += frame.t_inside;
        ++function.completed;
        function.completed_t += frame.t_inside;
        function.worst_t = std::max(function.worst_t, frame.t_inside);
    }
}

void CallProfile::time_passes(const Frame& frame, uint64_t t) {
    FunctionProfile& function = functions_[frame.function];
    function.exclusive_t += t;
    if (stack_.interrupt_depth() == 0) return;
    function.exclusive_interrupt_t += t;
    interrupt_t_ += t;
}

ProfileReport CallProfile::report() const {
    constexpr std::array<const char*, 5> kInputs = {"TRAP", "RST 7.5", "RST 6.5", "RST 5.5",
                                                    "INTR"};
    auto functions = functions_;
    auto interrupts = interrupts_;
    uint64_t t_inside = 0;  // of the open activations above, up to the next interrupt
    const auto& frames = stack_.frames();
    for (auto frame = frames.rbegin(); frame != frames.rend(); ++frame) {
        t_inside += frame->t_inside;
        if (frame->interrupt) {
            interrupts[input_index(frame->source)].total_t += t_inside;
            t_inside = 0;
        } else if (frame->outermost) {
            functions[frame->function].inclusive_t += t_inside;
        }
    }

    ProfileReport result;
    result.total_t = total_t_;
    result.halt_t = halt_t_;
    result.interrupt_t = interrupt_t_;
    for (auto& [address, function] : functions) {
        const Symbol* symbol = symbols_ == nullptr ? nullptr : symbols_->function_at(address);
        function.address = address;
        function.name = symbol == nullptr ? toolchain::isa::intel_hex(address, 4) : symbol->name;
        result.functions.push_back(function);
    }
    std::ranges::stable_sort(result.functions, std::ranges::greater{},
                             &FunctionProfile::exclusive_t);
    for (std::size_t i = 0; i < interrupts.size(); ++i) {
        if (interrupts[i].accepted == 0) continue;
        interrupts[i].name = kInputs[i];
        result.interrupts.push_back(interrupts[i]);
    }
    return result;
}

}  // namespace host_sim
