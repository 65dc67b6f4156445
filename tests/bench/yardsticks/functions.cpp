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
[[gnu::noinline]] void square_root() {
    yardstick::square_root(cells);
}
[[gnu::noinline]] void arctangent() {
    yardstick::arctangent(cells);
}
}

int main() {
    wss_search();
    ring_update();
    square_root();
    arctangent();
    return 0;
}
