// routine_stack.hpp - bytes of stack that the runtime's routines take, from their code.
// Depends on   toolchain/asm, toolchain/isa.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "toolchain/asm/object.hpp"

namespace toolchain::codegen {

/// Follows every way through the routines: PUSH, POP, CALL and RET; SP must not be set.
class RoutineStack {
public:
    explicit RoutineStack(std::span<const assembly::Module> modules);

    /// Most that a call of it takes, its own return address left out; 0 for what is no routine.
    /// @errors std::logic_error: a way that does not end, pops what it has not pushed, or recurses
    [[nodiscard]] uint32_t of(const std::string& label);

private:
    struct Place {
        const assembly::Section* section = nullptr;
        std::size_t item = 0;
    };
    [[nodiscard]] Place place_of(const assembly::Section& section, const std::string& label) const;
    uint32_t follow(const Place& start);

    std::map<std::string, Place> labels_;
    std::map<std::string, uint32_t> known_;
};

}  // namespace toolchain::codegen
