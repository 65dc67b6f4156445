// watched_machine.hpp - a program on a bus that feeds volatile variables and ports from outside and
// notes every access to them.
// Depends on   host_sim/cpu/reference.hpp, toolchain/asm (Program), volatile_program.hpp.
// Rule         a variable of several bytes is one access when its bytes are accessed once each, in
//              any order, with nothing to the outside between; anything else is a violation.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/flat_memory.hpp"
#include "tests/target/volatile_program.hpp"
#include "toolchain/asm/program.hpp"

namespace target_test {

/// The bus: memory, devices in it, ports. Satisfies host_sim::Bus.
class WatchedBus {
public:
    WatchedBus(host_sim::FlatMemory& memory, uint64_t seed) : memory_(memory), seed_(seed) {}

    void watch(const Device& device, uint16_t address);
    void start() { watching_ = true; }

    uint8_t fetch(uint16_t address, uint64_t);
    uint8_t operand(uint16_t address, uint64_t) { return memory_.bytes[address]; }
    uint8_t read(uint16_t address, uint64_t);
    void write(uint16_t address, uint8_t value, uint64_t);
    uint8_t in(uint8_t port, uint64_t);
    void out(uint8_t port, uint8_t value, uint64_t);
    uint8_t acknowledge(uint64_t) { return 0xFF; }
    void update_pins(uint64_t) {}
    void serial_out(bool, uint64_t) {}

    /// What happened, as the outside saw it. Violations are accesses with a text of their own.
    [[nodiscard]] const std::vector<Access>& accesses() const { return accesses_; }
    [[nodiscard]] const std::string& violation() const { return violation_; }
    void finish() { close(); }

private:
    struct Place {
        Device device;
        uint16_t address = 0;
    };
    /// What is accessed as a whole, and which byte of it.
    struct Byte {
        const Place* place = nullptr;  ///< nullptr: memory
        Device::Part part{};
        unsigned index = 0;
    };
    [[nodiscard]] Byte find(uint16_t address) const;
    /// The open access if the byte belongs to it, else a new one.
    Access& open(Access::Kind kind, const Byte& byte);
    void close();
    void note(const Access& access);

    host_sim::FlatMemory& memory_;
    uint64_t seed_;
    uint64_t reads_ = 0;
    bool watching_ = false;
    std::vector<Place> places_;
    std::optional<Access> open_;
    unsigned open_bytes_ = 0;  ///< bit i: byte i has been accessed
    std::vector<Access> accesses_;
    std::string violation_;
};

struct WatchedRun {
    std::vector<Access> accesses{};
    std::string violation{};  ///< the first, or empty
    bool halted = false;
};

/// Runs the program from reset; watches from the first instruction of main up to the HLT.
[[nodiscard]] WatchedRun run_watched(const toolchain::assembly::Program& program,
                                     const std::vector<Device>& devices, uint64_t seed,
                                     bool undocumented = false);

}  // namespace target_test
