// volatile_program.hpp - random C programs over volatile variables, ports and interrupt enables,
// and the accesses that C's abstract machine makes when it executes them.
// Depends on   the standard library.
// Oracle       the generator executes every statement that it writes down; no compiler takes part.
// Form         one access in a full expression at most, so that the order is the language's.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace target_test {

/// What the outside sees.
struct Access {
    enum class Kind : uint8_t { read, write, in, out, enable, disable };
    Kind kind = Kind::read;
    std::string object{};  ///< variable, "port N", or empty
    uint32_t offset = 0;   ///< of the first byte, in the variable
    unsigned bytes = 1;
    uint64_t value = 0;

    bool operator==(const Access&) const = default;
    [[nodiscard]] std::string text() const;
};

/// The value that access number `index` to the outside gets.
[[nodiscard]] uint64_t outside_value(uint64_t seed, uint64_t index);

/// A variable of the program, or a device at an address, that the outside watches and feeds.
struct Device {
    /// What C accesses as a whole: an element, a member.
    struct Part {
        std::string name{};  ///< behind the device's: "", "[2]", ".rate"
        unsigned offset = 0;
        unsigned bytes = 1;
    };
    std::string name{};
    std::string declaration{};  ///< in C
    std::vector<Part> parts{};
    uint16_t address = 0;  ///< 0: a variable, which the linker places
};

struct VolatileProgram {
    std::string text{};  ///< C; main ends in HLT
    std::vector<Device> devices{};
    std::vector<Access> accesses{};  ///< from main's first statement up to the HLT
};

[[nodiscard]] VolatileProgram make_volatile_program(uint64_t seed);

}  // namespace target_test
