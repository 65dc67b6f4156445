// string.c - the functions of string.h. Compiled with a program that uses one of them.
// Design note  __builtin_memcpy becomes a call of the runtime's __memcpy, with constant counts
//              perhaps less; behind the optimiser little else is left of memcpy.
#include <string.h>

void* memcpy(void* to, const void* from, size_t size) {
    __builtin_memcpy(to, from, size);
    return to;
}

void* memmove(void* to, const void* from, size_t size) {
    __builtin_memmove(to, from, size);
    return to;
}

void* memset(void* to, int value, size_t size) {
    __builtin_memset(to, value, size);
    return to;
}

int memcmp(const void* left, const void* right, size_t size) {
    const unsigned char* one = left;
    const unsigned char* other = right;
    for (; size != 0; --size, ++one, ++other) {
        if (*one != *other) return *one < *other ? -1 : 1;
    }
    return 0;
}

size_t strlen(const char* text) {
    const char* end = text;
    while (*end != 0) ++end;
    return (size_t)(end - text);
}
