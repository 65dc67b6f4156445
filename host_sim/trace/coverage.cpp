// coverage.cpp - counting; listing.cpp and lcov.cpp write the result.
#include "host_sim/trace/coverage.hpp"

#include <fmt/format.h>

#include <iterator>

#include "toolchain/isa/instruction_set.hpp"

namespace host_sim {

void Coverage::observe(const StepRecord& step) {
    if (step.kind == StepRecord::Kind::instruction) {
        ++opcodes_[step.opcode()];
        ++executed_[step.pc];
    }
    for (std::size_t i = 0; i < step.access_count; ++i) {
        const BusAccess& access = step.accesses[i];
        if (access.kind == BusAccess::Kind::read) ++read_[access.address];
        if (access.kind == BusAccess::Kind::write) ++written_[access.address];
    }
}

std::string Coverage::opcode_text() const {
    std::string text;
    for (const bool documented : {true, false}) {
        unsigned all = 0;
        unsigned executed = 0;
        std::string missing;
        for (const auto& entry : toolchain::isa::instruction_set()) {
            if (entry.documented != documented) continue;
            ++all;
            if (opcodes_[entry.opcode] != 0) {
                ++executed;
            } else {
                if (!missing.empty()) missing += "; ";
                missing += entry.text();
            }
        }
        fmt::format_to(std::back_inserter(text), "{} of {} {} opcodes executed{}{}\n", executed,
                       all, documented ? "documented" : "undocumented",
                       missing.empty() ? "" : "; not: ", missing);
    }
    return text;
}

}  // namespace host_sim
