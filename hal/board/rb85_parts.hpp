// rb85_parts.hpp - the drivers of RB-85: every part bound to its ports, for a Bus.
// Depends on   hal/board/rb85.hpp, hal/chips.
// Use          using Parts = hal::Rb85Parts<hal::I8085>;  Parts::Usart::reset();
// Design note  docs/design/hal.md
#pragma once

#include "hal/board/rb85.hpp"
#include "hal/chips/ad574a.hpp"
#include "hal/chips/analog_inputs.hpp"
#include "hal/chips/i8251a.hpp"
#include "hal/chips/i82c54.hpp"
#include "hal/chips/i82c55a.hpp"
#include "hal/chips/motor_latch.hpp"
#include "hal/chips/presence_buffer.hpp"
#include "hal/chips/range_module.hpp"
#include "hal/chips/sod_watchdog.hpp"

namespace hal {

template <class Bus>
struct Rb85Parts {
    using Usart = I8251a<Bus, rb85::kUsartData>;
    using TimerA = I82c54<Bus, rb85::kTimerA>;
    using TimerB = I82c54<Bus, rb85::kTimerB>;
    using TimerC = I82c54<Bus, rb85::kTimerC>;
    using PpiA = I82c55a<Bus, rb85::kPpiA>;
    using PpiB = I82c55a<Bus, rb85::kPpiB>;
    using Adc = Ad574a<Bus, rb85::kAdc, rb85::kPpiA + rb85::kPpiPortB, rb85::kAdcBusyBit>;
    using AnalogInputs = hal::AnalogInputs<Adc, PpiA>;
    using Motors = MotorLatch<Bus, rb85::kMotorDrive>;
    using Range = RangeModule<PpiB, rb85::kRangeAckBit, rb85::kRangeStrobeBit,
                              rb85::kRangeSelectBit, rb85::kTrapGateBit>;
    using Watchdog = SodWatchdog<Bus>;
    using Presence = PresenceBuffer<Bus, rb85::kPresence>;

    static_assert(Usart::kControl == rb85::kUsartControl);
    static_assert(Motors::kSteer == rb85::kMotorSteer);
    static_assert(Motors::kDriveSign == rb85::kMotorDriveSign);
    static_assert(Motors::kSteerSign == rb85::kMotorSteerSign);
};

}  // namespace hal
