// link_frames.hpp - the ground's end of the board's serial link: frames out of bytes, and back.
// Depends on   hal/calibration.hpp, the standard library. Written apart from the firmware's own
//              code for the same frames.
// Normative    docs/spec/link.md, docs/spec/telemetry.md
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/calibration.hpp"

namespace host_sim {

/// A frame from the board.
struct DownlinkFrame {
    static constexpr uint8_t kTelemetry = 0x01;
    static constexpr uint8_t kIdentity = 0x80;
    static constexpr uint8_t kStatus = 0x81;
    static constexpr uint8_t kAcknowledge = 0x82;

    std::vector<uint8_t> bytes;  ///< all of it: sync bytes, kind, size, payload, check
    uint64_t end_t = 0;          ///< when its last bit had left

    [[nodiscard]] uint8_t kind() const { return bytes[2]; }
    [[nodiscard]] std::span<const uint8_t> payload() const {
        return std::span(bytes).subspan(4, bytes.size() - 6);
    }
    /// A word of the payload. @pre  both bytes are in it
    [[nodiscard]] uint16_t word(std::size_t at) const {
        return static_cast<uint16_t>(payload()[at] | payload()[at + 1] << 8);
    }
};

/// Finds frames in the bytes that come down.
class DownlinkReader {
public:
    /// Takes the next byte. @return  a frame that it completes
    [[nodiscard]] std::optional<DownlinkFrame> take(uint8_t byte, uint64_t end_t);
    /// Forgets a frame that has begun.
    void reset() { bytes_.clear(); }
    /// Bytes so far that belonged to no whole frame.
    [[nodiscard]] uint64_t stray_bytes() const { return stray_bytes_; }
    /// What looked like a frame and had a wrong check. Its bytes are stray, but for a frame in
    /// them.
    [[nodiscard]] uint64_t refused_frames() const { return refused_frames_; }

private:
    void drop_first();
    std::vector<uint8_t> bytes_;
    uint64_t stray_bytes_ = 0;
    uint64_t refused_frames_ = 0;
};

enum class UplinkType : uint8_t { identity = 1, status = 2, calibration = 3, restart = 4 };

/// A whole frame for the board. @param payload  at most 48 bytes
[[nodiscard]] std::vector<uint8_t> uplink_frame(UplinkType type,
                                                std::span<const uint8_t> payload = {});

/// The same by the number of its type. @param payload  at most 255 bytes
[[nodiscard]] std::vector<uint8_t> uplink_frame(uint8_t type,
                                                std::span<const uint8_t> payload = {});

/// The calibration record as the payload of its frame.
[[nodiscard]] std::vector<uint8_t> calibration_payload(const hal::Calibration& calibration);

/// CRC-16/CCITT-FALSE: polynomial 1021H, start FFFFH.
[[nodiscard]] uint16_t link_crc(std::span<const uint8_t> bytes);

}  // namespace host_sim
