// call_stack.hpp - which functions are active, followed from the steps of the processor alone.
// Depends on   host_sim/cpu/step_record.hpp, host_sim/image/symbols.hpp, toolchain/isa.
// Design note  docs/design/trace.md, "The shadow stack": returns are recognised by the stack
//              pointer, so code that bends its stack does not lose the track.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_sim/cpu/step_record.hpp"
#include "host_sim/image/symbols.hpp"

namespace host_sim {

/// One activation of a function, or the mark of an interrupt below its handler's.
struct Frame {
    uint16_t function = 0;        ///< its first address: its identity; of a mark 0
    uint32_t entry_sp = 0;        ///< SP at its first instruction, where the return address lies
    uint16_t return_address = 0;  ///< what CALL or the interrupt pushed
    uint64_t t_inside = 0;        ///< so far, with ended callees, without interrupts and HALT
    bool interrupt = false;       ///< a mark
    StepRecord::Kind source = StepRecord::Kind::instruction;  ///< of a mark: which interrupt
    bool outermost = true;  ///< no other activation of it below, back to the last interrupt
};

/// Hears of every activation that begins or ends, and of the time in between.
class CallListener {
public:
    virtual ~CallListener() = default;
    /// @param called  false: the function only goes on here, having been jumped into
    virtual void frame_begins(const Frame& frame, bool called) = 0;
    virtual void frame_ends(const Frame& frame) = 0;
    /// An instruction or the acceptance of an interrupt took `t` T-states in `frame`.
    virtual void time_passes(const Frame& frame, uint64_t t) = 0;
};

/// Follows calls, returns, tail calls, interrupts and what else moves the stack pointer.
class CallStack {
public:
    /// @param symbols   nullptr: functions are found as targets of calls and interrupts
    /// @param listener  must outlive the stack
    CallStack(const Symbols* symbols, CallListener& listener)
        : symbols_(symbols), listener_(listener) {}

    /// Takes the next step.
    void observe(const StepRecord& step);

    /// From the program's root to what runs now, which is never a mark; empty before the first
    /// step.
    [[nodiscard]] const std::vector<Frame>& frames() const { return frames_; }

    /// How many interrupts are being handled.
    [[nodiscard]] unsigned interrupt_depth() const { return interrupt_depth_; }

private:
    void interrupt(const StepRecord& step);
    void instruction(const StepRecord& step);
    void call(const StepRecord& step);
    void give_back(const StepRecord& step);
    void unwind(uint32_t sp);
    void transfer(const StepRecord& step);
    void spend(uint64_t t);
    void begin(Frame frame, bool called);
    void end_one();
    void end();
    [[nodiscard]] uint16_t function_of(uint16_t address) const;

    const Symbols* symbols_;
    CallListener& listener_;
    std::vector<Frame> frames_;
    unsigned interrupt_depth_ = 0;
    std::vector<bool> called_ = std::vector<bool>(kAddressSpaceSize);  ///< targets of calls so far
};

}  // namespace host_sim
