// steps.hpp - step records made by hand, so that trace, profile and coverage are tested without an
// interpreter. T-states are those of Intel's tables, written where they are used.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "host_sim/cpu/step_record.hpp"

namespace trace_test {

using host_sim::BusAccess;
using host_sim::StepRecord;

/// Appends an access to a record.
inline void add_access(StepRecord& step, BusAccess::Kind kind, unsigned address, unsigned value) {
    step.accesses[step.access_count++] = {kind, static_cast<uint16_t>(address),
                                          static_cast<uint8_t>(value), step.t_end};
}

/// An instruction's record with its code bytes as accesses.
inline StepRecord instruction(unsigned pc, const std::vector<unsigned>& code, uint64_t t_begin,
                              uint64_t t) {
    StepRecord step;
    step.pc = static_cast<uint16_t>(pc);
    step.next_pc = static_cast<uint16_t>(pc + code.size());
    step.t_begin = t_begin;
    step.t_end = t_begin + t;
    for (std::size_t i = 0; i < code.size(); ++i) {
        add_access(step, i == 0 ? BusAccess::Kind::fetch : BusAccess::Kind::operand,
                   static_cast<unsigned>(pc + i), code[i]);
    }
    return step;
}

/// A processor of which only PC, SP and time exist; each method is one step (or `count` of them).
class Steps {
public:
    explicit Steps(std::function<void(const StepRecord&)> sink, unsigned pc = 0x0100,
                   unsigned sp = 0x9000)
        : sink_(std::move(sink)), pc_(static_cast<uint16_t>(pc)), sp_(static_cast<uint16_t>(sp)) {}

    void nop(unsigned count = 1) {  // 4 T each
        for (; count > 0; --count) go({0x00}, 4, pc_ + 1u, sp_);
    }
    void call(unsigned target) { go({0xCD, 0, 0}, 18, target, sp_ - 2u); }
    void call_not_taken() { go({0xC4, 0}, 9, pc_ + 3u, sp_); }
    void call_taken_if(unsigned target) { go({0xC4, 0, 0}, 18, target, sp_ - 2u); }
    void rst(unsigned number) { go({0xC7 | number << 3}, 12, number * 8, sp_ - 2u); }
    void ret(unsigned to) { go({0xC9}, 10, to, sp_ + 2u); }
    void ret_taken_if(unsigned to) { go({0xC0}, 12, to, sp_ + 2u); }
    void ret_not_taken() { go({0xC0}, 6, pc_ + 1u, sp_); }
    void jump(unsigned to) { go({0xC3, 0, 0}, 10, to, sp_); }
    void pchl(unsigned to) { go({0xE9}, 6, to, sp_); }
    void push() { go({0xE5}, 12, pc_ + 1u, sp_ - 2u); }
    void pop() { go({0xE1}, 10, pc_ + 1u, sp_ + 2u); }
    void set_sp(unsigned sp) { go({0xF9}, 6, pc_ + 1u, sp); }
    void hlt() { go({0x76}, 5, pc_ + 1u, sp_); }
    void halted(uint64_t t) { special(StepRecord::Kind::halt, t, pc_, sp_); }
    void interrupt(StepRecord::Kind kind, unsigned vector) {  // 12 T
        special(kind, 12, vector, sp_ - 2u);
    }

    [[nodiscard]] unsigned pc() const { return pc_; }
    [[nodiscard]] unsigned sp() const { return sp_; }
    [[nodiscard]] uint64_t t() const { return t_; }

private:
    void go(const std::vector<unsigned>& code, uint64_t t, unsigned next_pc, unsigned next_sp) {
        finish(instruction(pc_, code, t_, t), next_pc, next_sp);
    }
    void special(StepRecord::Kind kind, uint64_t t, unsigned next_pc, unsigned next_sp) {
        StepRecord step;
        step.kind = kind;
        step.pc = pc_;
        step.t_begin = t_;
        step.t_end = t_ + t;
        finish(step, next_pc, next_sp);
    }
    void finish(StepRecord step, unsigned next_pc, unsigned next_sp) {
        step.sp = sp_;
        step.next_pc = static_cast<uint16_t>(next_pc);
        step.next_sp = static_cast<uint16_t>(next_sp);
        pc_ = step.next_pc;
        sp_ = step.next_sp;
        t_ = step.t_end;
        sink_(step);
    }

    std::function<void(const StepRecord&)> sink_;
    uint16_t pc_;
    uint16_t sp_;
    uint64_t t_ = 0;
};

}  // namespace trace_test
