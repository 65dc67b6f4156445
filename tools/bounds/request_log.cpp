// request_log.cpp - see request_log.hpp.
#include "tools/bounds/request_log.hpp"

#include <vector>

#include "host_sim/bind/link_frames.hpp"

namespace rover_bounds {

host_sim::Log with_requests(host_sim::Log log) {
    using host_sim::UplinkType;
    std::vector<uint8_t> stream;
    const auto add = [&stream](UplinkType type, const std::vector<uint8_t>& payload = {}) {
        const std::vector<uint8_t> frame = host_sim::uplink_frame(type, payload);
        stream.insert(stream.end(), frame.begin(), frame.end());
    };
    const std::vector<uint8_t> calibration = host_sim::calibration_payload(log.head.calibration);
    constexpr auto kUnknown = static_cast<UplinkType>(0x7E);
    // 127 bytes: each begins at every byte of a step.
    add(UplinkType::calibration, calibration);
    add(kUnknown, std::vector<uint8_t>(9));  // with the end of the one before a step's 16 bytes
    add(UplinkType::status);
    add(UplinkType::calibration, calibration);
    add(UplinkType::status);
    add(UplinkType::identity);
    add(UplinkType::calibration);  // of a wrong size
    add(UplinkType::calibration);
    std::size_t next = 0;
    for (host_sim::LogStep& step : log.steps) {
        step.inputs.command_size = hal::kCommandBytesMax;
        for (uint8_t& byte : step.inputs.command) byte = stream[next++ % stream.size()];
    }
    return log;
}

}  // namespace rover_bounds
