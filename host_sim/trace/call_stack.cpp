// call_stack.cpp - see call_stack.hpp.
#include "host_sim/trace/call_stack.hpp"

#include "toolchain/isa/instruction_set.hpp"

namespace host_sim {
namespace {

using toolchain::isa::Flow;

/// The root's return address lies above all memory, so that nothing unwinds it.
constexpr uint32_t kRootSp = 0x20000;

/// A stack that starts at the top of memory begins with SP = 0000H: it stands for 10000H.
uint32_t height(uint16_t sp) {
    return sp == 0 ? 0x10000u : sp;
}

/// The address of the next instruction in memory.
uint16_t behind(const StepRecord& step) {
    return static_cast<uint16_t>(step.pc + toolchain::isa::instruction(step.opcode()).bytes);
}

bool pushed_a_word(const StepRecord& step) {
    return step.next_sp == static_cast<uint16_t>(step.sp - 2);
}

}  // namespace

uint16_t CallStack::function_of(uint16_t address) const {
    const Symbol* symbol = symbols_ == nullptr ? nullptr : symbols_->function_at(address);
    return symbol == nullptr ? address : symbol->address;
}

void CallStack::spend(uint64_t t) {
    frames_.back().t_inside += t;
    listener_.time_passes(frames_.back(), t);
}

void CallStack::begin(Frame frame, bool called) {
    frame.outermost = true;
    for (auto below = frames_.rbegin(); below != frames_.rend() && !below->interrupt; ++below) {
        if (below->function == frame.function) frame.outermost = false;
    }
    if (frame.interrupt) ++interrupt_depth_;
    frames_.push_back(frame);
    listener_.frame_begins(frame, called);
}

void CallStack::end_one() {
    const Frame ended = frames_.back();
    frames_.pop_back();
    if (ended.interrupt) {
        --interrupt_depth_;  // what it took is not the interrupted function's
    } else if (!frames_.empty()) {
        frames_.back().t_inside += ended.t_inside;
    }
    listener_.frame_ends(ended);
}

/// Ends the current activation, and the interrupt if it was its handler.
void CallStack::end() {
    end_one();
    if (frames_.back().interrupt) end_one();
}

void CallStack::observe(const StepRecord& step) {
    if (frames_.empty()) {
        Frame root;
        root.function = function_of(step.pc);
        root.entry_sp = kRootSp;
        begin(root, true);
    }
    if (step.kind == StepRecord::Kind::instruction) {
        spend(step.t_end - step.t_begin);
        instruction(step);
    } else if (step.kind != StepRecord::Kind::halt) {
        // INTR may bring another instruction than RST or CALL.
        if (pushed_a_word(step)) interrupt(step);
        spend(step.t_end - step.t_begin);
    }
}

void CallStack::interrupt(const StepRecord& step) {
    Frame frame;
    frame.entry_sp = height(step.next_sp);
    frame.return_address = step.pc;
    frame.interrupt = true;
    frame.source = step.kind;
    begin(frame, true);
    frame.function = function_of(step.next_pc);
    frame.interrupt = false;
    if (frame.function == step.next_pc) called_[step.next_pc] = true;
    begin(frame, true);
}

void CallStack::instruction(const StepRecord& step) {
    switch (toolchain::isa::instruction(step.opcode()).flow) {
        case Flow::call:
        case Flow::restart:
            if (pushed_a_word(step)) call(step);
            return;
        case Flow::ret:
            if (step.next_sp == step.sp) break;  // not taken
            give_back(step);
            break;
        case Flow::jump_hl:
            unwind(height(step.next_sp));
            break;
        case Flow::jump:
            // One word more: a function may loop while it holds its return address in a register.
            unwind(height(step.next_sp) - 2);
            break;
        case Flow::halt:
            return;
        case Flow::next:
            break;
    }
    transfer(step);
}

void CallStack::call(const StepRecord& step) {
    Frame frame;
    frame.function = function_of(step.next_pc);
    frame.entry_sp = height(step.next_sp);
    frame.return_address = behind(step);
    // A call into the middle of the function itself stays a part of it.
    if (frame.function != step.next_pc && frame.function == frames_.back().function) return;
    // Where this return address lies now, no other one is left. But the uppermost frame of the same
    // height may hold its own in a register.
    unwind(frame.entry_sp);
    while (frames_.size() > 1 && frames_.back().entry_sp == frame.entry_sp &&
           frames_[frames_.size() - 2].entry_sp == frame.entry_sp &&
           !frames_[frames_.size() - 2].interrupt) {
        end();
    }
    if (frame.function == step.next_pc) called_[frame.function] = true;
    begin(frame, true);
}

void CallStack::give_back(const StepRecord& step) {
    const Frame& top = frames_.back();
    if (top.return_address == step.next_pc && height(step.next_sp) == top.entry_sp + 2) {
        end();  // only this one: its caller may have taken its own return address off the stack
    } else {
        unwind(height(step.next_sp));
    }
}

/// Ends the activations whose return address lies below `sp`.
void CallStack::unwind(uint32_t sp) {
    while (frames_.back().entry_sp < sp) end();
}

/// Behind a jump, a return or the last instruction of a function: who runs now?
void CallStack::transfer(const StepRecord& step) {
    const Symbol* symbol = symbols_ == nullptr ? nullptr : symbols_->function_at(step.next_pc);
    if (symbol == nullptr && !called_[step.next_pc]) return;  // code without a name
    const uint16_t function = symbol == nullptr ? step.next_pc : symbol->address;
    if (function == frames_.back().function) return;

    const bool entered = function == step.next_pc;
    const bool jumped = step.next_pc != behind(step);
    Frame next = frames_.back();
    if (entered && jumped && frames_.size() > 1 && height(step.next_sp) < next.entry_sp) {
        next.entry_sp = height(step.next_sp);  // a call by PUSH and a jump
        next.return_address = 0;
    } else {
        end_one();  // a tail call: the other returns in its place
    }
    next.function = function;
    next.t_inside = 0;
    begin(next, entered);
}

}  // namespace host_sim
