// live_drive.hpp - the simulated vehicle around a live board: its sensors on the pins, its motors
// driven by them, step by step while the board runs.
// Depends on   host_sim/link/live_board.hpp, host_sim/world, board_pins.hpp.
// Same         inputs at the same T-states as in drive() with a BoardTarget: as long as nobody
// sends
//              to the board, the same course gives the same telemetry, bit for bit.
// Not modelled a restart's new phase: inputs keep changing at the times of the first run.
#pragma once

#include <atomic>
#include <cstdint>

#include "host_sim/bind/board_pins.hpp"
#include "host_sim/link/live_board.hpp"
#include "host_sim/world/drive.hpp"

namespace host_sim {

class LiveDrive {
public:
    /// Puts the first inputs on the board's pins and queues the others, for ever: behind the end of
    /// the course the vehicle stands.
    /// @param live  does not run; its board is about to begin its first step, its sensors
    /// unplugged,
    ///              as BoardTarget::begin() leaves it. Stop it before this object goes
    /// @errors      InputError: the course is out of its range
    LiveDrive(LiveBoard& live, DriveOptions course);
    LiveDrive(const LiveDrive&) = delete;
    LiveDrive& operator=(const LiveDrive&) = delete;

    /// The course is over. Any thread may ask.
    [[nodiscard]] bool finished() const { return finished_; }
    /// Why. @pre  the live board does not run
    [[nodiscard]] const Drive& world() const { return world_; }

private:
    void queue_next();

    LiveBoard& live_;
    Drive world_;
    InputPins pins_;
    uint64_t step_t_ = 0;  ///< T-state of the tick of the step whose inputs come next
    std::atomic<bool> finished_ = false;
};

}  // namespace host_sim
