// servo_loops.hpp - holds four steering motors and the mast at the angles of the commands.
// Depends on   hal/board/rb85.hpp, hal/io.hpp, core/arith.hpp; parts as a template argument.
// Code         upper 8 bits of a conversion: 64 brad (0.35 degrees) each, 128 straight ahead, more
//              to the left.
// Nominal      no calibration record has these potentiometers: +-45 degrees over the converter's
//              range.
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/servo_loops_test.cpp
#pragma once

#include "firmware/config/servo_tuning.hpp"
#include "firmware/core/arith.hpp"
#include "hal/board/rb85.hpp"
#include "hal/io.hpp"

namespace rover {

inline constexpr uint8_t kFirstServo = static_cast<uint8_t>(hal::AdcChannel::steer_front_left);
inline constexpr uint8_t kMastServo = static_cast<uint8_t>(hal::AdcChannel::mast);

/// The tick's alone. Zeroed is right to begin with.
struct ServoLoops {
    uint8_t duty[hal::kSteerCount];  ///< of 255, as in the latches
    uint8_t right;                   ///< bit s: steering motor s turns right
};

/// Code of an angle, at most kServoReachQ8Turn off.
constexpr uint8_t servo_code(int16_t angle_brad) {
    const auto bits = narrow_wrap_u16(angle_brad);
    const uint8_t upper = narrow_wrap_u8(shift_floor<8>(bits));
    if (add_wrap(upper, kServoReachQ8Turn) >= 2 * kServoReachQ8Turn) {
        return upper < 128 ? 127 + 4 * kServoReachQ8Turn : 128 - 4 * kServoReachQ8Turn;
    }
    return bit_xor(narrow_wrap_u8(shift_floor<8>(shift_left_wrap<2>(bits))), uint8_t{128});
}

/// Duty of 255 towards `wanted`. 0 where that is reached, and at the ends of the range: no
/// potentiometer that is plugged in gets there.
constexpr uint8_t servo_duty(uint8_t measured, uint8_t wanted) {
    if (add_wrap(measured, uint8_t{1}) < 2) return 0;
    uint8_t off = sub_wrap(measured, wanted);
    if (measured < wanted) off = neg_wrap(off);
    if (off <= kServoDeadbandCodes) return 0;
    return add_wrap(shift_floor<1>(off), kServoLeastDuty);
}

/// A steering motor that has to turn round is without power until its next turn.
template <class Parts>
void steer_one(ServoLoops& servos, uint8_t motor, uint8_t duty, bool left) {
    static constexpr uint8_t kBit[hal::kSteerCount] = {1, 2, 4, 8};
    const uint8_t before = servos.right;
    uint8_t right = bit_or(before, kBit[motor]);
    if (left) right = bit_xor(right, kBit[motor]);
    if (right != before) duty = 0;
    servos.right = right;
    servos.duty[motor] = duty;
    Parts::Motors::steer(servos.duty, right);
}

/// The mast's motor is on or off.
template <class Parts>
void turn_mast(bool on, bool left) {
    Parts::PpiA::template clear_c<hal::rb85::kMastOnBit>();
    if (!on) return;
    Parts::PpiA::template put_c<hal::rb85::kMastLeftBit>(left);
    Parts::PpiA::template set_c<hal::rb85::kMastOnBit>();
}

/// The commanded angle of the servo at multiplexer input kFirstServo + place. The commands have
/// them in the order of the inputs. Read once: the main line may write it meanwhile.
inline int16_t commanded_brad(const hal::Commands& commands, uint8_t place) {
    constexpr uint8_t kFirstPlace = __builtin_offsetof(hal::Commands, steer_brad) / 2;
    static_assert(__builtin_offsetof(hal::Commands, mast_brad) / 2 ==
                  kFirstPlace + kMastServo - kFirstServo);
    return (reinterpret_cast<const volatile int16_t*>(&commands) + kFirstPlace)[place];
}

/// The servo whose potentiometer is selected gets its duty from the conversion that the last tick
/// started, the next one its conversion: nothing is waited for. Which one it is the multiplexer
/// knows; it is asked again and again, since IN is cheaper than to remember.
/// @context  the tick   @cost  650 T
template <class Parts>
[[gnu::noinline]] void hold_servo(ServoLoops& servos, const hal::Commands& commands) {
    using Inputs = typename Parts::AnalogInputs;
    if (Inputs::selected() < kFirstServo) return;  // the main line's
    if (Inputs::selected() <= kMastServo) {
        const uint8_t place = sub_wrap(Inputs::selected(), kFirstServo);
        const uint8_t wanted = servo_code(commanded_brad(commands, place));
        const uint8_t measured = Inputs::upper_bits();
        const uint8_t duty = servo_duty(measured, wanted);
        const bool left = measured < wanted;
        if (Inputs::selected() == kMastServo) {
            turn_mast<Parts>(duty != 0, left);
        } else {
            steer_one<Parts>(servos, place, duty, left);
        }
    }
    uint8_t next = add_wrap(Inputs::selected(), uint8_t{1});
    if (next == kFirstServo + hal::kSteerCount) next = kMastServo;
    if (next > kMastServo) next = kFirstServo;
    Inputs::start(next);
}

}  // namespace rover
