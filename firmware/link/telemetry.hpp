// telemetry.hpp - the telemetry frame: every estimate of one step, framed and checked.
// Depends on   executive/estimates.hpp, link/crc16.hpp.
// Format       docs/spec/telemetry.md (normative): A5 5A, version, payload size, payload (little
//              endian, in the order of for_each_field), CRC-16 of version to payload, low byte
//              first.
// Bounds       one pass over 50 bytes.
#pragma once

#include "firmware/executive/estimates.hpp"
#include "firmware/link/crc16.hpp"
#include "hal/io.hpp"

namespace rover {

inline constexpr uint8_t kTelemetrySync0 = 0xA5;
inline constexpr uint8_t kTelemetrySync1 = 0x5A;
inline constexpr uint8_t kTelemetryVersion = 1;
inline constexpr uint8_t kTelemetryHeadSize = 4;
inline constexpr uint8_t kTelemetryPayloadSize = 44;
inline constexpr uint8_t kTelemetrySize = kTelemetryHeadSize + kTelemetryPayloadSize + 2;
static_assert(kTelemetrySize <= hal::kTelemetryBytesMax);

/// Calls visit(field) for every field of the payload, in order. The one list for both directions.
template <class E, class Visit>
constexpr void for_each_field(E& estimates, Visit visit) {
    visit(estimates.step_count);
    visit(estimates.tick_count);
    visit(estimates.available);
    visit(estimates.events);
    visit(estimates.faults);
    visit(estimates.mode);
    visit(estimates.cycle_count);
    visit(estimates.position_q4_mm);
    visit(estimates.odometer_q4_mm);
    visit(estimates.position_sigma_q4_mm);
    visit(estimates.advance_q4_mm);
    visit(estimates.slip_percent);
    visit(estimates.match_cost_q4);
    visit(estimates.sinkage_q4_mm);
    visit(estimates.pitch_brad);
    visit(estimates.roll_brad);
    visit(estimates.rocker_brad);
    visit(estimates.bogie_brad);
    visit(estimates.height_middle_q4_mm);
    visit(estimates.height_front_q4_mm);
    visit(estimates.height_ahead_q4_mm[0]);
    visit(estimates.height_ahead_q4_mm[1]);
}

namespace link {

/// Writes words to a buffer, low byte first.
struct ByteWriter {
    uint8_t* bytes;
    uint8_t size = 0;

    constexpr void put(uint8_t value) { bytes[size++] = value; }
    constexpr void put(uint16_t value) {
        put(narrow_wrap_u8(value));
        put(narrow_wrap_u8(shift_floor<8>(value)));
    }
    constexpr void operator()(uint8_t value) { put(value); }
    constexpr void operator()(int8_t value) { put(narrow_wrap_u8(value)); }
    constexpr void operator()(uint16_t value) { put(value); }
    constexpr void operator()(int16_t value) { put(narrow_wrap_u16(value)); }
    constexpr void operator()(int32_t value) {
        put(narrow_wrap_u16(value));
        put(narrow_wrap_u16(shift_floor<16>(value)));
    }
    constexpr void operator()(SlipMode value) { put(static_cast<uint8_t>(value)); }
};

/// Reads words from a buffer, low byte first.
struct ByteReader {
    const uint8_t* bytes;
    uint8_t size = 0;

    constexpr uint16_t get() {
        const uint8_t low = bytes[size++];
        const uint8_t high = bytes[size++];
        return bit_or(widen_u16(low), shift_left_wrap<8>(widen_u16(high)));
    }
    constexpr void operator()(uint8_t& value) { value = bytes[size++]; }
    constexpr void operator()(int8_t& value) { value = convert_wrap<int8_t>(bytes[size++]); }
    constexpr void operator()(uint16_t& value) { value = get(); }
    constexpr void operator()(int16_t& value) { value = narrow_wrap_s16(get()); }
    constexpr void operator()(int32_t& value) {
        const uint32_t low = widen_u32(get());
        const uint32_t high = widen_u32(get());
        value = narrow_wrap_s32(bit_or(low, shift_left_wrap<16>(high)));
    }
    constexpr void operator()(SlipMode& value) { value = static_cast<SlipMode>(bytes[size++]); }
};

constexpr uint16_t frame_crc(const uint8_t* frame) {
    constexpr uint16_t kOfHead =
        crc16_add(crc16_add(kCrc16Start, kTelemetryVersion), kTelemetryPayloadSize);
    return crc16_block(kOfHead, frame + kTelemetryHeadSize, kTelemetryPayloadSize);
}

}  // namespace link

/// Where structs have no padding and words are little endian, as on the target, the payload is the
/// estimates' bytes. for_each_field() visits them in the order of their declarations (Telemetry.
/// VisitsTheFieldsInTheOrderOfTheirDeclarations).
inline constexpr bool kEstimatesAreThePayload =
    sizeof(Estimates) == kTelemetryPayloadSize && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__;

/// Writes one frame. @return kTelemetrySize
[[gnu::noinline]] constexpr uint8_t write_telemetry(const Estimates& estimates,
                                                    uint8_t (&frame)[hal::kTelemetryBytesMax]) {
    link::ByteWriter writer{frame};
    writer.put(kTelemetrySync0);
    writer.put(kTelemetrySync1);
    writer.put(kTelemetryVersion);
    writer.put(kTelemetryPayloadSize);
    if constexpr (kEstimatesAreThePayload) {
        __builtin_memcpy(frame + kTelemetryHeadSize, &estimates, kTelemetryPayloadSize);
        writer.size = kTelemetryHeadSize + kTelemetryPayloadSize;
    } else {
        for_each_field(estimates, [&writer](auto field) { writer(field); });
    }
    writer.put(link::frame_crc(frame));
    return writer.size;
}

/// Reads one frame.
/// @return   false, and `estimates` untouched, when size, sync, version, mode or check is wrong
constexpr bool read_telemetry(const uint8_t* frame, uint8_t size, Estimates& estimates) {
    if (size != kTelemetrySize) return false;
    if (frame[0] != kTelemetrySync0 || frame[1] != kTelemetrySync1) return false;
    if (frame[2] != kTelemetryVersion || frame[3] != kTelemetryPayloadSize) return false;
    link::ByteReader check{frame, kTelemetryHeadSize + kTelemetryPayloadSize};
    if (check.get() != link::frame_crc(frame)) return false;
    link::ByteReader reader{frame, kTelemetryHeadSize};
    Estimates read;
    for_each_field(read, [&reader](auto& field) { reader(field); });
    if (static_cast<uint8_t>(read.mode) > static_cast<uint8_t>(SlipMode::moved)) return false;
    estimates = read;
    return true;
}

}  // namespace rover
