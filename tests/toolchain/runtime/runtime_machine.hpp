// runtime_machine.hpp - the compiler's runtime routines, assembled and called one at a time.
// Depends on   toolchain/runtime/*.s85, toolchain/asm, host_sim/cpu/flat_machine.hpp.
// Form         what a routine's comment block states: docs/spec/runtime.md.
#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "host_sim/cpu/flat_machine.hpp"
#include "toolchain/asm/object.hpp"

namespace runtime_test {

/// What a routine is given and what it leaves.
struct Registers {
    uint8_t a = 0;
    uint8_t flags = 0;
    uint16_t bc = 0;
    uint16_t de = 0;
    uint16_t hl = 0;

    [[nodiscard]] uint8_t e() const { return static_cast<uint8_t>(de); }
    [[nodiscard]] uint8_t l() const { return static_cast<uint8_t>(hl); }
    [[nodiscard]] uint32_t dehl() const { return static_cast<uint32_t>(de) << 16 | hl; }
};

#ifdef ROVER_SMALL_RUNTIME
inline constexpr bool kSmall = true;  ///< the routines of toolchain/runtime/small
#else
inline constexpr bool kSmall = false;
#endif
#ifdef ROVER_UNDOCUMENTED_RUNTIME
inline constexpr bool kUndocumented = true;  ///< the routines of toolchain/runtime/undocumented
#else
inline constexpr bool kUndocumented = false;
#endif

#ifdef ROVER_TABLE_RUNTIME
inline constexpr bool kTable = true;  ///< the routines of toolchain/runtime/table
#else
inline constexpr bool kTable = false;
#endif

/// DE:HL = value.
[[nodiscard]] Registers with_dehl(uint32_t value);

/// A routine's comment block.
struct Routine {
    std::string name;
    std::string section;
    unsigned stated_bytes = 0;          ///< of that section
    std::vector<std::string> in;        ///< registers and cells
    std::vector<std::string> out;       ///< registers and cells
    std::vector<std::string> clobbers;  ///< registers
    std::vector<std::string> calls;
    unsigned best_t = 0;  ///< T-states, RET included and CALL not
    unsigned worst_t = 0;
    bool is_variant = false;  ///< of toolchain/runtime/small, undocumented or table
    bool is_stated = true;    ///< false: it calls such a routine, and is not one itself
};

/// All routines in the memory of one machine.
class RuntimeMachine {
public:
    RuntimeMachine();

    [[nodiscard]] const std::vector<Routine>& routines() const { return routines_; }
    [[nodiscard]] const std::vector<toolchain::assembly::Module>& modules() const {
        return modules_;
    }
    [[nodiscard]] const Routine& routine(std::string_view name) const;
    [[nodiscard]] uint16_t address(const std::string& symbol) const { return symbols_.at(symbol); }

    /// Calls the routine at `entry` and runs it up to its RET.
    /// @errors  std::runtime_error: it does not return within 3,000,000 T-states, or returns with
    ///          the stack pointer elsewhere
    Registers call(uint16_t entry, const Registers& in);
    [[nodiscard]] unsigned last_t() const { return last_t_; }

    [[nodiscard]] uint64_t read(uint16_t address, unsigned bytes) const;
    void write(uint16_t address, unsigned bytes, uint64_t value);
    [[nodiscard]] host_sim::FlatMemory& memory() { return machine_.memory; }

private:
    void take_variant();
    void read_blocks(std::string_view text);
    void place();

    host_sim::FlatMachine machine_{kUndocumented ? host_sim::InstructionSet::all
                                                 : host_sim::InstructionSet::documented};
    std::vector<Routine> routines_;
    std::vector<toolchain::assembly::Module> modules_;
    std::map<std::string, uint16_t> symbols_;
    unsigned last_t_ = 0;
};

/// The one machine of a test program.
[[nodiscard]] RuntimeMachine& runtime();

/// Calls of one routine: what they may change, and the fewest and most T-states seen.
class Calls {
public:
    explicit Calls(std::string_view name);

    /// What the routine does not take is filled with changing values.
    /// Fails the running test when a register changed that is neither result nor clobbered.
    Registers operator()(const Registers& in);

    [[nodiscard]] unsigned best_t() const { return best_t_; }
    [[nodiscard]] unsigned worst_t() const { return worst_t_; }
    [[nodiscard]] Registers worst_in() const { return worst_in_; }

    /// Fails unless the extremes seen are those stated.
    void expect_stated() const;

private:
    [[nodiscard]] Registers filled(const Registers& in);

    const Routine& routine_;
    uint16_t entry_;
    Registers taken_;     ///< bits set where a register is an operand
    Registers changing_;  ///< and where it is a result or clobbered
    uint64_t filler_ = 0;
    bool reported_ = false;
    unsigned best_t_ = ~0U;
    unsigned worst_t_ = 0;
    Registers best_in_;
    Registers worst_in_;
};

/// Random numbers; the seed is printed, and taken from ROVER_RUNTIME_SEED when that is set.
[[nodiscard]] std::mt19937_64& random_source();

/// A random number whose leading and trailing bits tend to be equal, so that carries, small numbers
/// and corners are frequent.
[[nodiscard]] uint64_t lumpy(std::mt19937_64& source, unsigned bits);

/// 0, 1, powers of two, their neighbours and negatives, up to `bits`.
[[nodiscard]] std::vector<uint64_t> corners(unsigned bits);

}  // namespace runtime_test
