#include "tools/i85run/function_count.hpp"

#include <algorithm>

namespace i85run {
namespace {

using host_sim::StepRecord;

bool may_return(const StepRecord& record) {
    constexpr uint8_t kRet = 0xC9, kPchl = 0xE9;
    if (record.kind != StepRecord::Kind::instruction) return false;
    const uint8_t opcode = record.opcode();
    const bool conditional = (opcode & 0xC7) == 0xC0;
    return opcode == kRet || opcode == kPchl || (conditional && record.next_sp != record.sp);
}

/// Whether `sp` is above `entry_sp`; the stack may wrap around the end of memory.
bool is_above(uint16_t sp, uint16_t entry_sp) {
    return static_cast<int16_t>(static_cast<uint16_t>(sp - entry_sp)) > 0;
}

}  // namespace

void FunctionCount::observe(const StepRecord& record) {
    if (!active_ && record.pc == address_) {
        active_ = true;
        entry_sp_ = record.sp;
        entry_t_ = record.t_begin;
    }
    if (!active_ || !may_return(record) || !is_above(record.next_sp, entry_sp_)) return;
    active_ = false;
    const uint64_t t_states = record.t_end - entry_t_;
    ++calls_;
    t_states_ += t_states;
    worst_ = std::max(worst_, t_states);
}

}  // namespace i85run
