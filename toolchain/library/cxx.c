// cxx.c - what clang's C++ refers to by itself. Compiled with a program that does.
// Design note  there is no heap. A virtual destructor makes every table of virtual functions refer to
//              operator delete, called or not; it gets one that does nothing.

void _ZdlPv(void* object) {  // operator delete(void*)
    (void)object;
}

void _ZdlPvj(void* object, unsigned size) {  // operator delete(void*, size_t)
    (void)object;
    (void)size;
}

void __i85_hlt(void);

/// In the place of a virtual function that is only declared: nobody calls it but by mistake.
void __cxa_pure_virtual(void) {
    for (;;) __i85_hlt();
}
