// i8251a.hpp - driver of the 8251A USART: asynchronous, 8 data bits, no parity, 1 stop bit, x16.
// Source       Intel 8251A data sheet (205222).
// Depends on   nothing. Bus: docs/design/hal.md
// Not here     waiting and buffers: firmware/link serves RxRDY and TxRDY from interrupts.
// Page         docs/chips/i8251a.md
#pragma once

#include <stdint.h>

namespace hal {

/// @tparam kPort  data register; the control register is the next port
template <class Bus, uint8_t kPort>
struct I8251a {
    static constexpr uint8_t kControl = kPort + 1;

    // Status read format. The three errors stay until acknowledge_errors().
    static constexpr uint8_t kTxReady = 0x01;
    static constexpr uint8_t kRxReady = 0x02;
    static constexpr uint8_t kTxEmpty = 0x04;
    static constexpr uint8_t kParityError = 0x08;
    static constexpr uint8_t kOverrunError = 0x10;  ///< a character was lost: not read in time
    static constexpr uint8_t kFramingError = 0x20;
    static constexpr uint8_t kBreak = 0x40;
    static constexpr uint8_t kErrors = kParityError | kOverrunError | kFramingError;

    static constexpr uint8_t kMode8N1x16 = 0x4E;     ///< mode instruction format, asynchronous
    static constexpr uint8_t kInternalReset = 0x40;  ///< command instruction format, IR
    static constexpr uint8_t kRun = 0x37;            ///< TxEN, DTR, RxE, ER, RTS

    /// Leaves the part ready to send and receive, whatever it did before: in any state three zeros
    /// are a mode with two sync characters or commands without effect, and then IR is a command.
    /// A character under way is cut off. Between two writes there is a read of the status, so that
    /// they are 20 T apart: recovery time is 6 t_CY in initialisation, 8 in asynchronous and 16 in
    /// synchronous mode, which the part may still be in.
    /// @ref  "Programming the 8251A"; A.C. characteristics, t_RV
    static void reset() {
        for (uint8_t zeros = 3; zeros != 0; --zeros) command(0x00);
        command(kInternalReset);
        command(kMode8N1x16);
        command(kRun);
    }

    static uint8_t status() { return Bus::template in<kControl>(); }

    /// The received character; valid with kRxReady. Takes kRxReady back.
    static uint8_t read() { return Bus::template in<kPort>(); }

    /// Sends a character. @pre kTxReady, or the character before is lost
    static void write(uint8_t value) { Bus::template out<kPort>(value); }

    /// Takes back the three errors and nothing else.
    static void acknowledge_errors() { Bus::template out<kControl>(kRun); }

private:
    static void command(uint8_t value) {
        Bus::template out<kControl>(value);
        Bus::template in<kControl>();
    }
};

}  // namespace hal
