// string.h - blocks of memory for freestanding programs. Defined in toolchain/library/string.c.
// Found by     i85cc, without -I.
#pragma once

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

void* memcpy(void* to, const void* from, size_t size);
void* memmove(void* to, const void* from, size_t size);
void* memset(void* to, int value, size_t size);
int memcmp(const void* left, const void* right, size_t size);
size_t strlen(const char* text);

#ifdef __cplusplus
}
#endif
