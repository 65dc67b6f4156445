// startup.hpp - the code between reset and main.
// Does         clears the zero region, copies initialised data from ROM, sets SP, calls
// constructors
//              and main, halts for good.
// Depends on   interrupts being disabled, as RESET leaves them. TRAP cannot be disabled: while the
//              zero region is cleared, SP walks down through it, so a handler of TRAP has what is
//              below (frames and data, neither in use yet) as its stack.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "toolchain/asm/object.hpp"
#include "toolchain/asm/program.hpp"

namespace toolchain::assembly {

struct StartupOptions {
    std::string main = "main";
    std::vector<std::string> constructors{};  ///< called in this order, before main
    std::string name = "__reset";             ///< label of the first instruction
};

/// What start-up has to know about memory.
struct StartupMemory {
    Region data{};
    Region data_image{};
    Region zero{};           ///< of even size
    uint16_t stack_end = 0;  ///< first address behind the stack; 0 for a stack up to FFFFH
};

struct Startup {
    Section section{};
    uint32_t t_states = 0;  ///< from the first instruction up to the first CALL, exact
};

/// Only what there is to do is done: without data there is no copying.
/// Clearing takes 13 T a byte and copying 40 T, and a little for every 512 and 256 bytes.
[[nodiscard]] Startup make_startup(const StartupOptions& options, const StartupMemory& memory);

}  // namespace toolchain::assembly
