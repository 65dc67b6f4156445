// cpm.hpp - just enough of CP/M 2.2 to run .COM programs such as processor exercisers.
// Depends on   machine.hpp.
// Source       Digital Research, CP/M 2.2 Operating System Manual (1982), chapter 5: system
//              functions and page zero.
// Modelled     functions 0, 1, 2, 6, 9 to 12 of the BDOS; warm boot. A call of the BDOS costs the
//              program what its CALL and one RET cost, nothing in between.
// Not modelled files and drives (their functions report an error), the BIOS; no key is ever
//              waiting (functions 6 and 11).
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>

#include "host_sim/cpu/step_record.hpp"
#include "tools/i85run/machine.hpp"

namespace i85run {

inline constexpr uint16_t kCpmProgramStart = 0x0100;
inline constexpr uint16_t kCpmMemoryTop = 0xFE00;  ///< bottom of the BDOS; the word at 0006h
inline constexpr unsigned kCpmProgramBytesMax = kCpmMemoryTop - kCpmProgramStart;

/// The console and what the system complains about.
struct CpmConsole {
    std::function<void(char)> put;
    std::function<int()> get;  ///< the next character typed, or -1 at the end of the input
    bool echo = true;          ///< function 1 shows what was typed
    std::function<void(const std::string& line)> warn;
};

/// The system side of a CP/M machine.
class Cpm {
public:
    explicit Cpm(CpmConsole console) : console_(std::move(console)) {}

    /// Loads `program` at 0100h and prepares page zero, PC and the stack (its word is 0000h).
    /// @param program  at most kCpmProgramBytesMax bytes
    void start(Machine& machine, std::span<const uint8_t> program);

    /// Serves the trap that `machine` is at: a BDOS call, after which the program goes on.
    /// @param record  filled with the RET that ends the call
    /// @return        false when the program is over: warm boot or function 0; nothing is executed
    bool serve_trap(Machine& machine, host_sim::StepRecord& record);

private:
    bool call_bdos(Machine& machine);
    uint8_t read_key();
    void read_line(Machine& machine);
    void print_string(const Machine& machine);
    void report_unsupported(const Machine& machine);

    CpmConsole console_;
    std::set<uint8_t> unsupported_;
};

}  // namespace i85run
