// analog_inputs.hpp - multiplexer, sample-and-hold and converter: counts of a channel.
// Source       AD574A, DG406 and LF398 data sheets, see the page.
// Depends on   hal/io.hpp (kAdcAbsent), hal/board/rb85.hpp; drivers of converter and 82C55A.
// Interrupts   task and a handler share the converter: the multiplexer's address tells whose it is.
// Page         docs/chips/ad574a.md
#pragma once

#include <stdint.h>

#include "hal/board/rb85.hpp"
#include "hal/io.hpp"

namespace hal {

/// @tparam Adc  Ad574a
/// @tparam Ppi  I82c55a: port A has the multiplexer's address, port B has STS
template <class Adc, class Ppi>
struct AnalogInputs {
    static constexpr uint8_t kConversions = 16;

    /// Selected while nobody needs the converter: an input at 0 V.
    static constexpr uint8_t kNobody = rb85::kMuxZero;

    // -- The task, with its own channels between claim() and release()

    /// From now on the handler leaves the converter alone. The conversion that it may have started
    /// is lost; 35 us later the converter is free.
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

    // -- A handler, with channels that the task has not: it starts a conversion and has its result
    //    the next time, so it never waits

    /// A channel of the handler's: start() was the last who had the converter. kNobody: the task
    /// was, and is done. A channel of the task's: it has it now.
    static uint8_t selected() { return Ppi::read_a(); }

    /// Starts a conversion, 40 T from the multiplexer's address as in settles().
    /// @pre  selected() is kNobody or a channel of the handler's
    static void start(uint8_t channel) {
        Ppi::write_a(channel);
        (void)Ppi::read_b();
        (void)Ppi::read_b();
        (void)Ppi::read_b();
        Adc::start();
    }
    /// Bits 11 to 4 of its result; 0 when it has not ended.
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
