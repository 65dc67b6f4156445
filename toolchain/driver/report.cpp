// report.cpp - see report.hpp.
#include "toolchain/driver/report.hpp"

#include <fmt/format.h>

#include <map>

#include "toolchain/asm/map_file.hpp"

namespace toolchain::driver {
namespace {

std::string t_text(const std::optional<assembly::TStates>& t) {
    if (!t) return "";
    return t->least == t->most ? fmt::format("{}", t->most)
                               : fmt::format("{}..{}", t->least, t->most);
}

std::string use_text(const char* name, uint32_t used, assembly::AddressRange range) {
    return fmt::format("{} {} of {} bytes ({:04X}H-{:04X}H)\n", name, used, range.size(),
                       range.first, range.last);
}

/// Who calls whom, a line for each function that calls.
std::string calls_text(const Result& result) {
    std::map<std::string, std::string> titles;
    for (const assembly::FunctionSizes& function : assembly::function_sizes(result.program)) {
        if (!function.title.empty()) titles[function.name] = function.title;
    }
    const auto title = [&](const std::string& name) {
        const auto found = titles.find(name);
        return found == titles.end() ? name : found->second;
    };
    std::string text;
    for (const codegen::FunctionReport& function : result.compiled.functions) {
        if (function.callees.empty()) continue;
        text += fmt::format("{} calls", title(function.name));
        const char* between = " ";
        for (const std::string& callee : function.callees) {
            text += fmt::format("{}{}", between, title(callee));
            between = "; ";
        }
        text += "\n";
    }
    return text;
}

}  // namespace

std::string report_text(const Result& result) {
    std::map<std::string, const codegen::FunctionReport*> known;
    for (const codegen::FunctionReport& function : result.compiled.functions) {
        known[function.name] = &function;
    }
    std::string text = fmt::format("{:>5} {:>6} {:>6} {:>6} {:>6} {:>12}  {}\n", "at", "ROM", "RAM",
                                   "frame", "stack", "T-states", "function");
    for (const assembly::FunctionSizes& function : assembly::function_sizes(result.program)) {
        const auto found = known.find(function.name);
        std::string frame;
        std::string stack = function.stack_bytes ? fmt::format("{}", *function.stack_bytes) : "";
        if (found != known.end()) {
            frame = fmt::format("{}", found->second->frame_bytes);
            stack = fmt::format("{}{}", found->second->stack_bytes,
                                found->second->recursive ? "+" : "");
        }
        text += fmt::format("{:04X}H {:>6} {:>6} {:>6} {:>6} {:>12}  {}\n", function.address,
                            function.rom_bytes, function.ram_bytes, frame, stack,
                            t_text(function.t_states),
                            function.title.empty() ? function.name : function.title);
    }
    text += calls_text(result);
    const assembly::Program& program = result.program;
    uint32_t rom = program.data_image.size;
    uint32_t ram = program.frames.size + program.stack.size;
    for (const assembly::PlacedSection& placed : program.sections) {
        if (assembly::in_rom(placed.section.kind)) {
            rom += placed.size;
        } else if (placed.section.kind != assembly::SectionKind::frame) {
            ram += placed.size;
        }
    }
    text += use_text("ROM", rom, program.rom);
    text += use_text("RAM", ram, program.ram);
    text += fmt::format("    frames {}, data {}, cleared {}, stack {}{}\n", program.frames.size,
                        program.data.size, program.zero.size, program.stack.size,
                        result.compiled.stack_known ? "" : " (recursion: no bound is known)");
    return text;
}

std::string times_text(const Result& result) {
    std::string text;
    double sum = 0;
    for (const PhaseTime& phase : result.times) {
        text += fmt::format("{:<12} {:8.3f} s\n", phase.name, phase.seconds);
        sum += phase.seconds;
    }
    return text + fmt::format("{:<12} {:8.3f} s\n", "all", sum);
}

}  // namespace toolchain::driver
