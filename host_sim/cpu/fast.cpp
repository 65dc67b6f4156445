// fast.cpp - dispatch of the fast interpreter: one indirect jump behind every opcode.
// Depends on   fast_opcodes.hpp; a compiler with labels as values (GCC, Clang).
// Why macros   a label needs a name per opcode, and no template can write one.
#include "host_sim/cpu/fast.hpp"

#include <array>

#include "host_sim/cpu/fast_opcodes.hpp"

#pragma GCC diagnostic ignored "-Wpedantic"  // labels as values

#define ROVER_NEXT                           \
    {                                        \
        const uint32_t opcode = bytes[r.pc]; \
        r.pc = fast::word(r.pc + 1);         \
        goto* handlers[opcode];              \
    }
#define ROVER_OPCODE(n)                                            \
    opcode_##n : {                                                 \
        const int t_states = fast::execute<0x##n>(r, memory);      \
        if (t_states == fast::kLeftToHost) goto left_to_host;      \
        r.clock += fast::clock_step(t_states);                     \
        if (__builtin_expect(r.clock < 0, false)) goto time_is_up; \
        ROVER_NEXT                                                 \
    }
// clang-format off
#define ROVER_ROW(n)                                                                             \
    ROVER_OPCODE(n##0) ROVER_OPCODE(n##1) ROVER_OPCODE(n##2) ROVER_OPCODE(n##3)                  \
    ROVER_OPCODE(n##4) ROVER_OPCODE(n##5) ROVER_OPCODE(n##6) ROVER_OPCODE(n##7)                  \
    ROVER_OPCODE(n##8) ROVER_OPCODE(n##9) ROVER_OPCODE(n##A) ROVER_OPCODE(n##B)                  \
    ROVER_OPCODE(n##C) ROVER_OPCODE(n##D) ROVER_OPCODE(n##E) ROVER_OPCODE(n##F)
#define ROVER_LABELS(n)                                                                          \
    &&opcode_##n##0, &&opcode_##n##1, &&opcode_##n##2, &&opcode_##n##3,                          \
    &&opcode_##n##4, &&opcode_##n##5, &&opcode_##n##6, &&opcode_##n##7,                          \
    &&opcode_##n##8, &&opcode_##n##9, &&opcode_##n##A, &&opcode_##n##B,                          \
    &&opcode_##n##C, &&opcode_##n##D, &&opcode_##n##E, &&opcode_##n##F
// clang-format on

namespace host_sim {

namespace {

using Handlers = std::array<const void*, 256>;

Handlers without_undocumented(Handlers handlers, const void* left_to_host) {
    for (const unsigned opcode :
         {0x08U, 0x10U, 0x18U, 0x28U, 0x38U, 0xCBU, 0xD9U, 0xDDU, 0xEDU, 0xFDU}) {
        handlers[opcode] = left_to_host;
    }
    return handlers;
}

}  // namespace

// tidy-allow(function-length): one line per opcode row, and all share the same locals
void run_fast(CpuState& cpu, FlatMemory& memory, FastHost& host, InstructionSet set) {
    // clang-format off
    static const Handlers kAll = {
        ROVER_LABELS(0), ROVER_LABELS(1), ROVER_LABELS(2), ROVER_LABELS(3),
        ROVER_LABELS(4), ROVER_LABELS(5), ROVER_LABELS(6), ROVER_LABELS(7),
        ROVER_LABELS(8), ROVER_LABELS(9), ROVER_LABELS(A), ROVER_LABELS(B),
        ROVER_LABELS(C), ROVER_LABELS(D), ROVER_LABELS(E), ROVER_LABELS(F)};
    static const Handlers kDocumented = without_undocumented(kAll, &&left_to_host);
    // clang-format on
    const void* const* const handlers =
        set == InstructionSet::all ? kAll.data() : kDocumented.data();
    const uint8_t* const bytes = memory.bytes.data();
    fast::Registers r;
    uint64_t run_t = 0;

start:
    if (cpu.t >= host.run_until_t()) return;
    run_t = host.run_until_t() - cpu.t;
    r.load(cpu, run_t);
    ROVER_NEXT

    // clang-format off
    ROVER_ROW(0) ROVER_ROW(1) ROVER_ROW(2) ROVER_ROW(3)
    ROVER_ROW(4) ROVER_ROW(5) ROVER_ROW(6) ROVER_ROW(7)
    ROVER_ROW(8) ROVER_ROW(9) ROVER_ROW(A) ROVER_ROW(B)
    ROVER_ROW(C) ROVER_ROW(D) ROVER_ROW(E) ROVER_ROW(F)
        // clang-format on

        left_to_host : r.pc = fast::word(r.pc - 1);
    r.store(cpu, run_t);
    if (!host.execute_exactly()) return;
    goto start;

time_is_up:
    r.store(cpu, run_t);
    goto start;
}

}  // namespace host_sim
