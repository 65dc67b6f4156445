// i85.h - the 8085 for C and C++: ports, interrupt masks, interrupt functions, loop bounds.
// Found by     i85cc, without -I.      Depends on   <stdint.h>.      Guide  docs/guides/compiling.md
// Each function below is one instruction. The compiler moves no access to memory across it.
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/// IN port. The port is a part of the instruction: it has to be a constant.
uint8_t __i85_in(uint8_t port);
/// OUT port.
void __i85_out(uint8_t port, uint8_t value);

/// RIM: bits 2-0 masks of RST 7.5, 6.5, 5.5; bit 3 interrupts enabled; bits 6-4 RST 7.5, 6.5, 5.5
/// are pending; bit 7 SID.
uint8_t __i85_rim(void);
/// SIM: bits 2-0 masks of RST 7.5, 6.5, 5.5 if bit 3 is 1; bit 4 takes back a pending RST 7.5; bit 7
/// goes to SOD if bit 6 is 1.
void __i85_sim(uint8_t value);

/// EI: takes effect behind the next instruction.
void __i85_ei(void);
/// DI.
void __i85_di(void);
/// HLT: sleeps until an interrupt.
void __i85_hlt(void);
/// NOP.
void __i85_nop(void);

/// Not an instruction: tells how often at most the innermost loop around the call runs each time it
/// is entered. `count` has to be a constant.
void __i85_loop_bound(uint16_t count);

#ifdef __cplusplus
}
#endif

/// Where interrupts enter, for I85_INTERRUPT. RST n is entered by the instruction that a device
/// gives for INTR, or by an RST in the program.
enum {
    I85_RST_1 = 0x08,
    I85_RST_2 = 0x10,
    I85_RST_3 = 0x18,
    I85_RST_4 = 0x20,
    I85_TRAP = 0x24,
    I85_RST_5 = 0x28,
    I85_RST_55 = 0x2C,
    I85_RST_6 = 0x30,
    I85_RST_65 = 0x34,
    I85_RST_7 = 0x38,
    I85_RST_75 = 0x3C
};

/// In front of a function without parameters that gives nothing back: it serves that interrupt. It
/// saves what it changes, and enables interrupts at its end.
///     I85_INTERRUPT(I85_RST_75) void tick(void) { ... }
#define I85_INTERRUPT(vector) __attribute__((interrupt(0 + (vector))))

/// As a statement in a loop:  for (...) { I85_LOOP_BOUND(16); ... }
#define I85_LOOP_BOUND(count) __i85_loop_bound(count)
