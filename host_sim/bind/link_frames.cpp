// link_frames.cpp - see link_frames.hpp.
#include "host_sim/bind/link_frames.hpp"

#include <utility>

namespace host_sim {
namespace {

constexpr uint8_t kDownSync0 = 0xA5, kDownSync1 = 0x5A;
constexpr uint8_t kUpSync0 = 0xC5, kUpSync1 = 0x3A;
constexpr std::size_t kHeadSize = 4, kCheckSize = 2;

void put_word(std::vector<uint8_t>& bytes, unsigned word) {
    bytes.push_back(static_cast<uint8_t>(word & 0xFF));
    bytes.push_back(static_cast<uint8_t>(word >> 8 & 0xFF));
}

}  // namespace

uint16_t link_crc(std::span<const uint8_t> bytes) {
    unsigned crc = 0xFFFF;
    for (const uint8_t byte : bytes) {
        crc ^= unsigned{byte} << 8;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc & 0x8000) != 0 ? crc << 1 ^ 0x1021 : crc << 1;
        }
    }
    return static_cast<uint16_t>(crc);
}

std::optional<DownlinkFrame> DownlinkReader::take(uint8_t byte, uint64_t end_t) {
    bytes_.push_back(byte);
    while (!bytes_.empty()) {
        if (bytes_[0] != kDownSync0 || (bytes_.size() > 1 && bytes_[1] != kDownSync1)) {
            drop_first();
            continue;
        }
        if (bytes_.size() < kHeadSize) return {};
        const std::size_t size = kHeadSize + bytes_[3] + kCheckSize;
        if (bytes_.size() < size) return {};
        const uint16_t crc = link_crc(std::span(bytes_).subspan(2, size - 2 - kCheckSize));
        if (bytes_[size - 2] == (crc & 0xFF) && bytes_[size - 1] == crc >> 8) {
            // A byte at a time: nothing can be behind the frame.
            return DownlinkFrame{std::exchange(bytes_, {}), end_t};
        }
        ++refused_frames_;
        drop_first();
    }
    return {};
}

void DownlinkReader::drop_first() {
    bytes_.erase(bytes_.begin());
    ++stray_bytes_;
}

std::vector<uint8_t> uplink_frame(UplinkType type, std::span<const uint8_t> payload) {
    return uplink_frame(static_cast<uint8_t>(type), payload);
}

std::vector<uint8_t> uplink_frame(uint8_t type, std::span<const uint8_t> payload) {
    std::vector<uint8_t> bytes;
    bytes.reserve(kHeadSize + payload.size() + kCheckSize);
    bytes.push_back(kUpSync0);
    bytes.push_back(kUpSync1);
    bytes.push_back(type);
    bytes.push_back(static_cast<uint8_t>(payload.size()));
    for (const uint8_t byte : payload) bytes.push_back(byte);
    put_word(bytes, link_crc(std::span(bytes).subspan(2)));
    return bytes;
}

std::vector<uint8_t> calibration_payload(const hal::Calibration& calibration) {
    std::vector<uint8_t> bytes;
    put_word(bytes, calibration.version);
    for (const hal::AngleCalibration& angle : calibration.angle) {
        put_word(bytes, angle.zero_q4_count);
        put_word(bytes, angle.gain_q16);
        bytes.push_back(angle.inverted ? 1 : 0);
    }
    put_word(bytes, calibration.wheel_radius_q4_mm);
    put_word(bytes, calibration.tach_counts_per_turn);
    put_word(bytes, calibration.tach_q16_mm_per_count);
    put_word(bytes, static_cast<uint16_t>(calibration.range_offset_q1_mm));
    return bytes;
}

}  // namespace host_sim
