// board_target.cpp - one step after the other on the board: when inputs change, when a step is
// over, what came out. Booting and restarts are in board_target_boot.cpp.
#include "host_sim/bind/board_target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "firmware/config/board_inputs.hpp"
#include "firmware/link/telemetry.hpp"
#include "hal/board/rb85.hpp"

namespace host_sim {

namespace rb85 = hal::rb85;

namespace {

constexpr uint64_t kTickT = rb85::kTickCount;
constexpr uint64_t kCharacterT = 1600;  // 10 bits of 160 T
/// Looks for the end of a step so often.
constexpr uint64_t kSliceT = 4096;
/// From a step's first instruction its tick is read in this time; acquisition takes longer.
constexpr uint64_t kTickReadT = 8000;
/// So long a step may take at all: the watchdog bites after 0.5 s.
constexpr uint64_t kHoldMaxT = 5 * kStepT;

}  // namespace

// -- Memory and time
// -----------------------------------------------------------------------------

uint16_t BoardTarget::word(uint16_t address) const {
    const auto& bytes = board_.state.memory.bytes;
    return static_cast<uint16_t>(bytes[address] | bytes[address + 1] << 8);
}

void BoardTarget::put_word(uint16_t address, uint16_t value) {
    board_.state.memory.bytes[address] = static_cast<uint8_t>(value & 0xFF);
    board_.state.memory.bytes[address + 1] = static_cast<uint8_t>(value >> 8);
}

void BoardTarget::fail(const std::string& what, const std::string& advice) const {
    const uint16_t pc = board_.state.cpu.pc;
    const std::string place = symbols_.describe(pc);
    throw BoardError(fmt::format(
        "{}: {}, at step {} of the log, {:.4f} s after power-up, PC {:04X}H{}{}; {}", name_, what,
        log_step_, static_cast<double>(board_.state.cpu.t) / rb85::kClockHz, pc,
        place.empty() ? "" : " in ", place,
        advice.empty() ? fmt::format("look at it with `rover85 debug {}`", name_) : advice));
}

void BoardTarget::run(uint64_t until_t) {
    const uint64_t resets = board_.state.reset_count;
    check(observer_ ? run_observed(until_t) : board_.run(until_t));
    if (!awaiting_reset_ && board_.state.reset_count != resets) {
        fail("the watchdog has reset the board",
             "find what kept the main loop from finishing its step");
    }
}

RunEnd BoardTarget::run_observed(uint64_t until_t) {
    while (board_.state.cpu.t < until_t) {
        const RunEnd end = step_once(until_t);
        if (end != RunEnd::time_limit) return end;
    }
    return RunEnd::time_limit;
}

RunEnd BoardTarget::step_once(uint64_t until_t) {
    const RunEnd end = board_.step(record_, until_t);
    if (observer_ && end == RunEnd::time_limit) observer_(record_, board_.state.cpu);
    return end;
}

/// Refuses an end that is not that of time.
void BoardTarget::check(RunEnd end) const {
    if (end == RunEnd::time_limit) return;
    if (end == RunEnd::halted) fail("the image halted with interrupts disabled");
    if (end == RunEnd::undefined_instruction) {
        fail("the image runs an instruction that the processor does not have");
    }
    static constexpr std::array<const char*, 5> kKinds = {
        "nothing", "a write where no memory is", "a write that the EEPROM ignores",
        "IN from a port that nobody answers", "OUT to a port that nobody answers"};
    const Violation& violation = board_.state.last_violation;
    fail(fmt::format("the image did {} ({:04X}H, by the instruction at {:04X}H {})",
                     kKinds[static_cast<std::size_t>(violation.kind)], violation.address,
                     violation.pc, symbols_.describe(violation.pc)));
}

uint64_t BoardTarget::tick_of_step_t(uint64_t step) const {
    return tick_zero_t_ + step * kStepT;
}

/// Up to the entry of the function in which a step reads its inputs.
void BoardTarget::run_to_acquire(uint64_t limit_t) {
    while (board_.state.cpu.pc != acquire_at_) {
        check(step_once(limit_t));
        if (board_.state.cpu.t >= limit_t) fail("the image does not begin its step");
    }
}

// -- Inputs
// --------------------------------------------------------------------------------------

void BoardTarget::send(const std::vector<uint8_t>& bytes) {
    uint64_t t = board_.state.cpu.t;
    for (const uint8_t byte : bytes) {
        board_.schedule({t, Stimulus::Kind::serial_byte, 0, byte});
        t += kCharacterT;
    }
}

/// Puts a tick of the log into the counter while the step reads it, at the entry of rover_acquire:
/// no handler is active there, and the next tick is far.
void BoardTarget::present_tick(uint16_t tick) {
    const uint16_t own = word(tick_count_at_);
    if (tick == own) return;
    ++counts_.ticks_written;
    put_word(tick_count_at_, tick);
    run(std::min(board_.state.cpu.t + kTickReadT, next_tick_t(board_) - kInputLeadT));
    put_word(tick_count_at_, own);
}

// -- The step
// ------------------------------------------------------------------------------------

void BoardTarget::step(std::vector<LogStep>& steps, std::size_t index) {
    LogStep& step = steps[index];
    log_step_ = index;
    step.estimates.reset();
    step.commands.reset();
    if (step.restart != Restart::none) restart(step.restart, steps);
    if (step_ == 0) {
        pins_.set_levels(board_, step.inputs);
        present_tick(step.inputs.tick_count);
    } else {
        const uint64_t tick_t = tick_of_step_t(step_);
        const uint64_t lead_t =
            kInputLeadT +
            (step.inputs.command_size == 0 ? 0 : kCharacterT * (step.inputs.command_size + 1U));
        run(tick_t - lead_t);
        pins_.set_levels(board_, step.inputs);
        pins_.turn_wheels(board_, step.inputs);
        send({step.inputs.command, step.inputs.command + step.inputs.command_size});
        const auto own = static_cast<uint16_t>(first_tick_ + kTicksPerStep * step_);
        if (step.inputs.tick_count != own) {
            run(tick_t);
            run_to_acquire(tick_t + kTickT);
            present_tick(step.inputs.tick_count);
        }
    }
    const uint64_t begin_t = tick_of_step_t(step_);
    await_end(begin_t);
    counts_.slowest_step_t = std::max(counts_.slowest_step_t, board_.state.cpu.t - begin_t);
    read_outputs(step);
    awaited_.push_back({index, static_cast<uint16_t>(step_)});
    pins_.set_counts(step.inputs);
    ++step_;
    ++counts_.steps;
    collect(&steps);
}

/// Until the step is counted.
void BoardTarget::await_end(uint64_t begin_t) {
    const bool holds = slow_step_ == SlowStep::hold;
    const uint64_t limit_t = begin_t + (holds ? kHoldMaxT : kStepT - kInputLeadT);
    const auto done = static_cast<uint16_t>(step_ + 1);
    while (word(step_count_at_) != done) {
        if (board_.state.cpu.t >= limit_t) {
            fail(holds ? "no end of the step" : "no end of the step within 0.1 s",
                 "measure the step with `rover85 budget`, or look at it with `rover85 debug`");
        }
        run(std::min(board_.state.cpu.t + kSliceT, limit_t));
        if (holds) hold_tick(step_ + 1);
    }
}

/// Keeps the tick of a step from coming, when it is the next one: the counter goes back by a whole
/// step, half-way between two ticks, where no handler is at it. What the image does every few
/// ticks stays where it is in the step.
void BoardTarget::hold_tick(uint64_t next_step) {
    if (board_.state.cpu.t + kTickT / 2 < tick_of_step_t(next_step)) return;
    put_word(tick_count_at_, static_cast<uint16_t>(word(tick_count_at_) - kTicksPerStep));
    tick_zero_t_ += kStepT;
    ++counts_.steps_held;
}

void BoardTarget::finish(std::vector<LogStep>& steps) {
    await_frames(steps, false);
}

/// Until the frames of all steps have come. @param hold  the next step does not begin meanwhile
void BoardTarget::await_frames(std::vector<LogStep>& steps, bool hold) {
    const uint64_t limit_t = board_.state.cpu.t + kStepT;
    collect(&steps);
    while (!awaited_.empty()) {
        if (board_.state.cpu.t >= limit_t) {
            fail(fmt::format("no telemetry frame of step {}", awaited_.front().index));
        }
        run(std::min(board_.state.cpu.t + kSliceT, limit_t));
        if (hold) hold_tick(step_);
        collect(&steps);
    }
}

// -- Outputs
// -------------------------------------------------------------------------------------

/// Motors and lasers as they are when the step is over.
void BoardTarget::read_outputs(LogStep& step) const {
    try {
        step.commands = commands_of(board_);
    } catch (const std::range_error& error) {
        fail(error.what());
    }
}

/// Takes what the transmitter has sent. @param steps  nullptr: telemetry belongs to no step
void BoardTarget::collect(std::vector<LogStep>* steps) {
    for (const auto& sent : board_.take_transmitted()) {
        auto frame = reader_.take(sent.byte, sent.end_t);
        if (!frame) continue;
        if (frame->kind() != DownlinkFrame::kTelemetry) {
            other_frames_.push_back(std::move(*frame));
        } else if (steps != nullptr) {
            take_telemetry(*frame, *steps);
        }
    }
}

void BoardTarget::take_telemetry(const DownlinkFrame& frame, std::vector<LogStep>& steps) {
    rover::Estimates estimates;
    const auto size = static_cast<uint8_t>(frame.bytes.size());
    if (!rover::read_telemetry(frame.bytes.data(), size, estimates)) {
        fail("a telemetry frame does not read");
    }
    if (awaited_.empty() || awaited_.front().step_count != estimates.step_count) {
        fail(awaited_.empty()
                 ? fmt::format("a telemetry frame of step count {} that no step has sent",
                               estimates.step_count)
                 : fmt::format("the telemetry frame of step count {} instead of {}",
                               estimates.step_count, awaited_.front().step_count));
    }
    LogStep& step = steps[awaited_.front().index];
    awaited_.pop_front();
    step.estimates = estimates;
    step.commands->telemetry_size = size;
    std::copy(frame.bytes.begin(), frame.bytes.end(), step.commands->telemetry);
    ++counts_.telemetry_frames;
}

BoardTarget::Counts BoardTarget::counts() const {
    Counts counts = counts_;
    counts.other_frames = other_frames_.size();
    counts.stray_bytes = reader_.stray_bytes();
    return counts;
}

Log drive_on_board(const std::filesystem::path& hex, Drive& world, LogHead head,
                   const DriveProgress& progress) {
    BoardTarget target(hex);
    return drive(target, world, std::move(head), progress);
}

void replay_on_board(const std::filesystem::path& hex, Log& log, const DriveProgress& progress) {
    BoardTarget target(hex);
    replay(target, log, progress);
}

}  // namespace host_sim
