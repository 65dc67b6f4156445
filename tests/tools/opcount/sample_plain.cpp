// sample_plain.cpp - the sample kernel with the machine's own integers.
#include "sample_kernel.hpp"

uint32_t sample_with_plain_words(int16_t a, int16_t b) {
    return rover::sample::everything(a, b);
}
