#include "tools/i85run/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <span>

namespace i85run {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kClockHz = 3.072e6;      ///< the board
constexpr double kSlowClockHz = 2.000e6;  ///< the 80C85 of the first Mars rover

std::string end_name(End end) {
    switch (end) {
        case End::halt:
            return "halt";
        case End::returned:
            return "return";
        case End::warm_boot:
            return "warm_boot";
        case End::time_limit:
            return "time_limit";
        case End::undefined_instruction:
            return "undefined_instruction";
        case End::rom_write:
            return "rom_write";
        case End::return_lost:
            return "return_lost";
        case End::interrupted:
            return "interrupted";
    }
    return {};
}

std::string end_sentence(const Results& results) {
    switch (results.end) {
        case End::halt:
            return fmt::format("HLT at {:04X}h", static_cast<uint16_t>(results.pc - 1));
        case End::returned:
            return "the entry returned";
        case End::warm_boot:
            return "the program ended (warm boot)";
        case End::time_limit:
            return fmt::format("did not finish: --max-t reached at PC {:04X}h", results.pc);
        case End::undefined_instruction:
            return fmt::format(
                "did not finish: undocumented instruction at {:04X}h (--cpu 8085u runs it)",
                results.pc);
        case End::rom_write:
            return fmt::format("did not finish: stopped at a write to ROM (--strict)");
        case End::return_lost:
            return fmt::format(
                "did not finish: the program wrote over its return trap (see the guide on "
                "--entry)");
        case End::interrupted:
            return fmt::format("did not finish: interrupted at PC {:04X}h", results.pc);
    }
    return {};
}

double milliseconds(uint64_t t_states, double hz) {
    return static_cast<double>(t_states) * 1e3 / hz;
}

void add_line(std::string& text, std::string_view name, const std::string& value) {
    text += fmt::format("{:<13} {}\n", name, value);
}

void add_function(std::string& text, const CountedFunction& function) {
    const FunctionCount& count = function.count;
    add_line(
        text, "function",
        fmt::format("{}: {} calls, {} T-states in all, worst {}, mean {:.1f}{}", function.name,
                    count.calls(), count.t_states(), count.worst_t_states(), count.mean_t_states(),
                    count.active() ? "; one more had not returned at the end" : ""));
}

void add_rom_writes(std::string& text, const Results& results) {
    if (!results.rom) return;
    std::string value = fmt::format("{} to {:04X}h-{:04X}h", results.rom_write_count,
                                    results.rom->first, results.rom->last);
    if (const auto& first = results.first_rom_write) {
        value += fmt::format("; the first at PC {:04X}h, T {}: {:02X}h to {:04X}h", first->pc,
                             first->t, first->value, first->address);
    }
    add_line(text, "rom_writes", value);
}

std::string hex(std::span<const uint8_t> bytes, std::string_view separator) {
    return fmt::format("{:02x}", fmt::join(bytes, separator));
}

void add_dump(std::string& text, const Dump& dump) {
    constexpr std::size_t kBytesPerLine = 16;
    add_line(text, "dump",
             fmt::format("{}: {} bytes at {:04X}h", dump.name, dump.bytes.size(), dump.address));
    const std::span<const uint8_t> bytes(dump.bytes);
    for (std::size_t at = 0; at < bytes.size(); at += kBytesPerLine) {
        const auto line = bytes.subspan(at, std::min(kBytesPerLine, bytes.size() - at));
        add_line(text, fmt::format("  {:04X}h", dump.address + at), hex(line, " "));
    }
}

Json function_json(const CountedFunction& function) {
    const FunctionCount& count = function.count;
    return {{"name", function.name},
            {"calls", count.calls()},
            {"t_states", count.t_states()},
            {"t_states_worst", count.worst_t_states()},
            {"t_states_mean", count.mean_t_states()},
            {"unfinished", count.active()}};
}

Json rom_writes_json(const Results& results) {
    Json json = {{"count", results.rom_write_count}};
    if (const auto& first = results.first_rom_write) {
        json["first"] = {{"pc", first->pc},
                         {"t", first->t},
                         {"address", first->address},
                         {"value", first->value}};
    }
    return json;
}

}  // namespace

std::string text_report(const Results& results) {
    std::string text;
    add_line(text, "end", end_sentence(results));
    add_line(text, "instructions", std::to_string(results.instructions));
    add_line(text, "t_states", std::to_string(results.t_states));
    add_line(text, "time",
             fmt::format("{:.3f} ms at 3.072 MHz, {:.3f} ms at 2.000 MHz",
                         milliseconds(results.t_states, kClockHz),
                         milliseconds(results.t_states, kSlowClockHz)));
    if (results.function) add_function(text, *results.function);
    add_rom_writes(text, results);
    for (const Dump& dump : results.dumps) add_dump(text, dump);
    return text;
}

std::string json_report(const Results& results) {
    Json json;
    json["halted"] = finished(results.end);
    json["pc"] = results.pc;
    json["instructions"] = results.instructions;
    json["t_states"] = results.t_states;
    json["function_t_states"] = nullptr;
    json["dumps"] = Json::object();
    json["end"] = end_name(results.end);
    if (results.function) {
        json["function_t_states"] = results.function->count.t_states();
        json["function"] = function_json(*results.function);
    }
    for (const Dump& dump : results.dumps) json["dumps"][dump.name] = hex(dump.bytes, "");
    if (results.rom) json["rom_writes"] = rom_writes_json(results);
    return json.dump(1, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace i85run
