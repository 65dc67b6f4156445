// board_pins.hpp - what crosses the simulated board's pins in a step: a row of inputs in, motor and
// laser commands out.
// Depends on   host_sim/board, hal/io.hpp.
// Design note  docs/design/targets.md
#pragma once

#include <array>
#include <cstdint>

#include "hal/board/rb85.hpp"
#include "hal/io.hpp"
#include "host_sim/board/board.hpp"

namespace host_sim {

inline constexpr uint64_t kTicksPerStep = 10;
/// T-states of a control step: 0.1 s.
inline constexpr uint64_t kStepT = kTicksPerStep * hal::rb85::kTickCount;
/// Inputs change so long before the step's tick, in T-states: the step finds them settled.
inline constexpr uint64_t kInputLeadT = 2000;

/// The T-state of the board's next tick, the rising edge of RST 7.5. @pre  the timer runs
[[nodiscard]] uint64_t next_tick_t(const Board& board);

/// Unplugs every channel of the converter: none gives an answer.
void unplug_sensors(Board& board);

/// Puts rows of inputs on the pins of a board whose sensors were unplugged, one after the other.
class InputPins {
public:
    InputPins() { sums_.fill(hal::kAdcAbsent); }
    /// What is there whenever the board looks: converter, presence, detectors, range scan.
    /// Potentiometers of steering and mast stay unplugged: a loop around a recorded angle would
    /// turn its motor for ever.
    void set_levels(Board& board, const hal::RawInputs& inputs);
    /// Pulses since the last set_counts(), also those of a wheel that is absent in the row: the
    /// counter goes where the row's does.
    void turn_wheels(Board& board, const hal::RawInputs& inputs) const;
    /// From here pulses are counted on: wheels stand where this row says.
    void set_counts(const hal::RawInputs& inputs);

private:
    std::array<uint16_t, hal::kAdcChannelCount> sums_{};  ///< as the channels are fed
    std::array<uint16_t, hal::kWheelCount> tach_count_{};
    bool range_seen_ = false;  ///< there has been a range scan
};

/// Motors and lasers as the board drives them now; without potentiometers the motors of steering
/// and mast are off and their angles 0, and one that runs shows as its duty. No telemetry.
/// @errors  std::range_error: the duty of a drive motor stands for no whole percentage
[[nodiscard]] hal::Commands commands_of(const Board& board);

}  // namespace host_sim
