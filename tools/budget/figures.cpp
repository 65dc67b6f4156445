// figures.cpp - see figures.hpp.
#include "tools/budget/figures.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "tools/budget/budget_error.hpp"

namespace rover_budget {
namespace {

/// "RST 7.5" -> "rst75".
std::string key_of(std::string_view name) {
    std::string key;
    for (const char letter : name) {
        if (letter == ' ' || letter == '.') continue;
        key += letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    }
    return key;
}

void add_modules(Numbers& numbers, const Figures& figures) {
    for (std::size_t i = 0; i < figures.modules.size(); ++i) {
        const ModuleBytes& bytes = figures.placement.bytes[i];
        const StepTime& time = figures.profile.modules[i];
        if (bytes.rom == 0 && bytes.ram == 0 && time.total_t == 0) continue;
        const std::string prefix = "module." + figures.modules[i].name + ".";
        numbers[prefix + "rom_bytes"] = bytes.rom;
        numbers[prefix + "ram_bytes"] = bytes.ram;
        numbers[prefix + "stack_bytes"] = bytes.stack;
        // Library time is its callers', idle time is what is left over.
        const ModuleKind kind = figures.modules[i].kind;
        if (kind == ModuleKind::library || kind == ModuleKind::idle) continue;
        numbers[prefix + "t_states_total"] = time.total_t;
        numbers[prefix + "t_states_worst"] = time.worst_t;
        if (is_spread(figures, i)) numbers[prefix + "t_states_worst_run"] = time.worst_run_t;
    }
}

uint64_t number_of(const std::string& text, std::string_view file, std::size_t line) {
    uint64_t value = 0;
    const auto [at, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || at != text.data() + text.size()) {
        throw BudgetError(file, line, "\"" + text + "\" is not a count",
                          "write the file with `opcount --budget`");
    }
    return value;
}

}  // namespace

bool is_spread(const Figures& figures, std::size_t module) {
    const StepTime& time = figures.profile.modules[module];
    return figures.modules[module].kind == ModuleKind::step && time.worst_run_t > time.worst_t &&
           2 * time.steps < figures.profile.steps;
}

double mean_t(const Figures& figures, const StepTime& time) {
    const uint64_t steps = figures.profile.steps;
    return steps == 0 ? 0.0 : static_cast<double>(time.total_t) / static_cast<double>(steps);
}

uint64_t interrupt_share_e4(const ProfileFigures& profile) {
    if (profile.total_t == 0) return 0;
    return (profile.interrupts.total_t * 10'000 + profile.total_t - 1) / profile.total_t;
}

Numbers numbers_of(const Figures& figures) {
    const ProfileFigures& profile = figures.profile;
    Numbers numbers;
    numbers["image.rom_bytes"] = figures.rom_bytes;
    numbers["image.ram_bytes"] = figures.ram_bytes;
    numbers["image.frame_bytes"] = figures.frame_bytes;
    numbers["image.stack_bytes"] = figures.stack_bytes;
    numbers["image.stack_bytes_seen"] = profile.stack_bytes;
    numbers["steps"] = profile.steps;
    numbers["boot.t_states_worst"] = profile.boot_t;
    numbers["step.t_states_total"] = profile.main_line.total_t;
    numbers["step.t_states_worst"] = profile.main_line.worst_t;
    numbers["interrupts.t_states_total"] = profile.interrupts.total_t;
    numbers["interrupts.t_states_worst"] = profile.interrupts.worst_t;
    numbers["interrupts.share_e4"] = interrupt_share_e4(profile);
    uint64_t latency = 0;
    for (std::size_t i = 0; i < kInterruptInputCount; ++i) {
        const InterruptTime& input = profile.inputs[i];
        if (input.accepted == 0) continue;
        const std::string prefix =
            "interrupt." + key_of(input_name(static_cast<InterruptInput>(i))) + ".";
        numbers[prefix + "accepted"] = input.accepted;
        numbers[prefix + "t_states_total"] = input.total_t;
        numbers[prefix + "t_states_worst"] = input.worst_t;
        numbers[prefix + "latency_worst"] = input.worst_latency_t;
        latency = std::max(latency, input.worst_latency_t);
    }
    numbers["interrupts.latency_worst"] = latency;
    add_modules(numbers, figures);
    return numbers;
}

Operations parse_operations(std::string_view text, std::string_view file) {
    Operations operations;
    std::istringstream lines{std::string(text)};
    std::size_t number = 0;
    bool complete = false;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        const std::size_t first = line.find(',');
        const std::size_t second = first == std::string::npos ? first : line.find(',', first + 1);
        if (line.starts_with('#') || second == std::string::npos) continue;
        const std::string name = line.substr(0, first);
        const std::string total = line.substr(first + 1, second - first - 1);
        if (name == "cycles") operations.cycles = number_of(total, file, number);
        if (name != "all") continue;
        operations.total = number_of(total, file, number);
        operations.worst = number_of(line.substr(second + 1), file, number);
        complete = true;
    }
    if (!complete || operations.cycles == 0) {
        throw BudgetError(file, 0, "has no line for `cycles` or `all`",
                          "write the file with `opcount --budget`");
    }
    return operations;
}

}  // namespace rover_budget
