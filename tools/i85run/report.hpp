// report.hpp - the results of a run, for people and as JSON.
// Depends on   run.hpp, function_count.hpp; fmt and nlohmann-json (source only).
// Format       docs/guides/running-programs.md
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/i85run/function_count.hpp"
#include "tools/i85run/machine.hpp"
#include "tools/i85run/run.hpp"

namespace i85run {

/// Memory after the run.
struct Dump {
    std::string name;  ///< as the user wrote it
    uint16_t address = 0;
    std::vector<uint8_t> bytes;
};

/// A counted function, under the name the user gave.
struct CountedFunction {
    std::string name;
    FunctionCount count;
};

/// Everything a run is asked for.
struct Results {
    End end = End::halt;
    uint16_t pc = 0;
    uint64_t instructions = 0;
    uint64_t t_states = 0;
    std::optional<CountedFunction> function{};
    std::vector<Dump> dumps{};
    std::optional<host_sim::AddressRange> rom{};
    uint64_t rom_write_count = 0;
    std::optional<RomWrite> first_rom_write{};
};

/// Lines of "name  value", ending in a newline.
[[nodiscard]] std::string text_report(const Results& results);

/// One JSON object: halted, pc, instructions, t_states, function_t_states, dumps, then more.
[[nodiscard]] std::string json_report(const Results& results);

}  // namespace i85run
