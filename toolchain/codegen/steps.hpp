// steps.hpp - the steps that make code better, by name, so that one of them can be left out: to
// measure what it brings, or to see whether a fault is its own. Code is right without any of them.
// Depends on   the standard library.
// Design note  docs/design/optimisations.md
// How to add   a value here and a line in steps.cpp; where the step is taken, ask for it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace toolchain {

enum class Step : uint8_t {
    // Of LLVM's representation.
    operation_costs,
    counting_loops,
    fixed_places,
    stepped_pointers,
    counting_down,
    pages,
    narrow_values,
    chosen_results,
    near_use,
    // Of the back end's, and code.
    narrow_calls,
    passages,
    homes,
    detours,
    carry_answers,
    carry_signs,
    word_chains,
    clean_up,
    early_loads,
    merged_tails,
    short_forms,
    tail_calls,
    // Undocumented instructions.
    lhlx,
    shlx,
    dsub,
    arhl,
    rdel,
    ldhi,
    less_by_k,
    zero_by_k,
};

struct StepName {
    Step step;
    std::string_view name;  ///< as `i85cc --without` takes it
    std::string_view what;
    std::string_view where;     ///< source, under toolchain/
    bool undocumented = false;  ///< for --cpu=8085u alone
};

/// All of them, in the order of Step.
[[nodiscard]] std::span<const StepName> step_names();

/// nullopt: there is no such step.
[[nodiscard]] std::optional<Step> step_named(std::string_view name);

/// A set of steps: at first all of them.
class Steps {
public:
    [[nodiscard]] constexpr bool contains(Step step) const { return (left_out_ & bit(step)) == 0; }
    constexpr void leave_out(Step step) { left_out_ |= bit(step); }
    /// Those for documented instructions only.
    [[nodiscard]] Steps documented() const;

    bool operator==(const Steps&) const = default;

private:
    [[nodiscard]] static constexpr uint32_t bit(Step step) {
        return uint32_t{1} << static_cast<unsigned>(step);
    }
    uint32_t left_out_ = 0;
};

}  // namespace toolchain
