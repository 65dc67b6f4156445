// controller_comparison.cpp - see controller_comparison.hpp.
#include "tests/target/controller_comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "firmware/executive/controller.hpp"
#include "host_sim/world/input_walk.hpp"

namespace target_test {

namespace {

/// The first byte that differs, or empty.
std::string difference(const std::string& name, const std::vector<uint8_t>& seen,
                       const Record& wanted) {
    for (std::size_t i = 0; i < wanted.bytes().size(); ++i) {
        if (seen[i] == wanted.bytes()[i]) continue;
        return fmt::format("{}: {} is {:02X} on the target, {:02X} on the host", name,
                           wanted.name_at(i), seen[i], wanted.bytes()[i]);
    }
    return {};
}

}  // namespace

toolchain::driver::Request firmware_request(const Level& level) {
    const std::string root = ROVER_SOURCE_DIR;
    toolchain::driver::Request made = request(level);
    made.sources = {{.path = root + "/tests/target/controller_program.cpp"}};
    made.front_end = {"-I" + root, "-I" + root + "/firmware/config/native"};
    made.keep = {"target_request",    "target_calibration", "target_inputs", "target_commands",
                 "target_controller", "target_reset",       "target_step"};
    return made;
}

InterpretedMailbox::InterpretedMailbox(const toolchain::codegen::Module& module)
    : machine_(module) {
    machine_.step_limit = ~uint64_t{0};
}

void InterpretedMailbox::reset(const Record& calibration) {
    put("target_calibration", calibration);
    machine_.call("target_reset");
}

void InterpretedMailbox::step(const Record& inputs) {
    put("target_inputs", inputs);
    machine_.call("target_step");
}

std::vector<uint8_t> InterpretedMailbox::variable(const std::string& name, std::size_t size) {
    const auto* from = &machine_.memory[machine_.address(name)];
    return {from, from + size};
}

void InterpretedMailbox::put(const std::string& name, const Record& record) {
    std::ranges::copy(record.bytes(), &machine_.memory[machine_.address(name)]);
}

ImageMailbox::ImageMailbox(const toolchain::assembly::Program& program,
                           host_sim::InstructionSet set)
    : machine_(program, set) {
    machine_.run();
}

void ImageMailbox::reset(const Record& calibration) {
    put("target_calibration", calibration);
    machine_.write(machine_.address("target_request"), 1, 0);
    machine_.run();
}

void ImageMailbox::step(const Record& inputs) {
    put("target_inputs", inputs);
    machine_.write(machine_.address("target_request"), 1, 1);
    step_t_ = machine_.run();
}

std::vector<uint8_t> ImageMailbox::variable(const std::string& name, std::size_t size) {
    check_size(name, size);
    const auto bytes = machine_.bytes(machine_.address(name), machine_.size(name));
    return {bytes.begin(), bytes.end()};
}

void ImageMailbox::put(const std::string& name, const Record& record) {
    check_size(name, record.bytes().size());
    machine_.write(machine_.address(name), record.bytes());
}

void ImageMailbox::check_size(const std::string& name, std::size_t size) const {
    if (machine_.size(name) == size) return;
    throw std::runtime_error(
        fmt::format("{} has {} bytes, its record {}: a field is missing in "
                    "records.cpp",
                    name, machine_.size(name), size));
}

void Reached::add(const rover::Estimates& estimates) {
    ++modes[static_cast<std::size_t>(estimates.mode)];
    for (unsigned bit = 0; bit < 8; ++bit) {
        events[bit] += estimates.events >> bit & 1U;
        faults[bit] += estimates.faults >> bit & 1U;
    }
}

Comparison compare(Mailbox& target, uint64_t seed, uint64_t cycles,
                   const std::function<void(bool)>& after_step) {
    Comparison result;
    host_sim::InputWalk walk(seed);
    rover::Controller native;
    hal::Commands commands;
    while (result.cycles < cycles && result.difference.empty()) {
        const host_sim::InputWalk::Next next = walk.next(commands);
        if (next.reset) {
            rover::controller_reset(native, next.calibration);
            target.reset(record_of(next.calibration));
        }
        target.step(record_of(next.inputs));
        commands = rover::controller_step(native, next.inputs);
        for (const auto& [name, wanted] : {std::pair("target_commands", record_of(commands)),
                                           std::pair("target_controller", record_of(native))}) {
            const auto seen = target.variable(name, wanted.bytes().size());
            if (result.difference.empty()) result.difference = difference(name, seen, wanted);
        }
        const bool cycle = (native.estimates.events & rover::kEventCycle) != 0;
        result.cycles += cycle ? 1 : 0;
        ++result.steps;
        result.reached.add(native.estimates);
        after_step(cycle);
    }
    if (!result.difference.empty()) {
        result.difference =
            fmt::format("seed {}, step {}: {}", seed, result.steps, result.difference);
    }
    return result;
}

}  // namespace target_test
