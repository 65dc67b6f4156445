// probe_native.cpp - the probe on the host, where int has 32 bits.
#include <cstdio>

#include "probe.hpp"

static_assert(sizeof(int) == 4, "the native side of the comparison needs a 32 bit int");

void probe::report(const char* name, uint32_t checksum) {
    std::printf("probe %s %08x\n", name, checksum);
}

int main() {
    probe::run_groups();
    std::puts("probe end");
    return 0;
}
