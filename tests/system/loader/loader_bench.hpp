// loader_bench.hpp - a live board with the loader in it, and the PC's end of its line.
#pragma once

#include <memory>
#include <string>

#include "host_sim/bind/flasher.hpp"
#include "host_sim/board/board.hpp"
#include "host_sim/image/board_image.hpp"
#include "host_sim/link/live_board.hpp"
#include "host_sim/link/serial_port.hpp"

namespace loader_test {

inline constexpr uint64_t kSecondT = 3'072'000;

/// The image that the build has made: loader, application, boot record.
[[nodiscard]] const host_sim::Image& built_image();
/// Another one that is as good: a byte of its vehicle's name differs, stamped anew.
[[nodiscard]] host_sim::Image other_image(const std::string& vehicle = "Rocky3.3");

class LoaderBench {
public:
    /// @param application  false: the loader alone, as a programmer has left it
    explicit LoaderBench(bool application = false);

    host_sim::LiveBoard live{host_sim::BoardOptions{}, host_sim::Pace::eager};

    /// The line to the board, open as long as this or one made before.
    [[nodiscard]] host_sim::ByteLine line();
    [[nodiscard]] host_sim::LoaderClient client(
        const host_sim::LoaderClient::Options& options = {}) {
        return {line(), options};
    }

    /// Is the application there, byte for byte, with its record? What lies behind it does not
    /// count.
    /// @pre stopped
    [[nodiscard]] bool holds(const host_sim::Image& image);
    /// Is the loader's part as it was? @pre stopped
    [[nodiscard]] bool loader_is_untouched();
    /// Does the image run and answer, with no fault that stops the drives?
    [[nodiscard]] bool flies(const host_sim::Image& image);

    /// Samples that saw a motor with power while the loader ran.
    unsigned powered = 0;
    unsigned samples = 0;

private:
    void watch_motors(uint64_t t);
    std::shared_ptr<host_sim::SerialPort> port_;  ///< on the path of `live`
};

}  // namespace loader_test
