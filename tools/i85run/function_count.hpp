// function_count.hpp - calls of one function and their T-states, from a stream of steps.
// Depends on   host_sim/cpu/step_record.hpp.
// Bounds       a call ends with the first RET, taken conditional RET or PCHL that leaves SP above
//              its return address. A function that takes its return address off the stack, calls
//              others, and then returns by it is seen to end at the first return of the others.
#pragma once

#include <cstdint>

#include "host_sim/cpu/step_record.hpp"

namespace i85run {

/// Counts calls of the function at one address, however it is reached (CALL, RST, a tail jump, or
/// as the entry). A call's T-states run from its first instruction to the end of its RET, callees
/// included; the CALL itself is the caller's. A recursive call is part of the outermost one.
class FunctionCount {
public:
    explicit FunctionCount(uint16_t address) : address_(address) {}

    /// Takes the next step of the program.
    void observe(const host_sim::StepRecord& record);

    [[nodiscard]] uint64_t calls() const { return calls_; }           ///< that have returned
    [[nodiscard]] uint64_t t_states() const { return t_states_; }     ///< of all these calls
    [[nodiscard]] uint64_t worst_t_states() const { return worst_; }  ///< of one call; 0 if none
    [[nodiscard]] double mean_t_states() const {                      ///< of one call; 0 if none
        return calls_ == 0 ? 0.0 : static_cast<double>(t_states_) / static_cast<double>(calls_);
    }
    [[nodiscard]] bool active() const { return active_; }  ///< a call has not returned yet

private:
    uint16_t address_;
    bool active_ = false;
    uint16_t entry_sp_ = 0;
    uint64_t entry_t_ = 0;
    uint64_t calls_ = 0;
    uint64_t t_states_ = 0;
    uint64_t worst_ = 0;
};

}  // namespace i85run
