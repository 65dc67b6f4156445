// subject.cpp - see subject.hpp.
#include "tests/toolchain/csmith/subject.hpp"

#include <fmt/format.h>

#include <charconv>
#include <stdexcept>
#include <utility>

#include "tests/toolchain/codegen/interpreter.hpp"
#include "tests/toolchain/csmith/process.hpp"
#include "toolchain/driver/driver.hpp"

namespace csmith_test {

namespace {

constexpr unsigned kSeconds = 60;
constexpr uint64_t kSteps = 20'000'000;

using toolchain::ir::Optimisation;

Optimisation level_of(const std::string& level) {
    if (level == "0") return Optimisation::none;
    if (level == "1") return Optimisation::less;
    if (level == "2") return Optimisation::more;
    return Optimisation::size;
}

toolchain::driver::Request request_for(const Program& program, const std::string& level,
                                       std::string& messages) {
    toolchain::driver::Request request;
    request.sources = {{program.source.string()}};
    request.level = level_of(level);
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

/// "KIND TEXT" as an observation.
Observation parse(std::string_view line) {
    using Kind = Observation::Kind;
    for (const auto& [word, kind] :
         {std::pair{"no-end ", Kind::no_end}, std::pair{"refused ", Kind::refused},
          std::pair{"failed ", Kind::failed}, std::pair{"checksum ", Kind::checksum}}) {
        if (!line.starts_with(word)) continue;
        line.remove_prefix(std::string_view(word).size());
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
    const bool internal = text.find("internal error") != std::string_view::npos;
    return fmt::format("{} {}", internal ? "failed" : "refused", text);
}

}  // namespace

Subject observe_subject(const Program& program, const std::string& level, const Meddle& meddle) {
    const Ran ran = run_apart(
        [&](const Say& say) {
            std::string messages;
            try {
                auto module =
                    toolchain::driver::compile_to_mir(request_for(program, level, messages));
                if (meddle) meddle(module);
                say(run_mir(module));
            } catch (const toolchain::driver::Failed& error) {
                say(text_of(error) + "\n" + messages);
            }
        },
        kSeconds);
    Subject result{parse(ran.text)};
    if (ran.end == Ran::End::crashed)
        result.mir = {Observation::Kind::failed, 0, fmt::format("signal {}", ran.status)};
    if (ran.end == Ran::End::out_of_time)
        result.mir = {Observation::Kind::failed, 0, fmt::format("more than {} s", kSeconds)};
    return result;
}

}  // namespace csmith_test
