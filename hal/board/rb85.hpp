// rb85.hpp - the board RB-85 as data: clock, memory map, ports, bits, interrupt lines.
// Depends on   nothing but fixed-width integers and the sensor channels of hal/io.hpp.
// Use          the one description: drivers (hal) and the simulated board (host_sim/board) read it,
//              docs/spec/board.md is its normative page.
#pragma once

#include <stdint.h>

#include "hal/io.hpp"

namespace hal::rb85 {

inline constexpr uint32_t kClockHz = 3'072'000;  ///< CLK OUT: half of the 6.144 MHz crystal

// -- Memory
// ------------------------------------------------------------------------------------------
inline constexpr uint16_t kEepromFirst = 0x0000;  ///< 28C256: program and tables
inline constexpr uint16_t kEepromLast = 0x7FFF;
inline constexpr uint16_t kRamFirst = 0x8000;  ///< 62256, battery-backed as a whole
inline constexpr uint16_t kRamLast = 0xFFFF;
inline constexpr uint16_t kCheckpointFirst = 0xFF00;  ///< left out of the RAM test

// -- Interrupt lines
// ---------------------------------------------------------------------------------
inline constexpr uint16_t kTrapVector = 0x0024;   ///< undervoltage or bumper
inline constexpr uint16_t kRst55Vector = 0x002C;  ///< 8251A TxRDY
inline constexpr uint16_t kRst65Vector = 0x0034;  ///< 8251A RxRDY
inline constexpr uint16_t kRst75Vector = 0x003C;  ///< timer A, OUT 0: the 100 Hz tick

// -- Port blocks
// ---------------------------------------------------------------------------------------
inline constexpr uint8_t kUsartData = 0x08;
inline constexpr uint8_t kUsartControl = 0x09;

inline constexpr uint8_t kTimerA = 0x10;     ///< 82C54: tick, baud rate, laser
inline constexpr uint8_t kTimerB = 0x14;     ///< 82C54: tachometers of wheels 0 to 2
inline constexpr uint8_t kTimerC = 0x18;     ///< 82C54: tachometers of wheels 3 to 5
inline constexpr uint8_t kTimerControl = 3;  ///< offset of the control word register

inline constexpr uint8_t kPpiA = 0x20;  ///< 82C55A: analog front end, outputs
inline constexpr uint8_t kPpiB = 0x24;  ///< 82C55A: range module, detectors
inline constexpr uint8_t kPpiPortA = 0;
inline constexpr uint8_t kPpiPortB = 1;
inline constexpr uint8_t kPpiPortC = 2;
inline constexpr uint8_t kPpiControl = 3;

inline constexpr uint8_t kAdc = 0x28;  ///< AD574A: A0 = address bit 0; write starts, read fetches

inline constexpr uint8_t kPresence = 0x2C;  ///< 74HC244: bit w, tachometer w is plugged in

inline constexpr uint8_t kMotorDrive = 0x30;      ///< 6 duty latches in hal::Wheel order
inline constexpr uint8_t kMotorSteer = 0x36;      ///< 4 duty latches
inline constexpr uint8_t kMotorDriveSign = 0x3A;  ///< bit w: wheel w backward
inline constexpr uint8_t kMotorSteerSign = 0x3B;  ///< bit s: steering motor s to the right

// -- Timer A: counters and their clocks
// ------------------------------------------------------------------
inline constexpr uint8_t kTickCounter = 0;   ///< clock CLK OUT, gate high
inline constexpr uint8_t kBaudCounter = 1;   ///< clock CLK OUT, gate high; OUT to TxC and RxC
inline constexpr uint8_t kLaserCounter = 2;  ///< clock CLK OUT, gate: any laser fires
inline constexpr uint16_t kTickHz = 100;
inline constexpr uint16_t kTickCount = 30720;  ///< mode 2
inline constexpr uint8_t kBaudCount = 10;      ///< mode 3; with the 8251A's x16: 19,200 baud
static_assert(kClockHz / kTickCount == kTickHz && kClockHz % kTickCount == 0);
static_assert(kClockHz / 16 / kBaudCount == 19200 && kClockHz % (16UL * kBaudCount) == 0);

// -- 82C55A A: port A out, port B in, port C out (until it drives a pin, the pin's load is off)
// ------------------------------------------------------------
inline constexpr uint8_t kPpiAMode = 0x82;
inline constexpr uint8_t kMuxAddressMask = 0x0F;   ///< port A
inline constexpr uint8_t kTachForwardMask = 0x3F;  ///< port B: bit w, wheel w turns forward
inline constexpr uint8_t kAdcBusyBit = 0x40;       ///< port B: STS of the AD574A
inline constexpr uint8_t kTrapCauseBit = 0x80;     ///< port B: 1 undervoltage, 0 bumper or none
inline constexpr uint8_t kLaserMask = 0x0F;        ///< port C: bit i fires laser i
inline constexpr uint8_t kSolenoidMask = 0x30;     ///< port C: two solenoids
inline constexpr uint8_t kMastOnBit = 0x40;        ///< port C
inline constexpr uint8_t kMastLeftBit = 0x80;      ///< port C: direction

// -- 82C55A B: port A in, port B in, port C low in, high out
// ------------------------------------------------
inline constexpr uint8_t kPpiBMode = 0x93;        ///< port A: range data; port B: detector bits
inline constexpr uint8_t kRangeAckBit = 0x01;     ///< port C
inline constexpr uint8_t kRangeStrobeBit = 0x10;  ///< port C
inline constexpr uint8_t kRangeSelectBit = 0x20;  ///< port C
inline constexpr uint8_t kTrapGateBit = 0x40;     ///< port C: 1 lets TRAP through

// -- Analog inputs: multiplexer input n is hal::AdcChannel n
// ------------------------------------------------
inline constexpr uint8_t kMuxInputCount = 16;  ///< the last two are at 0 V
inline constexpr uint8_t kMuxZero = 14;
static_assert(kAdcChannelCount <= kMuxZero);

// -- Watchdog
// -----------------------------------------------------------------------------------------------
inline constexpr uint16_t kWatchdogMs = 500;  ///< without an edge of SOD: motors off, reset

}  // namespace hal::rb85
