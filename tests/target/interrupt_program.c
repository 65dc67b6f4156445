/* interrupt_program.c - a main program and four interrupt functions that use the same functions and
   runtime routines and share volatile counters.
   Depends on   i85.h.      Use   interrupt_test.cpp, which knows every result. */
#include <i85.h>

enum { KINDS = 4 };

volatile uint8_t ready;          /* main counts from here on */
volatile uint16_t served[KINDS]; /* TRAP, RST 7.5, 6.5, 5.5 */
volatile uint32_t sums[KINDS];
volatile uint8_t broken; /* critical sections that were none */
volatile uint32_t result;

/* Know where their caller's digits are: each copy of the caller has its own of these. */
static __attribute__((noinline)) void clear(uint8_t* digits) {
    digits[0] = 0;
    digits[5] = 0;
}
static __attribute__((noinline)) void split(uint8_t* digits, uint16_t rest) {
    clear(digits);
    for (uint8_t i = 0; i < 6; ++i) {
        I85_LOOP_BOUND(6);
        digits[i] = (uint8_t)(rest % 10U);
        rest /= 10U;
    }
}

/* Multiplication, division, shifts, memory of its own: everything that must not be shared. */
static __attribute__((noinline)) uint32_t mix(uint16_t a, uint16_t b) {
    uint8_t digits[6];
    uint32_t sum = 0;
    split(digits, (uint16_t)(a ^ b * 77U));
    for (uint8_t i = sizeof digits; i-- > 0;) {
        I85_LOOP_BOUND(6);
        sum = sum * 31U + (uint32_t)(digits[i] << (b & 7U));
    }
    return sum / (b | 1U) + sum % 1000U;
}

static void serve(uint8_t kind) {
    const uint16_t count = served[kind] + 1U;
    served[kind] = count;
    sums[kind] += mix(count, kind * 13U + 5U);
}

I85_INTERRUPT(I85_TRAP) void on_trap(void) {
    serve(0);
}
I85_INTERRUPT(I85_RST_75) void on_rst75(void) {
    serve(1);
}
I85_INTERRUPT(I85_RST_65) void on_rst65(void) {
    serve(2);
}
I85_INTERRUPT(I85_RST_55) void on_rst55(void) {
    serve(3);
}

int main(void) {
    uint32_t sum = 0;
    __i85_sim(0x08); /* no line masked */
    ready = 1;
    __i85_ei();
    for (uint8_t round = 0; round < 4; ++round) {
        sum = sum * 7U + mix((uint16_t)sum, round * 999U);
        __i85_di();
        const uint16_t before = served[1];
        sum += mix(round, 40U);
        if (served[1] != before) ++broken;
        __i85_ei();
    }
    result = sum;
    __i85_di();
    __i85_hlt();
    return 0;
}
