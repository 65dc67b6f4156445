// call_stack.cpp - see call_stack.hpp.
#include "tools/debug/call_stack.hpp"

namespace debug_console {

using host_sim::BoardState;
using host_sim::StepRecord;
using toolchain::isa::Flow;

namespace {

constexpr unsigned kWordsSearched = 64;
constexpr std::size_t kGuessesMax = 16;

Frame::Kind interrupt_kind(StepRecord::Kind kind) {
    switch (kind) {
        case StepRecord::Kind::trap:
            return Frame::Kind::trap;
        case StepRecord::Kind::rst75:
            return Frame::Kind::rst75;
        case StepRecord::Kind::rst65:
            return Frame::Kind::rst65;
        case StepRecord::Kind::rst55:
            return Frame::Kind::rst55;
        default:
            return Frame::Kind::intr;
    }
}

/// Whether a CALL stands before `return_to`, and which. RST is not tried: FFH is RST 7 and too
/// frequent in data.
bool guess_call(const BoardState& state, uint16_t return_to, Frame& frame) {
    constexpr uint16_t kCallBytes = 3;
    const auto byte = [&state](int address) {
        return state.memory.bytes[static_cast<uint16_t>(address)];
    };
    if (toolchain::isa::instruction(byte(return_to - kCallBytes)).flow != Flow::call) return false;
    frame.from = static_cast<uint16_t>(return_to - kCallBytes);
    frame.target = static_cast<uint16_t>(byte(return_to - 2) | byte(return_to - 1) << 8);
    frame.return_to = return_to;
    return true;
}

void search_memory(const BoardState& state, uint16_t from, std::vector<Frame>& list) {
    std::size_t guesses = 0;
    for (unsigned i = 0; i < kWordsSearched && guesses < kGuessesMax; ++i) {
        const unsigned slot = from + 2 * i;
        if (slot < state.map.ram_first || slot + 1 > state.map.ram_last) return;
        Frame frame;
        frame.guessed = true;
        frame.slot = static_cast<uint16_t>(slot);
        const auto word =
            static_cast<uint16_t>(state.memory.bytes[slot] | state.memory.bytes[slot + 1] << 8);
        if (!guess_call(state, word, frame)) continue;
        list.push_back(frame);
        ++guesses;
    }
}

}  // namespace

Flow flow_of(const StepRecord& record) {
    if (record.kind != StepRecord::Kind::instruction) return Flow::next;
    return toolchain::isa::instruction(record.opcode()).flow;
}

void CallStack::clear() {
    frames_.clear();
    complete_ = true;
}

void CallStack::forget() {
    frames_.clear();
    complete_ = false;
}

void CallStack::change(const StepRecord& record) {
    while (!frames_.empty() && above(record.next_sp, frames_.back().slot)) frames_.pop_back();
    const bool pushed = record.next_sp == static_cast<uint16_t>(record.sp - 2);
    const bool interrupt =
        record.kind != StepRecord::Kind::instruction && record.kind != StepRecord::Kind::halt;
    const Flow flow = flow_of(record);
    if (!pushed || !(interrupt || flow == Flow::call || flow == Flow::restart)) return;
    Frame frame;
    frame.kind = interrupt            ? interrupt_kind(record.kind)
                 : flow == Flow::call ? Frame::Kind::call
                                      : Frame::Kind::restart;
    const unsigned bytes = interrupt ? 0U : toolchain::isa::instruction(record.opcode()).bytes;
    frame.from = record.pc;
    frame.target = record.next_pc;
    frame.slot = record.next_sp;
    frame.return_to = static_cast<uint16_t>(record.pc + bytes);
    if (frames_.size() == kDepthMax) frames_.erase(frames_.begin());
    frames_.push_back(frame);
}

std::vector<Frame> CallStack::backtrace(const BoardState& state) const {
    std::vector<Frame> list(frames_.rbegin(), frames_.rend());
    if (!complete_) {
        const unsigned from = frames_.empty() ? state.cpu.sp : frames_.front().slot + 2U;
        search_memory(state, static_cast<uint16_t>(from), list);
    }
    return list;
}

}  // namespace debug_console
