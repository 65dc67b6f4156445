// stand_in.cpp - the smallest program with an identity block: the build's own rule makes an image
// of it, on which the tests of rule, stamp and flash work.
#include <i85.h>

#include "firmware/app/identity.hpp"

extern "C" {
extern const rover::Identity rover_identity;
const rover::Identity rover_identity = rover::kIdentity;
}

int main() {
    const volatile uint8_t* block = reinterpret_cast<const volatile uint8_t*>(&rover_identity);
    for (uint8_t i = 0; i < sizeof rover_identity; ++i) __i85_out(0x08, block[i]);
    return 0;
}
