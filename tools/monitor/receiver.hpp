// receiver.hpp - bytes from the rover's link to messages, with the losses on the way.
// Depends on   host_sim/bind/link_frames.hpp, firmware/link, firmware/executive/board_status.hpp.
// Normative    docs/spec/link.md, docs/spec/telemetry.md
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <variant>

#include "firmware/executive/board_status.hpp"
#include "firmware/executive/estimates.hpp"
#include "host_sim/bind/link_frames.hpp"
#include "host_sim/image/identity.hpp"
#include "host_sim/log/log.hpp"

namespace monitor {

/// Time since the monitor began.
using Elapsed = std::chrono::milliseconds;

/// One telemetry frame and how it follows the one before.
struct Telemetry {
    rover::Estimates estimates;
    uint64_t step = 0;     ///< control steps since reset, without the wrap at 2^16
    uint64_t missing = 0;  ///< steps right before it of which no frame came
    /// The rover was reset since the frame before. Cold when its odometer began anew.
    host_sim::Restart restart = host_sim::Restart::none;
};

/// An acknowledge, which nobody asked for, or a kind of frame that does not exist.
struct OtherFrame {
    uint8_t kind = 0;
};

using Message = std::variant<Telemetry, host_sim::ImageIdentity, rover::BoardStatus, OtherFrame>;

struct Counts {
    uint64_t bytes = 0;
    uint64_t telemetry = 0;      ///< frames
    uint64_t refused = 0;        ///< frames with a wrong check or content
    uint64_t stray_bytes = 0;    ///< in no whole frame, since the first one
    uint64_t steps_missing = 0;  ///< between telemetry frames
    uint64_t restarts = 0;
};

class Receiver {
public:
    /// Takes the next byte, which came at `now`. @return  the message that it completes
    [[nodiscard]] std::optional<Message> take(uint8_t byte, Elapsed now);
    [[nodiscard]] Counts counts() const;

private:
    [[nodiscard]] std::optional<Message> read(const host_sim::DownlinkFrame& frame, Elapsed now);
    void follow(Telemetry& telemetry, Elapsed now);

    host_sim::DownlinkReader reader_;
    Counts counts_;
    std::optional<uint64_t> stray_before_;  ///< bytes of the frame in whose middle it began
    std::optional<Telemetry> last_;
    Elapsed last_at_{0};
};

}  // namespace monitor
