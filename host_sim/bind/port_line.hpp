// port_line.hpp - a serial port as the line of the loader's client.
// Depends on   host_sim/link/serial_port.hpp, loader_client.hpp.
#pragma once

#include "host_sim/bind/loader_client.hpp"
#include "host_sim/link/serial_port.hpp"

namespace host_sim {

/// @pre  the port outlives the line
[[nodiscard]] inline ByteLine line_of(SerialPort& port) {
    constexpr std::chrono::milliseconds kWrites{2000};
    ByteLine line;
    line.read = [&port](std::span<uint8_t> buffer, std::chrono::milliseconds timeout) {
        return port.read(buffer, timeout);
    };
    line.write = [&port](std::span<const uint8_t> bytes) { port.write(bytes, kWrites); };
    return line;
}

}  // namespace host_sim
