/* csmith.h - what programs made by csmith include: checked arithmetic and a checksum.
 *
 * Replaces     csmith's own header (Debian's package has none), without printf and start-up code.
 * Result       rover_checksum, valid when rover_done is 1.
 * Semantics    an operation that C leaves undefined gives its left operand. Types are as wide as their
 *              names say; int has 16 bits, so nothing here may rely on promotion to more.
 * Locating     -DROVER_ONLY=n: the n-th value that goes into the checksum, instead of the checksum.
 * Variety      ROVER_SAFE: what stands before the arithmetic functions, e.g. noinline.
 */
#ifndef ROVER_CSMITH_H
#define ROVER_CSMITH_H

#include <limits.h>
#include <stddef.h>
#include <stdint.h>

#ifndef ROVER_SAFE
#define ROVER_SAFE static
#endif

__attribute__((used)) volatile uint32_t rover_checksum;
__attribute__((used)) volatile uint8_t rover_done;

/* -- Checked arithmetic; T has `bits` bits. ------------------------------------------------------ */
#define ROVER_SHIFTS_BY(T, suffix, bits, max, negative, count_type, count_suffix)                   \
    ROVER_SAFE T safe_lshift_func_##T##_##suffix##_##count_suffix(T left, count_type right) {       \
        return (negative || (int)right < 0 || (int)right >= bits || left > (max >> (int)right))     \
                   ? left                                                                           \
                   : (T)(left << (int)right);                                                       \
    }                                                                                               \
    ROVER_SAFE T safe_rshift_func_##T##_##suffix##_##count_suffix(T left, count_type right) {       \
        return (negative || (int)right < 0 || (int)right >= bits) ? left                            \
                                                                  : (T)(left >> (int)right);        \
    }

#define ROVER_SIGNED(T, bits, min, max)                                                             \
    ROVER_SAFE T safe_unary_minus_func_##T##_s(T value) { return value == min ? value : (T)-value; } \
    ROVER_SAFE T safe_add_func_##T##_s_s(T left, T right) {                                         \
        return ((right > 0 && left > max - right) || (right < 0 && left < min - right))             \
                   ? left                                                                           \
                   : (T)(left + right);                                                             \
    }                                                                                               \
    ROVER_SAFE T safe_sub_func_##T##_s_s(T left, T right) {                                         \
        return ((right < 0 && left > max + right) || (right > 0 && left < min + right))             \
                   ? left                                                                           \
                   : (T)(left - right);                                                             \
    }                                                                                               \
    ROVER_SAFE T safe_mul_func_##T##_s_s(T left, T right) {                                         \
        return ((left > 0 && right > 0 && left > max / right) ||                                    \
                (left > 0 && right <= 0 && right < min / left) ||                                   \
                (left <= 0 && right > 0 && left < min / right) ||                                   \
                (left < 0 && right <= 0 && right < max / left))                                     \
                   ? left                                                                           \
                   : (T)(left * right);                                                             \
    }                                                                                               \
    ROVER_SAFE T safe_div_func_##T##_s_s(T left, T right) {                                         \
        return (right == 0 || (left == min && right == -1)) ? left : (T)(left / right);             \
    }                                                                                               \
    ROVER_SAFE T safe_mod_func_##T##_s_s(T left, T right) {                                         \
        return (right == 0 || (left == min && right == -1)) ? left : (T)(left % right);             \
    }                                                                                               \
    ROVER_SHIFTS_BY(T, s, bits, max, left < 0, int, s)                                              \
    ROVER_SHIFTS_BY(T, s, bits, max, left < 0, unsigned int, u)

/* 1U: without it a product of two uint8_t could leave the range of int. */
#define ROVER_UNSIGNED(T, bits, max)                                                                \
    ROVER_SAFE T safe_unary_minus_func_##T##_u(T value) { return (T)(0U - value); }                 \
    ROVER_SAFE T safe_add_func_##T##_u_u(T left, T right) { return (T)(left + right); }             \
    ROVER_SAFE T safe_sub_func_##T##_u_u(T left, T right) { return (T)(left - right); }             \
    ROVER_SAFE T safe_mul_func_##T##_u_u(T left, T right) { return (T)(1U * left * right); }        \
    ROVER_SAFE T safe_div_func_##T##_u_u(T left, T right) {                                         \
        return right == 0 ? left : (T)(left / right);                                               \
    }                                                                                               \
    ROVER_SAFE T safe_mod_func_##T##_u_u(T left, T right) {                                         \
        return right == 0 ? left : (T)(left % right);                                               \
    }                                                                                               \
    ROVER_SHIFTS_BY(T, u, bits, max, 0, int, s)                                                     \
    ROVER_SHIFTS_BY(T, u, bits, max, 0, unsigned int, u)

ROVER_SIGNED(int8_t, 8, INT8_MIN, INT8_MAX)
ROVER_SIGNED(int16_t, 16, INT16_MIN, INT16_MAX)
ROVER_SIGNED(int32_t, 32, INT32_MIN, INT32_MAX)
ROVER_SIGNED(int64_t, 64, INT64_MIN, INT64_MAX)
ROVER_UNSIGNED(uint8_t, 8, UINT8_MAX)
ROVER_UNSIGNED(uint16_t, 16, UINT16_MAX)
ROVER_UNSIGNED(uint32_t, 32, UINT32_MAX)
ROVER_UNSIGNED(uint64_t, 64, UINT64_MAX)

/* -- Checksum: CRC-32 (reflected, 04C11DB7H), four bits at a time. ------------------------------- */
static uint32_t crc32_context = 0xFFFFFFFFUL;
static const uint32_t rover_crc_nibbles[16] = {
    0x00000000UL, 0x1DB71064UL, 0x3B6E20C8UL, 0x26D930ACUL, 0x76DC4190UL, 0x6B6B51F4UL,
    0x4DB26158UL, 0x5005713CUL, 0xEDB88320UL, 0xF00F9344UL, 0xD6D6A3E8UL, 0xCB61B38CUL,
    0x9B64C2B0UL, 0x86D3D2D4UL, 0xA00AE278UL, 0xBDBDF21CUL};

static void rover_crc_byte(uint8_t byte) {
    crc32_context ^= byte;
    crc32_context = rover_crc_nibbles[crc32_context & 15] ^ (crc32_context >> 4);
    crc32_context = rover_crc_nibbles[crc32_context & 15] ^ (crc32_context >> 4);
}

#ifdef ROVER_ONLY
static uint16_t rover_countdown = ROVER_ONLY;
#endif

static void transparent_crc(uint64_t value, const char* name, int flag) {
    uint8_t i;
    (void)name;
    (void)flag;
#ifdef ROVER_ONLY
    if (--rover_countdown == 0) {
        rover_checksum = (uint32_t)value ^ (uint32_t)(value >> 32);
        rover_done = 1;
    }
#endif
    for (i = 0; i < 8; ++i) {
        rover_crc_byte((uint8_t)value);
        value >>= 8;
    }
}

static void crc32_gentab(void) {}

/* A call of what the optimiser does not know: variables whose addresses are known outside (see
   rover_escape in generate.hpp) may have any value behind it. Without it whole programs are
   computed at compile time. */
#if defined(__I8085__) && defined(ROVER_OPAQUE)
void __i85_nop(void);
static void platform_main_begin(void) { __i85_nop(); }
#else
static void platform_main_begin(void) {}
#endif

static void platform_main_end(uint32_t checksum, int flag) {
    (void)flag;
    if (rover_done) return;
    rover_checksum = checksum;
    rover_done = 1;
}

#endif
