// board_target.hpp - the image on the simulated board: the controller's other target.
// Depends on   host_sim/board, host_sim/image; board_pins.hpp, link_frames.hpp.
// Contract     what comes out is what the board sends on its pins: telemetry frames, motor latches,
//              lasers. From its memory only rover_tick_count and rover_step_count are read, for
//              timing.
// Beyond a rover's means: where a log's ticks are not those that the board counts, the harness puts
//              the log's tick there while the step reads it. See the design note.
// Design note  docs/design/targets.md
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "host_sim/bind/board_pins.hpp"
#include "host_sim/bind/controller_target.hpp"
#include "host_sim/bind/link_frames.hpp"
#include "host_sim/board/board.hpp"
#include "host_sim/image/image.hpp"
#include "host_sim/image/symbols.hpp"

namespace host_sim {

/// The image did what it must not: it stopped answering, was late, or did something that the board
/// reports as a violation. One line: when, where, what, what to do.
class BoardError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// What happens when a step takes more than 0.1 s.
enum class SlowStep : uint8_t {
    fail,  ///< BoardError
    hold,  ///< the tick stands still until the step is over; counted
};

class BoardTarget final : public ControllerTarget {
public:
    /// @param symbols  of the image: rover_tick_count, rover_step_count and the function
    ///                 rover_acquire, at whose entry a step begins to read its inputs
    /// @errors  ImageError: does not fit the board, or lacks a symbol
    BoardTarget(const Image& image, Symbols symbols, SlowStep slow_step = SlowStep::fail);
    /// @param hex  Intel HEX; its symbols are in the .sym beside it. @errors ImageError
    explicit BoardTarget(const std::filesystem::path& hex, SlowStep slow_step = SlowStep::fail);

    /// Power-up, calibration record and identity over the link, cold restart over the link, up to
    /// the first step. @errors BoardError, also from all below
    void begin(const hal::Calibration& calibration) override;
    [[nodiscard]] std::string identity() const override { return identity_; }
    void step(std::vector<LogStep>& steps, std::size_t index) override;
    void finish(std::vector<LogStep>& steps) override;

    /// What the run has seen since begin().
    struct Counts {
        uint64_t steps = 0;
        uint64_t telemetry_frames = 0;
        uint64_t other_frames = 0;    ///< kept in other_frames()
        uint64_t stray_bytes = 0;     ///< in no frame
        uint64_t steps_held = 0;      ///< by SlowStep::hold, and before restarts
        uint64_t ticks_written = 0;   ///< steps whose tick the harness put there
        uint64_t slowest_step_t = 0;  ///< from a step's tick to its end, T-states
    };
    [[nodiscard]] Counts counts() const;
    /// Frames that are no telemetry, as they came.
    [[nodiscard]] const std::vector<DownlinkFrame>& other_frames() const { return other_frames_; }
    [[nodiscard]] const Board& board() const { return board_; }

    /// Hears of every step of the processor from now on, with its state behind it: for profiles.
    /// Nothing that the board does changes by it, but it runs about fifteen times slower.
    using StepObserver = std::function<void(const StepRecord&, const CpuState&)>;
    void observe(StepObserver observer) { observer_ = std::move(observer); }

private:
    struct Awaited {
        std::size_t index;    ///< of the step in the log
        uint16_t step_count;  ///< that its frame carries
    };

    [[nodiscard]] uint16_t word(uint16_t address) const;
    void put_word(uint16_t address, uint16_t value);
    [[noreturn]] void fail(const std::string& what, const std::string& advice = {}) const;

    void run(uint64_t until_t);
    RunEnd run_observed(uint64_t until_t);
    RunEnd step_once(uint64_t until_t);
    void check(RunEnd end) const;
    void run_to_acquire(uint64_t limit_t);
    void run_to_first_step();
    [[nodiscard]] uint64_t tick_of_step_t(uint64_t step) const;

    void send(const std::vector<uint8_t>& bytes);
    [[nodiscard]] DownlinkFrame ask(UplinkType type, const std::vector<uint8_t>& payload,
                                    uint8_t answer);
    void switch_on();
    void load_calibration(const hal::Calibration& calibration);
    void restart(Restart kind, std::vector<LogStep>& steps);
    void restart_cold();
    void begin_steps();

    void present_tick(uint16_t tick);
    void read_outputs(LogStep& step) const;
    void collect(std::vector<LogStep>* steps);
    void take_telemetry(const DownlinkFrame& frame, std::vector<LogStep>& steps);
    void await_frames(std::vector<LogStep>& steps, bool hold);
    void await_end(uint64_t begin_t);
    void hold_tick(uint64_t next_step);

    StepObserver observer_;
    StepRecord record_;  ///< of the last step; kept, because clearing it takes as long as the step
    SlowStep slow_step_;
    std::string name_;  ///< of the image's file
    Symbols symbols_;
    uint16_t tick_count_at_ = 0;
    uint16_t step_count_at_ = 0;
    uint16_t acquire_at_ = 0;
    Board board_;
    std::optional<BoardState> switched_on_;  ///< the image has booted and told its identity
    std::string identity_;

    DownlinkReader reader_;
    std::deque<Awaited> awaited_;
    std::vector<DownlinkFrame> other_frames_;
    Counts counts_;
    uint64_t log_step_ = 0;     ///< steps of the log since begin()
    uint64_t step_ = 0;         ///< steps since the last restart
    uint64_t tick_zero_t_ = 0;  ///< T-state of the tick at which step 0 was due
    uint16_t first_tick_ = 0;   ///< tick count of step 0
    InputPins pins_;
    bool awaiting_reset_ = false;  ///< a watchdog reset is what was asked for
};

/// drive() and replay() on the image.
Log drive_on_board(const std::filesystem::path& hex, Drive& world, LogHead head,
                   const DriveProgress& progress = {});
void replay_on_board(const std::filesystem::path& hex, Log& log,
                     const DriveProgress& progress = {});

}  // namespace host_sim
