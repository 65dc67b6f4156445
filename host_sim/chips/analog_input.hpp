// analog_input.hpp - multiplexer, sample-and-hold and converter in series, wired as on the board.
// Depends on   host_sim/chips/analog_mux.hpp, sample_hold.hpp, ad574a.hpp.
// Wiring       STS of the converter switches the sample-and-hold: it holds while STS is high and
//              samples otherwise. So software selects a channel, waits until the multiplexer has
//              settled and the amplifier has acquired, and starts the converter.
// Page         docs/chips/ad574a.md
#pragma once

#include <array>

#include "host_sim/chips/ad574a.hpp"
#include "host_sim/chips/analog_mux.hpp"
#include "host_sim/chips/sample_hold.hpp"

namespace host_sim::chips {

struct AnalogInput {
    explicit AnalogInput(uint64_t clock_hz) : mux(clock_hz), amplifier(clock_hz), adc(clock_hz) {}

    void reset() {}
    /// Bus accesses of the converter: see Ad574a.
    uint8_t read(uint16_t address, uint64_t now_t);
    void write(uint16_t address, uint8_t value, uint64_t now_t);
    void advance(uint64_t now_t);
    /// End of the conversion; the held voltage does not move before.
    [[nodiscard]] uint64_t next_event_t() const { return adc.converting ? adc.end_t() : kNever; }

    /// Voltage of a sensor from `now_t` on. @param channel  modulo 16
    void set_sensor(unsigned channel, int32_t voltage_uv, uint64_t now_t);
    /// Replays a recorded sum of 16 conversions, until the next set_ call for the channel: noise
    /// that is just right. The j-th conversion from now on gives sum / 16 or one more, so that any
    /// 16 consecutive ones sum to `sum_q4`. A step of one code needs no settling.
    /// @param channel  modulo 16   @param sum_q4  [0, 65520], Q4 counts
    void set_sensor_sum(unsigned channel, uint16_t sum_q4, uint64_t now_t);
    /// From now on the channel gives no answer: while the multiplexer selects it, STS reads busy
    /// and the outputs are off. Until the next set_ call for the channel.
    void set_silent(unsigned channel, uint64_t now_t);
    /// Address lines of the multiplexer. @param channel  modulo 16
    void select(unsigned channel, uint64_t now_t);
    [[nodiscard]] bool busy(uint64_t now_t) const { return silent() || adc.busy(now_t); }
    [[nodiscard]] Properties properties(uint64_t now_t) const;

    /// What feeds a channel.
    struct Source {
        enum class Kind : uint8_t { voltage, sum, silent };
        Kind kind = Kind::voltage;
        uint16_t sum_q4 = 0;   ///< Kind::sum
        uint8_t sequence = 0;  ///< conversions since set_sensor_sum, modulo 16

        bool operator==(const Source&) const = default;
    };

    AnalogMux mux;
    SampleHold amplifier;
    Ad574a adc;
    std::array<Source, AnalogMux::kChannelCount> sources{};
    uint64_t unsettled_count = 0;  ///< conversions started before multiplexer and amplifier settled

    bool operator==(const AnalogInput&) const = default;

private:
    [[nodiscard]] bool silent() const { return sources[mux.channel].kind == Source::Kind::silent; }
    void next_replayed_code();
};

}  // namespace host_sim::chips
