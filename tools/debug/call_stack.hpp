// call_stack.hpp - who called whom: a shadow of the stack, kept up while the console steps.
// Depends on   host_sim/board, host_sim/cpu/step_record.hpp, toolchain/isa.
// Bounds       a frame ends when SP moves above its return address, so a frame is lost, never
//              wrong, when a program drops return addresses. Runs that nobody observes leave no
//              shadow; then memory is searched for words that a call may have pushed.
#pragma once

#include <cstdint>
#include <vector>

#include "host_sim/board/board_state.hpp"
#include "host_sim/cpu/step_record.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace debug_console {

/// One call or interrupt that has not returned.
struct Frame {
    enum class Kind : uint8_t { call, restart, trap, rst75, rst65, rst55, intr };
    Kind kind = Kind::call;
    bool guessed = false;    ///< found in memory, not observed
    uint16_t from = 0;       ///< of the call; of an interrupt the return address
    uint16_t target = 0;     ///< where it went
    uint16_t slot = 0;       ///< address of the return address on the stack
    uint16_t return_to = 0;  ///< the return address

    bool operator==(const Frame&) const = default;
};

class CallStack {
public:
    static constexpr std::size_t kDepthMax = 512;  ///< of a runaway recursion the newest remain

    /// Learns from an observed step.
    void follow(const host_sim::StepRecord& record) {
        if (record.next_sp != record.sp) change(record);
    }
    /// The processor was reset: nothing has called anything.
    void clear();
    /// The board ran, or was changed, unobserved.
    void forget();

    /// The observed frames, the newest last.
    [[nodiscard]] const std::vector<Frame>& frames() const { return frames_; }
    /// The observed frames, the newest first, and behind them what memory suggests.
    [[nodiscard]] std::vector<Frame> backtrace(const host_sim::BoardState& state) const;

private:
    void change(const host_sim::StepRecord& record);

    std::vector<Frame> frames_;
    bool complete_ = true;  ///< observed since the last reset
};

/// Whether `one` lies above `other` on a stack that may wrap at 64 KB.
[[nodiscard]] constexpr bool above(uint16_t one, uint16_t other) {
    return static_cast<int16_t>(static_cast<uint16_t>(one - other)) > 0;
}

/// How an instruction goes on; `next` for what is no instruction of the program.
[[nodiscard]] toolchain::isa::Flow flow_of(const host_sim::StepRecord& record);

}  // namespace debug_console
