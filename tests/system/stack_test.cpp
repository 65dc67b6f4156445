// stack_test.cpp - the deepest stack, provoked on the simulated board and measured in painted
// memory, against the bound from the image's code.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>

#include "host_sim/bind/board_target.hpp"
#include "host_sim/cpu/interrupts.hpp"
#include "host_sim/log/log_io.hpp"
#include "tests/system/program.hpp"
#include "tools/bounds/stack_bound.hpp"

namespace {

namespace fs = std::filesystem;
using host_sim::Board;
using host_sim::BoardState;
using host_sim::CpuState;
using host_sim::StepRecord;
using host_sim::Stimulus;
using rover_bounds::StackBound;

const fs::path kSource = ROVER_SOURCE_DIR;
const fs::path kImage = ROVER_IMAGE;
constexpr uint16_t kStackEnd = 0xFF00;  // the battery-backed area begins behind it
constexpr uint16_t kPaintedFirst = 0xFE00;
constexpr uint16_t kTrapFaults = 0xFF05;
constexpr uint64_t kCharacterT = 1600;  // ten bits at 19,200 a second

fs::path beside(const char* ending) {
    fs::path file = kImage;
    return file.replace_extension(ending);
}

struct Program {
    host_sim::Image image = host_sim::load_hex(kImage);
    host_sim::Symbols symbols = host_sim::load_symbols(beside(".sym"));
};

StackBound bound_of(const Program& program) {
    const auto map = rover_budget::parse_map(host_sim::read_image_file(beside(".map")), "map");
    const fs::path flow = kSource / "tests/budgets/flow.csv";
    return rover_bounds::stack_bound(rover_bounds::FlowProgram(
        program.image, program.symbols, map,
        rover_bounds::parse_flow(host_sim::read_image_file(flow), flow.string())));
}

const StackBound::Part& part(const StackBound& bound, const char* name) {
    for (const StackBound::Part& one : bound.parts) {
        if (one.name == name) return one;
    }
    throw std::out_of_range(name);
}

bool is_at(const CpuState& cpu, uint32_t depth) {
    return cpu.sp == kStackEnd - depth && cpu.interrupt_enable && !cpu.ei_shadow && !cpu.halted;
}

/// Flies a stored log and listens. @param heard  false: it is enough
void fly(const Program& program,
         const std::function<bool(const StepRecord&, const Board&)>& heard) {
    host_sim::Log log = host_sim::load_log(kSource / "tests/golden/replay/rough.rlog");
    host_sim::BoardTarget target(program.image, program.symbols);
    bool listening = false;
    target.observe([&](const StepRecord& step, const CpuState&) {
        if (listening) listening = heard(step, target.board());
    });
    target.begin(log.head.calibration);
    listening = true;
    for (std::size_t i = 0; i < log.steps.size() && listening; ++i) target.step(log.steps, i);
}

/// When the main line is first as deep as it can be while interrupts come through.
std::optional<uint64_t> deepest_main_t(const Program& program, uint32_t depth) {
    std::optional<uint64_t> found;
    std::optional<uint16_t> interrupted_sp;
    fly(program, [&](const StepRecord& step, const Board& board) {
        const CpuState& cpu = board.state.cpu;
        const bool accepted =
            step.kind != StepRecord::Kind::instruction && step.kind != StepRecord::Kind::halt;
        if (accepted && !interrupted_sp) interrupted_sp = step.sp;
        if (interrupted_sp && cpu.sp >= *interrupted_sp) interrupted_sp.reset();
        if (!interrupted_sp && is_at(cpu, depth)) found = cpu.t;
        return !found;
    });
    return found;
}

BoardState state_at(const Program& program, uint64_t t) {
    std::optional<BoardState> copy;
    fly(program, [&](const StepRecord&, const Board& board) {
        if (board.state.cpu.t >= t) copy = board.state;
        return !copy;
    });
    return copy.value();
}

/// Lowest byte of painted memory that has been written, as bytes below the stack's end.
uint32_t used_bytes(const Board& board, uint8_t paint) {
    uint16_t at = kPaintedFirst;
    while (board.state.memory.bytes[at] == paint) ++at;
    return kStackEnd - static_cast<uint32_t>(at);
}

/// One attempt: a tick when the main line is deepest, a character that is complete when the
/// tick is, a bumper when that character's handler is.
uint32_t provoke(const BoardState& before, uint32_t receive_depth, uint64_t main_t,
                 uint64_t character_t, uint8_t paint) {
    Board board;
    board.state = before;
    for (uint16_t at = kPaintedFirst; at < board.state.cpu.sp; ++at) {
        board.state.memory.bytes[at] = paint;
    }
    board.state.memory.bytes[kTrapFaults] = 1;  // an earlier TRAP: the tick turns motors off
    board.schedule({.t = character_t, .kind = Stimulus::Kind::serial_byte, .value = 0x55});
    StepRecord record;
    bool ticked = false, bumped = false;
    const uint64_t end = main_t + 20'000;
    while (board.state.cpu.t < end) {
        CpuState& cpu = board.state.cpu;
        if (!ticked && cpu.t >= main_t) {
            cpu.rst75_latch = true;
            cpu.rst75_latched_t = cpu.t - host_sim::kSampleLead;  // in time for this instruction
            ticked = true;
        }
        if (!bumped && cpu.sp == kStackEnd - receive_depth) {
            board.schedule({.t = cpu.t, .kind = Stimulus::Kind::bumper, .value = 1});
            bumped = true;
        }
        board.step(record, end);
    }
    return used_bytes(board, paint);
}

TEST(Stack, TheWorstNestingTakesWhatTheBoundSays) {
    const Program program;
    const StackBound bound = bound_of(program);
    const auto main_t = deepest_main_t(program, bound.parts[0].enabled);
    ASSERT_TRUE(main_t) << "the log does not reach the main line's deepest place";
    const BoardState before = state_at(program, *main_t - 2 * kCharacterT);
    const uint32_t receive_depth =
        bound.parts[0].enabled + part(bound, "RST 7.5").enabled + part(bound, "RST 6.5").disabled;
    uint32_t most = 0;
    // The tick is deepest somewhere in its run: a character ends at each of its T-states.
    for (uint64_t late = 0; late < 5000 && most < bound.with_interrupts; late += 2) {
        const uint64_t character_t = *main_t - kCharacterT + late;
        // What is pushed may have the value of the paint: two of them.
        for (const uint8_t paint : {uint8_t{0xA5}, uint8_t{0x5A}}) {
            const uint32_t used = provoke(before, receive_depth, *main_t, character_t, paint);
            ASSERT_LE(used, bound.with_interrupts);
            most = std::max(most, used);
        }
    }
    EXPECT_EQ(most, bound.with_interrupts);
}

}  // namespace
