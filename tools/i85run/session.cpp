#include "tools/i85run/session.hpp"

#include <fmt/format.h>

#include <csignal>
#include <optional>
#include <span>
#include <vector>

#include "tools/i85run/console.hpp"
#include "tools/i85run/cpm.hpp"
#include "tools/i85run/entry.hpp"
#include "tools/i85run/function_count.hpp"
#include "tools/i85run/observations.hpp"
#include "tools/i85run/output_file.hpp"
#include "tools/i85run/program.hpp"
#include "tools/i85run/report.hpp"
#include "tools/i85run/run.hpp"

namespace i85run {
namespace {

volatile std::sig_atomic_t interrupt_requested = 0;

/// The first Ctrl-C ends the run with its results; a second one ends i85run.
void watch_for_interrupt() {
    std::signal(SIGINT, [](int) {
        interrupt_requested = 1;
        std::signal(SIGINT, SIG_DFL);
    });
}

std::vector<DumpPlace> resolve_dumps(const Program& program, const Options& options) {
    std::vector<DumpPlace> places;
    for (const std::string& text : options.dumps) places.push_back(resolve_dump(program, text));
    return places;
}

std::optional<CountedFunction> counted_function(const Program& program, const Options& options) {
    if (options.count_function.empty()) return std::nullopt;
    return CountedFunction{
        options.count_function,
        FunctionCount(resolve_address(program, "--count-function", options.count_function))};
}

std::vector<Dump> read_dumps(const Machine& machine, const std::vector<DumpPlace>& places) {
    std::vector<Dump> dumps;
    for (const DumpPlace& place : places) {
        const auto bytes = std::span(machine.memory.bytes).subspan(place.address, place.length);
        dumps.push_back({place.name, place.address, {bytes.begin(), bytes.end()}});
    }
    return dumps;
}

/// Prepares machine and request for a CP/M program.
void enter_cpm(Machine& machine, const Program& program, Cpm& cpm, RunRequest& request) {
    const auto extent = *program.image.extent();
    cpm.start(
        machine,
        std::span(program.image.bytes).subspan(extent.first, extent.last - extent.first + 1U));
    request.end_at_trap = End::warm_boot;
    request.serve_trap = [&cpm](Machine& at_trap, host_sim::StepRecord& record) {
        return cpm.serve_trap(at_trap, record);
    };
}

/// Runs to the end, or until the user or a lost return address ends it.
End run_watched(Machine& machine, RunRequest& request, Console& console,
                std::optional<uint16_t> needed_trap) {
    watch_for_interrupt();
    const auto lost = [&machine, needed_trap] {
        return needed_trap && return_is_lost(machine, *needed_trap);
    };
    request.between_slices = [&](const Machine& running) -> std::optional<End> {
        console.update(running);
        if (interrupt_requested != 0) return End::interrupted;
        if (lost()) return End::return_lost;
        return std::nullopt;
    };
    const End end = run_to_end(machine, request);
    console.finish();
    return lost() ? End::return_lost : end;
}

}  // namespace

int run_session(const Options& options) {
    const Program program = load_program(options);
    const std::vector<DumpPlace> places = resolve_dumps(program, options);
    Results results;
    results.function = counted_function(program, options);
    results.rom = options.rom;

    Machine machine(options.instruction_set);
    Console console;
    Cpm cpm(console.for_cpm());
    RunRequest request;
    request.max_t = options.max_t;
    std::optional<uint16_t> needed_trap;
    if (options.cpm) {
        enter_cpm(machine, program, cpm, request);
    } else {
        const auto trap = enter_program(machine, program, options);
        if (!options.entry.empty()) needed_trap = trap;
    }
    if (options.rom) machine.protect(*options.rom, options.strict);
    if (results.function) {
        request.observers.emplace_back(
            [&results](const host_sim::StepRecord& step, const host_sim::CpuState&) {
                results.function->count.observe(step);
            });
    }
    Observations observations(machine, program, options);
    observations.attach(request);
    std::optional<OutputFile> json;
    if (!options.json.empty()) json.emplace(options.json);

    results.end = run_watched(machine, request, console, needed_trap);
    results.pc = machine.cpu.pc;
    results.instructions = machine.cpu.instructions;
    results.t_states = machine.cpu.t;
    results.rom_write_count = machine.rom_write_count();
    results.first_rom_write = machine.first_rom_write();
    results.dumps = read_dumps(machine, places);
    fmt::print("{}{}", text_report(results), observations.finish());
    if (json) {
        json->stream() << json_report(results);
        json->close();
    }
    return finished(results.end) ? kExitPass : kExitUnfinished;
}

}  // namespace i85run
