// step_profile.cpp - see step_profile.hpp.
#include "tools/budget/step_profile.hpp"

#include <algorithm>

namespace rover_budget {
namespace {

using host_sim::CpuState;
using host_sim::StepRecord;

constexpr std::array<std::string_view, kInterruptInputCount> kInputNames = {"TRAP", "RST 7.5",
                                                                            "RST 6.5", "RST 5.5"};
/// SIM masks of the inputs; TRAP has none.
constexpr std::array<uint8_t, kInterruptInputCount> kMasks = {
    0, host_sim::mask::kRst75, host_sim::mask::kRst65, host_sim::mask::kRst55};

std::optional<std::size_t> input_of(StepRecord::Kind kind) {
    switch (kind) {
        case StepRecord::Kind::trap:
            return 0;
        case StepRecord::Kind::rst75:
            return 1;
        case StepRecord::Kind::rst65:
            return 2;
        case StepRecord::Kind::rst55:
            return 3;
        default:
            return {};
    }
}

/// When the input asked for what has just been accepted. A level is still there.
uint64_t request_t(std::size_t input, const CpuState& after) {
    switch (input) {
        case 0:
            return after.trap_latched_t;
        case 1:
            return after.rst75_latched_t;
        case 2:
            return after.pin(host_sim::Pin::rst65).changed_t;
        default:
            return after.pin(host_sim::Pin::rst55).changed_t;
    }
}

}  // namespace

std::string_view input_name(InterruptInput input) {
    return kInputNames[static_cast<std::size_t>(input)];
}

void StepTime::take(uint64_t t, const std::string& log, uint64_t step) {
    run_t = t == 0 || step == 0 ? t : run_t + t;
    worst_run_t = std::max(worst_run_t, run_t);
    if (t == 0) return;
    total_t += t;
    ++steps;
    if (t <= worst_t) return;
    worst_t = t;
    worst = {log, step};
}

StepProfile::StepProfile(const Program& program) : program_(program) {
    figures_.modules.resize(program.modules->size());
    module_t_.resize(program.modules->size());
}

void StepProfile::begin(const std::string& log) {
    out_of_reset();
    clear_step();
    log_ = log;
    log_step_ = 0;
    counting_ = false;
}

void StepProfile::count_steps() {
    take_boot();
    clear_step();
    counting_ = true;
}

void StepProfile::out_of_reset() {
    stack_.emplace(program_.symbols, static_cast<host_sim::CallListener&>(*this));
    step_count_ = steps_counted_ = 0;
    masks_ = host_sim::mask::kAll;
    unmasked_t_.fill(0);
}

void StepProfile::clear_step() {
    std::ranges::fill(module_t_, 0);
    main_t_ = interrupt_t_ = elapsed_t_ = 0;
    inputs_.fill({});
}

void StepProfile::observe(const StepRecord& step, const CpuState& after) {
    if (step.pc == 0 && step.kind == StepRecord::Kind::instruction) out_of_reset();
    elapsed_t_ += step.t_end - step.t_begin;
    stack_->observe(step);
    accept(step, after);
    watch_masks(after);
    if (step.pc >= program_.first) watch_stack(after);
    watch_step_count(step);
}

/// SP is the program's from the start-up on; before that it holds what it held, and the loader has
/// a stack of its own in the same page.
void StepProfile::watch_stack(const CpuState& after) {
    constexpr uint32_t kDeepestBelievable = 0x400;
    if (after.sp > program_.stack_end || program_.stack_end - after.sp > kDeepestBelievable) return;
    figures_.stack_bytes = std::max<uint64_t>(figures_.stack_bytes, program_.stack_end - after.sp);
}

void StepProfile::accept(const StepRecord& step, const CpuState& after) {
    const auto input = input_of(step.kind);
    if (!input) return;
    InterruptTime& time = inputs_[*input];
    ++time.accepted;
    const uint64_t asked_t = std::max(request_t(*input, after), unmasked_t_[*input]);
    time.worst_latency_t = std::max(time.worst_latency_t, step.t_end - asked_t);
}

void StepProfile::watch_masks(const CpuState& after) {
    for (std::size_t input = 0; input < kInterruptInputCount; ++input) {
        const bool was_closed = (masks_ & kMasks[input]) != 0;
        if (was_closed && (after.masks & kMasks[input]) == 0) unmasked_t_[input] = after.t;
    }
    masks_ = after.masks;
}

void StepProfile::watch_step_count(const StepRecord& step) {
    for (unsigned i = 0; i < step.access_count; ++i) {
        const host_sim::BusAccess& access = step.accesses[i];
        if (access.kind != host_sim::BusAccess::Kind::write) continue;
        if (access.address == program_.step_count_address) {
            step_count_ = static_cast<uint16_t>((step_count_ & 0xFF00) | access.value);
        } else if (access.address == program_.step_count_address + 1) {
            step_count_ = static_cast<uint16_t>((step_count_ & 0x00FF) | access.value << 8);
        }
    }
    if (step_count_ != static_cast<uint16_t>(steps_counted_ + 1)) return;
    steps_counted_ = step_count_;
    end_step();
}

/// @return  T-states that the boot took since the last step
uint64_t StepProfile::take_boot() {
    uint64_t boot_t = 0;
    for (std::size_t i = 0; i < module_t_.size(); ++i) {
        if ((*program_.modules)[i].kind != ModuleKind::boot || module_t_[i] == 0) continue;
        figures_.modules[i].take(module_t_[i], log_, log_step_);
        boot_t += module_t_[i];
        module_t_[i] = 0;
    }
    figures_.boot_t = std::max(figures_.boot_t, boot_t);
    return boot_t;
}

void StepProfile::end_step() {
    const uint64_t boot_t = take_boot();
    if (!counting_) {
        clear_step();
        return;
    }
    for (std::size_t i = 0; i < module_t_.size(); ++i) {
        figures_.modules[i].take(module_t_[i], log_, log_step_);
    }
    figures_.main_line.take(main_t_, log_, log_step_);
    figures_.interrupts.take(interrupt_t_, log_, log_step_);
    figures_.total_t += elapsed_t_ - boot_t;
    ++figures_.steps;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
        InterruptTime& sum = figures_.inputs[i];
        sum.accepted += inputs_[i].accepted;
        sum.total_t += inputs_[i].total_t;
        sum.worst_t = std::max(sum.worst_t, inputs_[i].worst_t);
        sum.worst_latency_t = std::max(sum.worst_latency_t, inputs_[i].worst_latency_t);
    }
    if (step_ended) step_ended(main_t_, interrupt_t_);
    clear_step();
    ++log_step_;
}

void StepProfile::frame_ends(const host_sim::Frame& frame) {
    if (!frame.interrupt) return;
    const auto input = input_of(frame.source);
    if (!input) return;
    inputs_[*input].total_t += frame.t_inside;
    inputs_[*input].worst_t = std::max(inputs_[*input].worst_t, frame.t_inside);
}

void StepProfile::time_passes(const host_sim::Frame&, uint64_t t) {
    const std::size_t module = owner();
    module_t_[module] += t;
    const ModuleKind kind = (*program_.modules)[module].kind;
    if (stack_->interrupt_depth() != 0) {
        interrupt_t_ += t;
    } else if (kind == ModuleKind::step || kind == ModuleKind::library) {
        main_t_ += t;
    }
}

/// The module of the innermost function that is no library routine, within this interrupt.
std::size_t StepProfile::owner() const {
    const std::vector<Module>& modules = *program_.modules;
    const auto& frames = stack_->frames();
    std::size_t module = modules.size() - 1;
    for (auto frame = frames.rbegin(); frame != frames.rend() && !frame->interrupt; ++frame) {
        module = (*program_.module_of)[frame->function];
        if (modules[module].kind != ModuleKind::library) break;
    }
    return module;
}

}  // namespace rover_budget
