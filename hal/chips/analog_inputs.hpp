// analog_inputs.hpp - multiplexer, sample-and-hold and converter: counts of a channel.
// Source       AD574A, DG406 and LF398 data sheets, see the page.
// Depends on   hal/io.hpp (kAdcAbsent), drivers of converter and 82C55A.
// Interrupts   task and a handler share the converter: the task converts with interrupts disabled,
//              one conversion at a time; the handler leaves the multiplexer as it was.
// Page         docs/chips/ad574a.md
#pragma once

#include <stdint.h>

#include "hal/io.hpp"

namespace hal {

/// @tparam Bus  with enable_interrupts() and disable_interrupts()
/// @tparam Adc  Ad574a
/// @tparam Ppi  I82c55a: port A has the multiplexer's address, port B has STS
template <class Bus, class Adc, class Ppi>
struct AnalogInputs {
    static constexpr uint8_t kConversions = 16;

    /// At 0 V: selected while nobody needs the converter.
    static constexpr uint8_t kNobody = 14;

    // -- Task: between claim() and release()

    /// From now on handlers leave the converter alone. One that is in the middle of a conversion
    /// has lost it: 108 T later the converter is free.
    static void claim() { Ppi::write_a(0); }
    static void release() { Ppi::write_a(kNobody); }

    /// Sum of 16 conversions.
    /// @param channel  multiplexer input, [0, 15]
    /// @param sum      u16 Q4 counts, [0, 65520]; kAdcAbsent without an answer
    /// @return   false: no answer; the converter was busy, or a conversion had no end
    [[nodiscard]] static bool sum_of_16(uint8_t channel, uint16_t& sum) {
        sum = kAdcAbsent;
        Ppi::write_a(channel);
        if (!settles()) return false;
        uint16_t high_sum = 0;
        uint8_t low_sum = 0;  // 16 times 15 at most
        uint8_t left = kConversions - 1;
        Adc::start();
        while (Adc::wait()) {
            const uint8_t high = Adc::high();
            const uint8_t low = Adc::low();
            Adc::start(low);
            high_sum = static_cast<uint16_t>(high_sum + high);
            low_sum = static_cast<uint8_t>(low_sum + (low >> 4));
            (void)Adc::busy();
            (void)Adc::busy();  // with these, wait() looks first when 35 us are just over
            if (--left != 0) continue;
            if (!Adc::wait()) break;
            high_sum = static_cast<uint16_t>(high_sum + Adc::high());
            low_sum = static_cast<uint8_t>(low_sum + (Adc::low() >> 4));
            sum = static_cast<uint16_t>((high_sum << 4) + low_sum);
            return true;
        }
        return false;
    }

    // -- Handler: starts a conversion, and looks at it the next time

    /// The channel of the conversion that was started last, kNobody behind release(); any other
    /// is one of the task's.
    static uint8_t selected() { return Ppi::read_a(); }

    /// Starts a conversion of a channel. @pre selected() is kNobody or was the handler's
    static void start(uint8_t channel) {
        Ppi::write_a(channel);
        (void)Ppi::read_b();
        (void)Ppi::read_b();
        (void)Ppi::read_b();
        Adc::start();
    }
    /// Bits 11 to 4 of its result; 0 when it has not ended. @pre 108 T have passed
    [[nodiscard]] static uint8_t upper_bits() {
        uint8_t bits = 0;
        if (!Adc::busy()) bits = Adc::high();
        return bits;
    }

private:
    /// With the start behind it, 40 T from the multiplexer's address to the start: it settles in 9,
    /// the amplifier acquires in 31 (13 us together).
    /// @return  false: an old conversion still runs, which would pass for one of this channel
    [[nodiscard]] static bool settles() {
        (void)Ppi::read_b();
        (void)Ppi::read_b();
        return !Adc::busy();
    }
};

}  // namespace hal
