/* carry_program.c - sums and differences whose carries comparisons ask for; compiled for the 8085
 * and, as the oracle, for the host. Every value is a byte or a word by its type, so both mean the
 * same. Depends on   stdint.h.
 */
#include <stdint.h>

static uint32_t mix(uint32_t hash, uint16_t value) {
    return (uint32_t)((hash << 5) + hash) ^ value;
}

static uint16_t of_bytes(uint8_t a, uint8_t b) {
    const uint8_t sum = (uint8_t)(a + b);
    const uint8_t difference = (uint8_t)(a - b);
    uint16_t result = 0;
    if (sum < b) result |= 1;
    if (difference > a) result |= 2;
    if (a < b) result |= (uint16_t)(difference << 8);
    result = (uint16_t)(result + (sum < a ? 255 : sum));
    return (uint16_t)(result ^ (a < b ? 0 : difference));
}

static uint16_t of_constants(uint8_t a) {
    const uint8_t more = (uint8_t)(a + 200);
    const uint8_t less = (uint8_t)(a - 3);
    uint16_t result = a > 55 ? 255 : more;
    result = (uint16_t)(result * 3 + (a < 3 ? 0 : less));
    if (a >= 56) result ^= more;
    return result;
}

static uint16_t of_words(uint16_t a, uint16_t b) {
    const uint16_t sum = (uint16_t)(a + b);
    const uint16_t difference = (uint16_t)(a - b);
    const uint16_t more = (uint16_t)(a + 60000U);
    uint16_t result = sum < a ? 0xFFFF : sum;
    result = (uint16_t)(result + (a < b ? 0 : difference));
    result = (uint16_t)(result * 3 + (a >= 5536U ? 0xFFFF : more));
    return (uint16_t)(sum < b ? result + difference : result);
}

static uint16_t of_longs(uint32_t a, uint32_t b) {
    const uint32_t sum = a + b;
    const uint32_t difference = a - b;
    uint16_t result = (uint16_t)((sum < a ? 0xFFFFFFFFUL : sum) >> 13);
    return (uint16_t)(result + ((a < b ? 0 : difference) >> 7));
}

uint32_t carry_hash(void) {
    uint32_t hash = 5381;
    uint16_t word = 1;
    uint16_t other = 3;
    uint16_t count = 0;
    do {
        const uint8_t a = (uint8_t)count;
        const uint8_t b = (uint8_t)(count >> 8);
        hash = mix(hash, of_bytes(a, b));
        if (b == 0) hash = mix(hash, of_constants(a));
        if ((count & 15) == 0) {
            word = (uint16_t)(word * 25173U + 13849U);
            other = (uint16_t)(other * 4391U + word);
            hash = mix(hash, of_words(word, other));
            hash = mix(hash, of_longs(((uint32_t)word << 16) | count, ((uint32_t)other << 16) | b));
        }
    } while (++count != 0);
    return hash;
}
