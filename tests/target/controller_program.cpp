// controller_program.cpp - the rover's control step as a program of its own for the 8085.
// Depends on   firmware/executive/controller.hpp; i85.h.
// Use          the mailbox is five variables in RAM. At every HLT whoever runs the program looks at
//              the results so far, fills `target_request` and what it needs, and lets it go on.
#include <i85.h>

#include "firmware/executive/controller.hpp"

static_assert(sizeof(int) == 2 && sizeof(void*) == 2, "this is a program for the 8085");

extern "C" {

volatile uint8_t target_request;  ///< 0: reset with `target_calibration`; else a step
hal::Calibration target_calibration;
hal::RawInputs target_inputs;
hal::Commands target_commands;
rover::Controller target_controller;

void target_reset() {
    rover::controller_reset(target_controller, target_calibration);
}

void target_step() {
    rover::controller_step(target_controller, target_inputs, target_commands);
}

int main() {
    for (;;) {
        __i85_hlt();
        if (target_request == 0) {
            target_reset();
        } else {
            target_step();
        }
    }
}
}
