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
enum class RestartKind : uint8_t { warm = 0, cold = 1, loader = 2 };

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
/// it noticed: a size that is too large, or the end of a frame whose check is wrong.
template <class Format>
struct FrameParser {
    uint8_t taken = 0;    ///< bytes of a frame so far, [0, kFrameOverhead + kPayloadMax)
    uint8_t refused = 0;  ///< frames with a wrong check or size, modulo 2^8
    uint8_t frame[kFrameOverhead + Format::kPayloadMax] = {};

    [[nodiscard]] constexpr uint8_t type() const { return frame[2]; }
    [[nodiscard]] constexpr uint8_t size() const { return frame[3]; }
    [[nodiscard]] constexpr const uint8_t* payload() const { return frame + 4; }

    /// Forgets a frame that was begun: its sender paused.
    constexpr void quiet() { taken = 0; }

    /// Takes one byte.
    /// @param good  called when it was the last of a good frame; type, size and payload are valid
    ///              until the next call
    template <class Good>
    [[gnu::noinline]] constexpr void take(uint8_t byte, Good good) {
        const uint8_t place = taken;
        frame[place] = byte;
        taken = add_wrap(place, uint8_t{1});
        if (place < 2) {
            const uint8_t sync = place == 0 ? Format::kSync0 : Format::kSync1;
            if (byte != sync) taken = byte == Format::kSync0 ? 1 : 0;
            return;
        }
        if (place == 2) return;
        if (size() <= Format::kPayloadMax) {
            if (taken != add_wrap(size(), kFrameOverhead)) return;
            if (check_is_right()) {
                taken = 0;
                good();
                return;
            }
        }
        refused = add_wrap(refused, uint8_t{1});
        taken = 0;
    }

    /// The same. @return  true: it was the last of a good frame
    constexpr bool take(uint8_t byte) {
        bool is_good = false;
        take(byte, [&is_good] { is_good = true; });
        return is_good;
    }

private:
    [[nodiscard]] constexpr bool check_is_right() const {
        const uint8_t covered = add_wrap(size(), uint8_t{2});
        const uint16_t crc = crc16_block<Byte>(kCrc16Start, frame + 2, covered);
        const uint8_t* const check = frame + 2 + covered;
        return check[0] == narrow_wrap_u8(crc) && check[1] == narrow_wrap_u8(shift_floor<8>(crc));
    }
    /// As elsewhere, so that one function serves all.
    using Byte = volatile uint8_t;
};
using UplinkParser = FrameParser<Uplink>;
using DownlinkParser = FrameParser<Downlink>;

/// Writes one frame.
/// @param sink  has push_all(bytes, count); gets kFrameOverhead + `size` bytes
/// @param payload  read byte by byte
template <class Format, class Sink>
void write_frame(Sink& sink, uint8_t type, const volatile uint8_t* payload, uint8_t size) {
    const volatile uint8_t head[4] = {Format::kSync0, Format::kSync1, type, size};
    uint16_t crc = crc16_block(kCrc16Start, head + 2, 2);
    if (size != 0) crc = crc16_block(crc, payload, size);
    sink.push_all(head, sizeof head);
    sink.push_all(payload, size);
    const volatile uint8_t check[2] = {narrow_wrap_u8(crc), narrow_wrap_u8(shift_floor<8>(crc))};
    sink.push_all(check, sizeof check);
}

}  // namespace rover
