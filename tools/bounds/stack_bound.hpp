// stack_bound.hpp - the deepest stack and the longest time with interrupts disabled, from the code.
// Depends on   flow_program.hpp.
// Method       every instruction is followed with the bytes pushed so far and the state of the
//              interrupt enable flip-flop: EI takes effect behind the next instruction.
// Refuses      what moves SP otherwise than PUSH, POP, CALL, RET; a loop or a return with
// interrupts
//              disabled.
// Design note  docs/design/bounds.md, "Stack"
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bounds/flow_program.hpp"

namespace rover_bounds {

/// Bytes on the stack.
struct StackBound {
    /// Of main or of one handler, its return address included and no interrupt on top.
    struct Part {
        std::string name;
        uint32_t disabled = 0;  ///< where interrupts are disabled: only TRAP comes
        uint32_t enabled = 0;
    };
    std::vector<Part> parts;  ///< main first
    uint32_t with_interrupts = 0;
};

/// @errors BudgetError: see above
[[nodiscard]] StackBound stack_bound(const FlowProgram& program);

/// A stretch of the program during which no interrupt but TRAP is accepted.
struct DisabledStretch {
    std::string place;  ///< a handler, or the function and address of a DI
    uint32_t t = 0;  ///< from the acceptance, or the beginning of DI, to the instruction behind EI
};

/// Those of the handlers, in the order of FlowProgram::handlers(), then those of the step.
[[nodiscard]] std::vector<DisabledStretch> disabled_stretches(const FlowProgram& program);

}  // namespace rover_bounds
