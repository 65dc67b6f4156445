/* A union passed by value was not copied: what the callee stored into it changed the caller's.
   Found by csmith, at -O0; reduced with tools/shrink. */
#include "csmith.h"

union U1 {
    uint32_t f0;
    uint64_t f1;
};
static union U1 g_8 = {0xD7C1188EL};

static int16_t func_2(int64_t p_3, union U1 p_4) {
    p_4.f1 = p_3;
    return (int16_t)p_4.f1;
}

int main(void) {
    platform_main_begin();
    crc32_gentab();
    func_2(0, g_8);
    transparent_crc(g_8.f0, "g_8.f0", 0);
    platform_main_end(crc32_context ^ 0xFFFFFFFFUL, 0);
    return 0;
}
