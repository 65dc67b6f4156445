// frames.hpp - frames of the serial link, both ways: found in a stream of bytes, and written.
// Depends on   link/crc16.hpp.
// Format       docs/spec/link.md (normative): two sync bytes, type, payload size, payload, CRC-16
// of
//              type to payload, low byte first.
// Bounds       one byte at a time; a payload buffer of the largest size.
// Tests        tests/firmware/link/frames_test.cpp
#pragma once

#include "firmware/link/crc16.hpp"

namespace rover {

/// Which bytes open a frame, and how long it can be.
template <uint8_t kFirst, uint8_t kSecond, uint8_t kPayload>
struct FrameFormat {
    static constexpr uint8_t kSync0 = kFirst;
    static constexpr uint8_t kSync1 = kSecond;
    static constexpr uint8_t kPayloadMax = kPayload;
};
using Uplink = FrameFormat<0xC5, 0x3A, 48>;
using Downlink = FrameFormat<0xA5, 0x5A, 44>;

inline constexpr uint8_t kFrameOverhead = 6;  ///< bytes of a frame beside its payload

/// From the ground.
enum class UplinkType : uint8_t {
    identity = 0x01,     ///< asks for an identity frame
    status = 0x02,       ///< asks for a status frame
    calibration = 0x03,  ///< a calibration record, used from the next reset on
    restart = 0x04,      ///< payload: a RestartKind
};
enum class RestartKind : uint8_t { warm = 0, cold = 1 };

/// To the ground.
enum class DownlinkKind : uint8_t {
    telemetry = 0x01,  ///< docs/spec/telemetry.md
    identity = 0x80,
    status = 0x81,
    acknowledge = 0x82,  ///< payload: type and AckResult
};
enum class AckResult : uint8_t {
    done = 0,
    unknown_type = 1,
    wrong_size = 2,
    refused = 3,  ///< the content cannot be used
};

/// Finds frames in a stream. After damage it looks for the next sync bytes behind the point where
/// it noticed.
template <class Format>
struct FrameParser {
    enum class Next : uint8_t { sync0, sync1, type, size, payload, crc_low, crc_high };

    Next next = Next::sync0;
    uint8_t type = 0;
    uint8_t size = 0;
    uint8_t count = 0;  ///< payload bytes so far
    uint16_t crc = 0;
    uint8_t refused = 0;  ///< frames with a wrong check or size, modulo 2^8
    uint8_t payload[Format::kPayloadMax] = {};

    /// Forgets a frame that was begun: its sender paused.
    constexpr void quiet() { next = Next::sync0; }

    /// Takes one byte.
    /// @return  true: it was the last of a good frame; type, size and payload are valid until the
    ///          next call
    constexpr bool take(uint8_t byte) {
        switch (next) {
            case Next::sync0:
                return seek(byte);
            case Next::sync1:
                if (byte != Format::kSync1) return seek(byte);
                crc = kCrc16Start;
                next = Next::type;
                return false;
            case Next::crc_low:
                next = Next::crc_high;
                if (byte != narrow_wrap_u8(crc)) refuse();
                return false;
            case Next::crc_high:
                next = Next::sync0;
                if (byte == narrow_wrap_u8(shift_floor<8>(crc))) return true;
                refuse();
                return false;
            default:
                crc = crc16_add(crc, byte);
                take_content(byte);
                return false;
        }
    }

private:
    constexpr bool seek(uint8_t byte) {
        next = byte == Format::kSync0 ? Next::sync1 : Next::sync0;
        return false;
    }
    constexpr void refuse() {
        refused = add_wrap(refused, uint8_t{1});
        next = Next::sync0;
    }
    constexpr void take_content(uint8_t byte) {
        if (next == Next::type) {
            type = byte;
            next = Next::size;
            return;
        }
        if (next == Next::size) {
            size = byte;
            count = 0;
            next = byte == 0 ? Next::crc_low : Next::payload;
            if (byte > Format::kPayloadMax) refuse();
            return;
        }
        payload[count] = byte;
        count = add_wrap(count, uint8_t{1});
        if (count == size) next = Next::crc_low;
    }
};
using UplinkParser = FrameParser<Uplink>;
using DownlinkParser = FrameParser<Downlink>;

/// Writes one frame. @param sink  has push(uint8_t); gets kFrameOverhead + `size` bytes
/// @param payload  read byte by byte, may be volatile
template <class Format, class Sink, class Byte>
constexpr void write_frame(Sink& sink, uint8_t type, const Byte* payload, uint8_t size) {
    uint16_t crc = crc16_add(crc16_add(kCrc16Start, type), size);
    sink.push(Format::kSync0);
    sink.push(Format::kSync1);
    sink.push(type);
    sink.push(size);
    for (; size != 0; --size) {
        const uint8_t byte = *payload++;
        sink.push(byte);
        crc = crc16_add(crc, byte);
    }
    sink.push(narrow_wrap_u8(crc));
    sink.push(narrow_wrap_u8(shift_floor<8>(crc)));
}

}  // namespace rover
