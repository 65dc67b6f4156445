// image_bench.hpp - the flying image on the simulated board: runs to places, talks over the link.
// Depends on   host_sim/board, host_sim/image, firmware/link (frame formats, calibration bytes).
// Image        what the build has made; stamped here, with a check computed bit by bit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/executive/board_status.hpp"
#include "firmware/executive/pose_record.hpp"
#include "firmware/link/frames.hpp"
#include "hal/calibration.hpp"
#include "host_sim/board/board.hpp"
#include "host_sim/image/image.hpp"
#include "host_sim/image/symbols.hpp"

namespace image_test {

/// The image of the build, stamped, and its symbols.
struct Program {
    std::vector<uint8_t> rom;
    host_sim::Symbols symbols;
    uint16_t identity = 0;      ///< address of the identity block
    std::size_t image_end = 0;  ///< last address of the application, plus 1
};
[[nodiscard]] const Program& program();

/// CRC-16/CCITT-FALSE, bit by bit from its polynomial.
[[nodiscard]] uint16_t crc_of(const std::vector<uint8_t>& bytes);

struct Frame {
    uint8_t kind = 0;
    std::vector<uint8_t> payload;
    std::vector<uint8_t> bytes;  ///< as sent
};

class ImageBench {
public:
    /// A board with battery-backed memory as after manufacture, sensors in the middle, tachometers
    /// plugged in.
    ImageBench();

    host_sim::Board board;

    [[nodiscard]] uint64_t now() const { return board.state.cpu.t; }
    [[nodiscard]] uint16_t address(const std::string& symbol) const;
    [[nodiscard]] uint8_t byte(uint16_t address) const { return board.state.memory.bytes[address]; }
    [[nodiscard]] uint16_t word(uint16_t address) const;
    [[nodiscard]] uint16_t steps() const { return word(step_count_); }
    [[nodiscard]] uint16_t ticks() const { return word(tick_count_); }
    [[nodiscard]] uint16_t fault_register() const { return word(0xFF04); }

    /// Runs so many T-states.
    void run(uint64_t t) { board.run(now() + t); }
    /// Runs until so many steps have been completed since reset. @return false: not within 10 s
    bool run_to_step(uint16_t count);
    /// Presses RESET and runs until variables are cleared.
    void reset();
    /// Runs until PC is at a symbol and an instruction begins there. @return false: not within 10 s
    bool run_to(const std::string& symbol);

    /// Sends bytes from the ground, one behind the other from now on.
    void send(const std::vector<uint8_t>& bytes);
    void send_frame(uint8_t type, const std::vector<uint8_t>& payload);
    /// Frames that have come since the last call; bytes outside of frames are counted.
    std::vector<Frame> frames();
    [[nodiscard]] uint64_t stray_bytes() const { return stray_bytes_; }
    /// Sends a request and runs until a frame of `kind` comes. @return nothing: not within 5 steps
    std::optional<Frame> ask(uint8_t type, const std::vector<uint8_t>& payload, uint8_t kind);
    std::optional<rover::BoardStatus> ask_status();

    /// The newest checkpoint in the battery-backed memory, read independently of the firmware.
    struct Checkpoint {
        uint8_t sequence = 0;
        rover::PoseRecord record;
    };
    [[nodiscard]] std::optional<Checkpoint> checkpoint() const;
    [[nodiscard]] std::optional<Checkpoint> slot(uint16_t address) const;

    void sensor(uint8_t channel, uint16_t count);
    /// Pulses of all wheels, spread over the next `t` T-states.
    void drive(unsigned pulses, uint64_t t);

private:
    uint16_t tick_count_;
    uint16_t step_count_;
    std::vector<uint8_t> stream_;
    uint64_t stray_bytes_ = 0;
};

inline constexpr uint64_t kStepT = 307'200;
inline constexpr uint64_t kSecondT = 3'072'000;
inline constexpr uint64_t kCharacterT = 1'600;

}  // namespace image_test
