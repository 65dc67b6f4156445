// sim_bus.cpp - see sim_bus.hpp.
#include "host_sim/bind/sim_bus.hpp"

#include <algorithm>
#include <stdexcept>

#include "host_sim/cpu/reference.hpp"

namespace host_sim {

namespace {

constexpr uint16_t kCode = hal::rb85::kRamFirst;  // where the instruction stands
constexpr uint16_t kStack = hal::rb85::kCheckpointFirst;
constexpr uint8_t kEi = 0xFB;
constexpr uint8_t kHlt = 0x76;
constexpr uint8_t kRet = 0xC9;

}  // namespace

SimBoard* SimBoard::current_ = nullptr;

SimBoard::SimBoard() : before_(current_) {
    current_ = this;
    bus_.reset(0);
    state.cpu.sp = kStack;
}

SimBoard::~SimBoard() {
    current_ = before_;
}

void SimBoard::elapse(uint64_t duration_t) {
    state.cpu.t += duration_t;
    bus_.advance(state.cpu.t);
}

void SimBoard::apply(Stimulus::Kind kind, uint8_t index, int32_t value) {
    bus_.advance(state.cpu.t);
    bus_.apply({state.cpu.t, kind, index, value});
}

void SimBoard::one(uint8_t opcode, uint8_t operand, uint8_t a) {
    state.memory.bytes[kCode] = opcode;
    state.memory.bytes[kCode + 1] = operand;
    state.cpu.pc = kCode;
    state.cpu.a = a;
    Reference<BoardBus>(state.cpu, bus_).execute();
}

bool SimBoard::accept() {
    if (!handler) return false;
    bus_.advance(state.cpu.t);
    const Interrupt interrupt = pending_interrupt(state.cpu);
    if (interrupt == Interrupt::none) return false;
    Reference<BoardBus>(state.cpu, bus_).accept(interrupt);
    handler(interrupt);
    one(kEi, 0, 0);
    one(kRet, 0, 0);
    return true;
}

uint8_t SimBoard::execute(uint8_t opcode, uint8_t operand, uint8_t a) {
    one(opcode, operand, a);
    const uint8_t result = state.cpu.a;
    while (accept()) {
    }
    const bool accesses = opcode == 0xDB || opcode == 0xD3;
    if (accesses) elapse(kWorkT);
    return result;
}

void SimBoard::halt() {
    if (!handler) throw std::logic_error("HLT without a handler never ends");
    one(kHlt, 0, 0);
    while (!accept()) {
        if (state.event_t == chips::kNever) throw std::logic_error("HLT without an event");
        state.cpu.t =
            pins_settled(state.cpu) ? std::max(state.event_t, state.cpu.t + 1) : state.cpu.t + 1;
        bus_.advance(state.cpu.t);
    }
    while (accept()) {
    }
}

}  // namespace host_sim
