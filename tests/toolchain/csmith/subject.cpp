// subject.cpp - see subject.hpp.
#include "tests/toolchain/csmith/subject.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

#include "host_sim/cpu/flat_machine.hpp"
#include "tests/toolchain/codegen/interpreter.hpp"
#include "tests/toolchain/csmith/process.hpp"
#include "toolchain/driver/driver.hpp"

namespace csmith_test {

namespace {

constexpr unsigned kSeconds = 60;
constexpr uint64_t kSteps = 20'000'000;
constexpr uint64_t kStates = 4'000'000'000;  // 22 minutes at 3 MHz
constexpr toolchain::assembly::AddressRange kRom{0x0000, 0xCFFF};
constexpr toolchain::assembly::AddressRange kRam{0xD000, 0xFFFF};

using toolchain::ir::Optimisation;

Optimisation level_of(const std::string& level) {
    if (level == "0") return Optimisation::none;
    if (level == "1") return Optimisation::less;
    if (level == "2") return Optimisation::more;
    return Optimisation::size;
}

toolchain::driver::Request request_for(const Program& program, const SubjectOptions& options,
                                       std::string& messages) {
    toolchain::driver::Request request;
    request.sources = {{program.source.string()}};
    request.level = level_of(options.level);
    request.search_budget = options.search_budget;
    request.undocumented = options.undocumented;
    request.steps = options.steps;
    request.rom = kRom;
    request.ram = kRam;
    request.front_end = {"-std=gnu99"};
    for (const std::string& option : include_options()) request.front_end.push_back(option);
    for (const std::string& option : program.options) request.front_end.push_back(option);
    request.jobs = 1;
    request.messages = [&messages](std::string_view text) { messages += text; };
    return request;
}

std::string run_mir(const toolchain::codegen::Module& module) {
    codegen_test::Interpreter machine(module);
    machine.step_limit = kSteps;
    try {
        machine.call("main");
    } catch (const std::runtime_error& error) {
        if (machine.steps >= kSteps) return fmt::format("no-end {} steps", kSteps);
        return std::string("failed ") + error.what();
    }
    if (machine.variable("rover_done", 1) != 1) return "failed main returned without a checksum";
    return fmt::format("checksum {:08X}", machine.variable("rover_checksum", 4));
}

std::string run_image(const toolchain::assembly::Program& program, bool undocumented) {
    host_sim::FlatMachine machine(undocumented ? host_sim::InstructionSet::all
                                               : host_sim::InstructionSet::documented);
    for (std::size_t i = 0; i < program.image.bytes.size(); ++i) {
        // RAM is never clear when power comes on.
        machine.memory.bytes.at(i) = program.image.present.test(i) ? program.image.bytes[i] : 0xA5;
    }
    const auto loaded = machine.memory.bytes;
    switch (machine.run(kStates)) {
        case host_sim::RunEnd::halted:
            break;
        case host_sim::RunEnd::time_limit:
            return fmt::format("no-end {} T-states", kStates);
        default:
            return fmt::format("failed undefined instruction at {:04X}H", machine.cpu.pc);
    }
    if (!std::equal(loaded.begin(), loaded.begin() + kRom.last + 1, machine.memory.bytes.begin()))
        return "failed a store into ROM";
    const auto number = [&](const char* name, unsigned size) {
        const toolchain::assembly::Symbol* symbol = program.find(name);
        if (symbol == nullptr) throw std::runtime_error(fmt::format("no symbol {}", name));
        uint32_t value = 0;
        for (unsigned i = size; i-- > 0;)
            value = value << 8 | machine.memory.bytes.at((symbol->value + i) & 0xFFFF);
        return value;
    };
    if (number("rover_done", 1) != 1) return "failed halted without a checksum";
    return fmt::format("checksum {:08X}", number("rover_checksum", 4));
}

/// "KIND TEXT" as an observation.
Observation parse(std::string_view line) {
    using Kind = Observation::Kind;
    static constexpr std::array<std::pair<std::string_view, Kind>, 5> kWords = {{
        {"checksum ", Kind::checksum},
        {"no-end ", Kind::no_end},
        {"refused ", Kind::refused},
        {"too-large ", Kind::too_large},
        {"failed ", Kind::failed},
    }};
    for (const auto& [word, kind] : kWords) {
        if (!line.starts_with(word)) continue;
        line.remove_prefix(word.size());
        Observation result{kind, 0, std::string(line)};
        if (kind == Kind::checksum) {
            std::from_chars(line.data(), line.data() + line.size(), result.checksum, 16);
            result.text.clear();
        }
        return result;
    }
    return {Kind::failed, 0, std::string(line)};
}

/// The compiler's own mistakes are no refusals.
std::string text_of(const toolchain::driver::Failed& error) {
    const std::string_view text = error.what();
    if (text.find("internal error") != std::string_view::npos)
        return fmt::format("failed {}", text);
    const bool full = text.find(" bytes needed, ") != std::string_view::npos;
    return fmt::format("{} {}", full ? "too-large" : "refused", text);
}

std::string compile_and_run(const toolchain::driver::Request& request, Layer layer,
                            const SubjectOptions& options) {
    if (layer == Layer::mir) {
        auto module = toolchain::driver::compile_to_mir(request);
        if (options.meddle_mir) options.meddle_mir(module);
        return run_mir(module);
    }
    toolchain::assembly::Program image = toolchain::driver::compile_program(request).program;
    if (options.meddle_image) options.meddle_image(image);
    return run_image(image, options.undocumented);
}

}  // namespace

Observation observe_subject(const Program& program, Layer layer, const SubjectOptions& options) {
    const Ran ran = run_apart(
        [&](const Say& say) {
            std::string messages;
            try {
                say(compile_and_run(request_for(program, options, messages), layer, options));
            } catch (const toolchain::driver::Failed& error) {
                say(text_of(error) + "\n" + messages);
            }
        },
        kSeconds);
    if (ran.end == Ran::End::crashed)
        return {Observation::Kind::failed, 0, fmt::format("signal {}", ran.status)};
    if (ran.end == Ran::End::out_of_time)
        return {Observation::Kind::failed, 0, fmt::format("more than {} s", kSeconds)};
    return parse(ran.text);
}

}  // namespace csmith_test
