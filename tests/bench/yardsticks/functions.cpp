// functions.cpp - what i85cc compiles of functions.hpp; see yardstick_test.cpp.
#include "tests/bench/yardsticks/functions.hpp"

extern "C" {
alignas(64) yardstick::Cells cells;

[[gnu::noinline]] void wss_search() {
    yardstick::wss_search(cells);
}
[[gnu::noinline]] void ring_update() {
    yardstick::ring_update(cells);
}
}

int main() {
    wss_search();
    ring_update();
    return 0;
}
