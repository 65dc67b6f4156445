// live_drive.cpp - see live_drive.hpp.
#include "host_sim/bind/live_drive.hpp"

#include <utility>

namespace host_sim {

LiveDrive::LiveDrive(LiveBoard& live, DriveOptions course)
    : live_(live), world_(std::move(course)) {
    Board& board = live_.board();
    const DriveStep first = world_.step({});  // stands until the controller has spoken
    pins_.set_levels(board, first.inputs);
    pins_.set_counts(first.inputs);
    step_t_ = next_tick_t(board) - hal::rb85::kTickCount + kStepT;
    queue_next();
}

void LiveDrive::queue_next() {
    live_.at(step_t_ - kInputLeadT, [this](Board& board) {
        const DriveStep driven = world_.step(commands_of(board));
        pins_.set_levels(board, driven.inputs);
        pins_.turn_wheels(board, driven.inputs);
        pins_.set_counts(driven.inputs);
        finished_ = world_.finished();
        step_t_ += kStepT;
        queue_next();
    });
}

}  // namespace host_sim
