// sim_bus.hpp - drivers compiled for the host on the chip models of the board, without a program.
// Depends on   host_sim/board, host_sim/cpu.
// Use          SimBoard board;  hal::Rb85Parts<host_sim::SimBus>::Usart::reset();
// Time         an access is the instruction, 10 T, and kWorkT for the code around it.
// Interrupts   the board's lines are real; what a handler does is a function of the host.
// Not modelled a reset in the middle of the host's code: `state.reset_pending` tells.
#pragma once

#include <cstdint>
#include <functional>

#include "host_sim/board/board_bus.hpp"
#include "host_sim/board/board_state.hpp"
#include "host_sim/cpu/interrupts.hpp"

namespace host_sim {

/// A board whose processor executes what SimBus is asked for. The one that was made last is it.
class SimBoard {
public:
    static constexpr uint64_t kWorkT = 10;

    SimBoard();
    ~SimBoard();
    SimBoard(const SimBoard&) = delete;
    SimBoard& operator=(const SimBoard&) = delete;
    [[nodiscard]] static SimBoard& current() { return *current_; }

    BoardState state;
    /// Called for each interrupt that is accepted, with interrupts disabled; they are enabled
    /// behind it. Without one, no interrupt is accepted.
    std::function<void(Interrupt)> handler;

    /// Time passes without an access.
    void elapse(uint64_t duration_t);
    /// Something happens outside, now.
    void apply(Stimulus::Kind kind, uint8_t index, int32_t value);

    /// One instruction with its operand byte; interrupts that wait come behind it.
    /// @return  A
    uint8_t execute(uint8_t opcode, uint8_t operand, uint8_t a);
    /// HLT, up to the next accepted interrupt.
    /// @errors  std::logic_error without a handler or without anything that can come
    void halt();

private:
    void one(uint8_t opcode, uint8_t operand, uint8_t a);
    bool accept();

    BoardBus bus_{state};
    SimBoard* before_ = nullptr;
    static SimBoard* current_;
};

/// The Bus of the drivers: what hal::I8085 is on the target.
struct SimBus {
    template <uint8_t kPort>
    static uint8_t in() {
        return SimBoard::current().execute(0xDB, kPort, 0);
    }
    template <uint8_t kPort>
    static void out(uint8_t value) {
        SimBoard::current().execute(0xD3, kPort, value);
    }
    static uint8_t rim() { return SimBoard::current().execute(0x20, 0, 0); }
    static void sim(uint8_t value) { SimBoard::current().execute(0x30, 0, value); }
    static void enable_interrupts() { SimBoard::current().execute(0xFB, 0, 0); }
    static void disable_interrupts() { SimBoard::current().execute(0xF3, 0, 0); }
    static void halt() { SimBoard::current().halt(); }
};

}  // namespace host_sim
