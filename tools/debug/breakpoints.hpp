// breakpoints.hpp - where a run is to stop: addresses, ports, memory accesses, interrupts.
// Depends on   expression.hpp, host_sim/cpu/step_record.hpp.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/cpu/step_record.hpp"
#include "tools/debug/expression.hpp"

namespace debug_console {

/// One breakpoint. Those on addresses stop before the instruction; the others behind the step that
/// did what they wait for.
struct Breakpoint {
    enum class Kind : uint8_t { address, port, memory, interrupt };
    Kind kind = Kind::address;
    uint16_t first = 0;  ///< address, or port
    uint16_t last = 0;   ///< of memory; else equal to `first`
    bool reads = true;   ///< port: IN; memory: data reads. Instruction fetches are not reads
    bool writes = true;  ///< port: OUT; memory: data writes
    /// The interrupt; `instruction` means any.
    host_sim::StepRecord::Kind interrupt = host_sim::StepRecord::Kind::instruction;
    Condition condition;
    bool temporary = false;  ///< goes with its first hit

    unsigned id = 0;
    bool enabled = true;
    uint64_t ignore = 0;  ///< so many further hits do not stop
    uint64_t hits = 0;    ///< while the condition held, ignored ones included

    /// What it waits for: "write 8000H to 80FFH if A == 5".
    [[nodiscard]] std::string text(const Names& names) const;
};

class Breakpoints {
public:
    /// @return its number, from 1 on and never used again
    unsigned add(Breakpoint breakpoint);
    /// @errors DebugError when there is none
    Breakpoint& at(unsigned id);
    void remove(unsigned id);
    void clear();
    void set_enabled(unsigned id, bool enabled);
    [[nodiscard]] const std::vector<Breakpoint>& list() const { return list_; }
    [[nodiscard]] bool any_enabled() const;

    /// Whether an enabled one waits at this address. Costs next to nothing.
    [[nodiscard]] bool waits_at(uint16_t pc) const { return addresses_[pc]; }
    /// The one that stops before the instruction at PC. Counts, and removes a temporary one.
    std::optional<Breakpoint> before(const host_sim::BoardState& state);
    /// The one that stops behind this step. Counts, and removes a temporary one.
    std::optional<Breakpoint> behind(const host_sim::StepRecord& record,
                                     const host_sim::BoardState& state) {
        if (!observes_) return std::nullopt;
        return find_behind(record, state);
    }

private:
    std::optional<Breakpoint> find_behind(const host_sim::StepRecord& record,
                                          const host_sim::BoardState& state);
    static bool stops(Breakpoint& breakpoint, const host_sim::BoardState& state);
    std::optional<Breakpoint> hit(std::size_t index);
    void index();

    std::vector<Breakpoint> list_;
    std::bitset<0x10000> addresses_;
    bool observes_ = false;
    unsigned next_id_ = 1;
};

/// The access of a step that a port or memory breakpoint waits for, or null.
[[nodiscard]] const host_sim::BusAccess* matching_access(const Breakpoint& breakpoint,
                                                         const host_sim::StepRecord& record);

/// The name of an interrupt: "TRAP", "RST 7.5" ...; "any interrupt" for `instruction`.
[[nodiscard]] std::string interrupt_name(host_sim::StepRecord::Kind kind);

}  // namespace debug_console
