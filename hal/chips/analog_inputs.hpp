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

    /// Sum of 16 conversions.
    /// @param channel  multiplexer input, [0, 15]
    /// @param sum      u16 Q4 counts, [0, 65520]; kAdcAbsent without an answer
    /// @return   false: no answer; the converter was busy, or a conversion had no end
    /// @context  task, interrupts enabled; disables them for one conversion at a time
    [[nodiscard]] static bool sum_of_16(uint8_t channel, uint16_t& sum) {
        sum = kAdcAbsent;
        Ppi::write_a(channel);
        if (!settles()) return false;
        uint16_t high_sum = 0;
        uint8_t low_sum = 0;  // 16 times 15 at most
        uint8_t left = kConversions - 1;
        Bus::disable_interrupts();
        Adc::start();
        while (Adc::wait()) {
            const uint8_t high = Adc::high();
            const uint8_t low = Adc::low();
            Bus::let_interrupts_in();
            Adc::start(low);
            high_sum = static_cast<uint16_t>(high_sum + high);
            low_sum = static_cast<uint8_t>(low_sum + (low >> 4));
            (void)Adc::busy();
            (void)Adc::busy();  // with these, wait() looks first when 35 us are just over
            if (--left != 0) continue;
            if (!Adc::wait()) break;
            high_sum = static_cast<uint16_t>(high_sum + Adc::high());
            low_sum = static_cast<uint8_t>(low_sum + (Adc::low() >> 4));
            Bus::enable_interrupts();
            sum = static_cast<uint16_t>((high_sum << 4) + low_sum);
            return true;
        }
        Bus::enable_interrupts();
        return false;
    }

    /// One conversion of one channel. Leaves the multiplexer as it was.
    /// @return   u16 Q4 counts as sum_of_16(), a multiple of 16; kAdcAbsent without an end
    /// @context  interrupts disabled: a handler
    static uint16_t convert(uint8_t channel) {
        const uint8_t before = Ppi::read_a();
        Ppi::write_a(channel);
        uint16_t result = kAdcAbsent;
        if (settles()) {
            Adc::start();
            if (Adc::wait()) {
                const uint8_t high = Adc::high();
                result = static_cast<uint16_t>(high << 8 | Adc::low());
            }
        }
        Ppi::write_a(before);
        return result;
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
