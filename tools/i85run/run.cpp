#include "tools/i85run/run.hpp"

#include <algorithm>
#include <cassert>

namespace i85run {
namespace {

using host_sim::StepRecord;

void show(const RunRequest& request, const StepRecord& record, const Machine& machine) {
    for (const Observer& observer : request.observers) observer(record, machine.cpu);
}

/// The observed counterpart of Machine::run.
Stop step_until(Machine& machine, const RunRequest& request, uint64_t until_t) {
    StepRecord record;
    for (;;) {
        if (machine.cpu.t >= until_t && !machine.at_trap()) return Stop::time_limit;
        const uint64_t before = machine.cpu.instructions;
        const Stop stop = machine.step(record);
        if (machine.cpu.instructions != before) show(request, record, machine);
        if (stop != Stop::time_limit) return stop;
    }
}

/// @return whether the program goes on
bool serve_trap(Machine& machine, const RunRequest& request) {
    StepRecord record;
    if (!request.serve_trap || !request.serve_trap(machine, record)) return false;
    show(request, record, machine);
    return true;
}

End end_of(Stop stop) {
    switch (stop) {
        case Stop::halted:
            return End::halt;
        case Stop::undefined_instruction:
            return End::undefined_instruction;
        case Stop::rom_write:
            return End::rom_write;
        case Stop::time_limit:
        case Stop::trap:
            break;
    }
    assert(false && "time and traps are dealt with by the caller");
    return End::time_limit;
}

}  // namespace

End run_to_end(Machine& machine, const RunRequest& request) {
    for (;;) {
        const uint64_t t = machine.cpu.t;
        const uint64_t until_t = t < request.max_t ? t + std::min(kSliceT, request.max_t - t) : t;
        const Stop stop = request.observers.empty() ? machine.run(until_t)
                                                    : step_until(machine, request, until_t);
        if (stop == Stop::trap) {
            if (!serve_trap(machine, request)) return request.end_at_trap;
        } else if (stop != Stop::time_limit) {
            return end_of(stop);
        } else if (machine.cpu.t >= request.max_t) {
            return End::time_limit;
        } else if (request.between_slices) {
            if (const std::optional<End> end = request.between_slices(machine)) return *end;
        }
    }
}

}  // namespace i85run
