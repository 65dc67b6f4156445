// receiver.cpp - see receiver.hpp.
#include "tools/monitor/receiver.hpp"

#include <cstdlib>
#include <string>

#include "firmware/app/identity.hpp"
#include "firmware/link/telemetry.hpp"

namespace monitor {
namespace {

using host_sim::DownlinkFrame;
using host_sim::ImageIdentity;
using rover::BoardStatus;

constexpr std::size_t kStatusSize = sizeof(BoardStatus);

std::optional<ImageIdentity> read_identity(const DownlinkFrame& frame) {
    const auto payload = frame.payload();
    if (payload.size() != rover::kIdentityPayloadSize || payload[0] != rover::kIdentityFormat) {
        return {};
    }
    ImageIdentity identity;
    identity.version = {payload[1], payload[2], payload[3]};
    identity.source_hash = uint32_t{frame.word(6)} << 16 | frame.word(4);
    identity.image_size = frame.word(8);
    identity.image_crc = frame.word(10);
    for (const uint8_t letter : payload.subspan(12)) {
        if (letter == 0) break;
        identity.vehicle += letter >= 0x20 && letter < 0x7F ? static_cast<char>(letter) : '?';
    }
    return identity;
}

std::optional<BoardStatus> read_status(const DownlinkFrame& frame) {
    const auto payload = frame.payload();
    if (payload.size() != kStatusSize) return {};
    if (payload[20] > static_cast<uint8_t>(rover::ResetCause::other)) return {};
    BoardStatus status;
    status.faults = frame.word(0);
    status.last_faults = frame.word(2);
    status.reset_count = frame.word(4);
    status.late_steps = frame.word(6);
    status.missed_steps = frame.word(8);
    status.received = frame.word(10);
    status.receive_dropped = frame.word(12);
    status.receive_errors = frame.word(14);
    status.frames_dropped = frame.word(16);
    status.frames_refused = payload[18];
    status.trap_count = payload[19];
    status.reset_cause = static_cast<rover::ResetCause>(payload[20]);
    status.warm = payload[21];
    return status;
}

std::optional<Telemetry> read_estimates(const DownlinkFrame& frame) {
    Telemetry telemetry;
    const auto size = static_cast<uint8_t>(frame.bytes.size());
    if (!rover::read_telemetry(frame.bytes.data(), size, telemetry.estimates)) return {};
    return telemetry;
}

/// So many steps ahead of the last frame are a gap; more are a counter that began anew.
uint64_t steps_within(Elapsed passed) {
    constexpr Elapsed kStep{100};
    constexpr uint64_t kMargin = 20;  // the PC's buffers, and a clock that is a little off
    return static_cast<uint64_t>(2 * passed / kStep) + kMargin;
}

}  // namespace

std::optional<Message> Receiver::take(uint8_t byte, Elapsed now) {
    ++counts_.bytes;
    const auto frame = reader_.take(byte, 0);
    if (!frame) return {};
    if (!stray_before_) stray_before_ = reader_.stray_bytes();
    return read(*frame, now);
}

std::optional<Message> Receiver::read(const DownlinkFrame& frame, Elapsed now) {
    std::optional<Message> message;
    switch (frame.kind()) {
        case DownlinkFrame::kTelemetry:
            if (auto telemetry = read_estimates(frame)) {
                follow(*telemetry, now);
                message = *telemetry;
            }
            break;
        case DownlinkFrame::kIdentity:
            if (auto identity = read_identity(frame)) message = std::move(*identity);
            break;
        case DownlinkFrame::kStatus:
            if (auto status = read_status(frame)) message = *status;
            break;
        default:
            message = OtherFrame{frame.kind()};
            break;
    }
    if (!message) ++counts_.refused;
    return message;
}

/// Which step it is, and what lies between it and the frame before.
void Receiver::follow(Telemetry& telemetry, Elapsed now) {
    const uint16_t count = telemetry.estimates.step_count;
    telemetry.step = count;
    if (last_) {
        const auto ahead = static_cast<uint16_t>(count - last_->estimates.step_count);
        if (ahead != 0 && ahead <= steps_within(now - last_at_)) {
            telemetry.step = last_->step + ahead;
            telemetry.missing = ahead - 1U;
        } else {
            // Its own counter tells how many frames of the new run were missed. A warm start goes
            // on near the old odometer, a cold one near zero.
            telemetry.missing = count;
            const int64_t odometer = telemetry.estimates.odometer_q4_mm;
            const int64_t before = last_->estimates.odometer_q4_mm;
            const bool warm = std::abs(odometer - before) < std::abs(odometer);
            telemetry.restart = warm ? host_sim::Restart::warm : host_sim::Restart::cold;
            ++counts_.restarts;
        }
    }
    ++counts_.telemetry;
    counts_.steps_missing += telemetry.missing;
    last_ = telemetry;
    last_at_ = now;
}

Counts Receiver::counts() const {
    Counts counts = counts_;
    counts.refused += reader_.refused_frames();
    counts.stray_bytes = reader_.stray_bytes() - stray_before_.value_or(0);
    return counts;
}

}  // namespace monitor
