// board.hpp - the simulated RB-85: loads an image, runs to a T-state, meets the outside world.
// Depends on   board_state.hpp, board_bus.hpp, host_sim/cpu, host_sim/image.
// Design note  docs/design/board.md; wiring docs/spec/board.md
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_sim/board/board_bus.hpp"
#include "host_sim/board/board_state.hpp"
#include "host_sim/cpu/fast.hpp"
#include "host_sim/cpu/flat_machine.hpp"
#include "host_sim/cpu/step_record.hpp"

namespace host_sim {

/// Settings of a simulated board.
struct BoardOptions {
    InstructionSet instruction_set = InstructionSet::all;
    MemoryMap memory_map;
    bool stop_at_violation = false;  ///< end a run behind the instruction that did it
    bool stop_at_halt = false;       ///< end a run in HALT with interrupts disabled
};

/// The board and its state. run(), run_reference() and step() agree on every state, bit for bit.
class Board final : private FastHost {
public:
    explicit Board(const BoardOptions& options);
    Board() : Board(BoardOptions{}) {}
    Board(const Board&) = delete;
    Board& operator=(const Board&) = delete;

    BoardState state;

    /// Puts bytes into the EEPROM as an outside programmer does.
    /// @errors std::length_error when they do not fit
    void program(std::span<const uint8_t> bytes, uint16_t address = 0);

    /// Runs to the first instruction boundary at or after `until_t`. HALT waits for interrupts as
    /// the part does.
    /// @return halted and violation only if the options ask for it
    RunEnd run(uint64_t until_t);
    /// The same on the plain reference interpreter.
    RunEnd run_reference(uint64_t until_t);

    /// One step, recorded: an instruction, an accepted interrupt, or HALT up to the next event (at
    /// most to `until_t`).
    RunEnd step(StepRecord& record, uint64_t until_t = chips::kNever);

    /// Presses RESET.
    void reset();
    /// Takes the supply away and gives it back: RAM (battery) and EEPROM keep their contents, what
    /// the EEPROM was programming is lost as the part loses it; everything else starts anew.
    void power_cycle();

    // -- The outside world
    // -------------------------------------------------------------------------
    /// Queues an event. One that lies in the past happens at once.
    void schedule(const Stimulus& stimulus);
    /// A scan of the range module, from now on.
    void set_range_scan(uint8_t present, const chips::RangeModule::Heights& heights_q1_mm);
    /// A recorded scan with its own counter; the one before again is no new scan.
    void replay_range_scan(uint8_t counter, uint8_t present,
                           const chips::RangeModule::Heights& heights_q1_mm);
    /// Plugs the range module in or out.
    void set_range_connected(bool connected);
    /// A recorded sum of 16 conversions, from now on; above hal::kAdcMaxQ4Count the channel gives
    /// no answer (chips::AnalogInput). @param channel  multiplexer input
    void replay_sensor(uint8_t channel, uint16_t sum_q4);
    /// A wheel turns by so many pulses, now: its direction input, then the pulses. The direction
    /// stays. @param pulses  negative: backward; 0 changes nothing
    void turn_wheel(uint8_t wheel, int32_t pulses);
    /// Characters that have left the USART since the last call.
    std::vector<chips::I8251a::TransmittedByte> take_transmitted();

private:
    template <bool kFast>
    RunEnd run_loop(uint64_t until_t);
    template <bool kFast>
    void run_some(uint64_t until_t);
    [[nodiscard]] uint64_t wake_t(uint64_t until_t) const;
    [[nodiscard]] bool stops_here() const;
    bool reset_if_pending();
    bool execute_exactly() override;
    [[nodiscard]] uint64_t run_until_t() const override;

    BoardOptions options_;
    BoardBus bus_{state};
    uint64_t until_t_ = 0;
    uint64_t violations_before_ = 0;
    bool undefined_ = false;
};

/// The converter's code for a sensor voltage is count / 4096 of its range above -5 V: the voltage
/// in the middle of code `count`.
[[nodiscard]] constexpr int32_t sensor_uv_of_count(uint16_t count) {
    return static_cast<int32_t>(int64_t{count} * 10'000'000 / 4096 - 5'000'000);
}

}  // namespace host_sim
