// board_vcd.hpp - the board's pins, ports and registers over time as a VCD file.
// Depends on   host_sim/board, host_sim/trace/vcd_writer.hpp.
// Use          observe() behind every Board::step(). Runs without it pay nothing.
// Signals      docs/design/trace.md
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "host_sim/board/board_state.hpp"
#include "host_sim/cpu/step_record.hpp"
#include "host_sim/trace/vcd_writer.hpp"

namespace host_sim {

/// A variable of the program that becomes a signal: little endian.
struct VcdVariable {
    std::string name;
    uint16_t address = 0;
    uint8_t size = 1;  ///< bytes, 1 to 4
};

/// Follows one board. Pin changes carry their own T-state, port transfers that of their machine
/// cycle, everything else the end of the instruction.
class BoardVcd {
public:
    /// @param state      of the board that will be followed, as it is now
    /// @errors  VcdError; std::invalid_argument for a variable's size
    BoardVcd(const std::filesystem::path& path, const BoardState& state,
             const std::vector<VcdVariable>& variables = {});

    /// Takes the next step. @param state  of the board behind it. @errors VcdError
    void observe(const StepRecord& step, const BoardState& state);

    /// Writes what is left and completes the file. @errors VcdError
    void close();

private:
    struct Change {
        uint64_t t;
        VcdWriter::Signal signal;
        uint64_t value;
    };
    struct Level {
        VcdWriter::Signal signal;
        std::function<uint64_t(const BoardState&)> value;
    };

    void add(const char* scope, const std::string& name, unsigned width, const BoardState& state,
             std::function<uint64_t(const BoardState&)> value);
    void add_processor(const BoardState& state);
    void add_chips(const BoardState& state);
    void add_pins(const BoardState& state);
    void observe_pins(const CpuState& cpu);
    void observe_ports(const StepRecord& step);
    void write_until(uint64_t t);

    VcdWriter writer_;
    std::vector<Level> levels_;  ///< known at instruction boundaries
    std::array<VcdWriter::Signal, kPinCount> pins_{};
    std::array<uint64_t, kPinCount> pin_seen_t_{};
    VcdWriter::Signal port_ = 0;
    VcdWriter::Signal port_data_ = 0;
    VcdWriter::Signal port_read_ = 0;
    VcdWriter::Signal port_write_ = 0;
    uint64_t end_t_ = 0;
    std::vector<Change> pending_;  ///< a pin may still change before them
};

}  // namespace host_sim
