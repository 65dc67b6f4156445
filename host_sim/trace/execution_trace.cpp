// execution_trace.cpp - see execution_trace.hpp.
#include "host_sim/trace/execution_trace.hpp"

#include <fmt/format.h>

#include <iterator>
#include <span>
#include <stdexcept>

#include "toolchain/isa/disassemble.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace host_sim {
namespace {

using Kind = BusAccess::Kind;

std::span<const BusAccess> accesses_of(const StepRecord& step) {
    return {step.accesses.data(), step.access_count};
}

bool is_code(Kind kind) {
    return kind == Kind::fetch || kind == Kind::operand || kind == Kind::acknowledge;
}

/// The instruction's bytes as the bus gave them, and its text.
struct Code {
    std::string bytes;
    std::string text;
};

Code code_of(const StepRecord& step, const ExecutionTraceOptions& options) {
    Code code;
    std::array<uint8_t, 3> bytes{};
    std::size_t count = 0;
    for (const BusAccess& access : accesses_of(step)) {
        if (!is_code(access.kind) || count == bytes.size()) continue;
        bytes[count++] = access.value;
        fmt::format_to(std::back_inserter(code.bytes), "{:02X} ", access.value);
    }
    if (count == 0) return code;
    const auto& entry = toolchain::isa::instruction(bytes[0]);
    const bool named = entry.documented || !options.documented_only;
    if (named && count < entry.bytes) {
        if (!options.peek) {
            code.text = fmt::format("{} ?", entry.mnemonic());
            return code;
        }
        while (count < entry.bytes) {
            bytes[count] = options.peek(static_cast<uint16_t>(step.pc + count));
            fmt::format_to(std::back_inserter(code.bytes), "{:02X} ", bytes[count]);
            ++count;
        }
    }
    toolchain::isa::DisassembleOptions how;
    how.documented_only = options.documented_only;
    if (options.symbols != nullptr) {
        how.address_text = [&](uint16_t address) { return options.symbols->describe(address); };
    }
    code.text = toolchain::isa::disassemble(std::span(bytes).first(count), how).text;
    return code;
}

/// "SZKAPVC" with a dot for each flag that is 0.
std::array<char, 8> flag_letters(uint8_t flags) {
    constexpr std::string_view kLetters = "SZKAPVC";
    constexpr std::array<uint8_t, 7> kBits = {flag::kSign,           flag::kZero,   flag::kK,
                                              flag::kAuxiliaryCarry, flag::kParity, flag::kV,
                                              flag::kCarry};
    std::array<char, 8> text{};
    for (std::size_t i = 0; i < kBits.size(); ++i) {
        text[i] = (flags & kBits[i]) != 0 ? kLetters[i] : '.';
    }
    return text;
}

void append_accesses(std::string& line, const StepRecord& step) {
    for (const BusAccess& access : accesses_of(step)) {
        switch (access.kind) {
            case Kind::read:
                fmt::format_to(std::back_inserter(line), " R {:04X}={:02X}", access.address,
                               access.value);
                break;
            case Kind::write:
                fmt::format_to(std::back_inserter(line), " W {:04X}={:02X}", access.address,
                               access.value);
                break;
            case Kind::in:
                fmt::format_to(std::back_inserter(line), " IN {:02X}={:02X}", access.address,
                               access.value);
                break;
            case Kind::out:
                fmt::format_to(std::back_inserter(line), " OUT {:02X}={:02X}", access.address,
                               access.value);
                break;
            default:
                break;
        }
    }
}

}  // namespace

std::string_view interrupt_name(StepRecord::Kind kind) {
    switch (kind) {
        case StepRecord::Kind::trap:
            return "TRAP";
        case StepRecord::Kind::rst75:
            return "RST 7.5";
        case StepRecord::Kind::rst65:
            return "RST 6.5";
        case StepRecord::Kind::rst55:
            return "RST 5.5";
        case StepRecord::Kind::intr:
            return "INTR";
        default:
            return "";
    }
}

ExecutionTrace::ExecutionTrace(std::ostream& out, ExecutionTraceOptions options)
    : out_(out), options_(std::move(options)) {}

void ExecutionTrace::observe(const StepRecord& step, const CpuState& after) {
    if (step.t_begin < options_.t_first || step.t_begin > options_.t_last ||
        step.pc < options_.addresses.first || step.pc > options_.addresses.last) {
        return;
    }
    const std::string place =
        options_.symbols == nullptr ? "" : options_.symbols->describe(step.pc);
    line_.clear();
    const auto put = std::back_inserter(line_);
    fmt::format_to(put, "{:>12} {:04X} {:<20} ", step.t_begin, step.pc, place);
    if (step.kind == StepRecord::Kind::halt) {
        fmt::format_to(put, "          -- halted for {} T", step.t_end - step.t_begin);
    } else {
        const Code code = code_of(step, options_);
        if (step.kind == StepRecord::Kind::instruction) {
            fmt::format_to(put, "{:<9} {:<20}", code.bytes, code.text);
        } else {
            const std::string event =
                fmt::format("-- {}{}{} to {:04X}", interrupt_name(step.kind),
                            code.text.empty() ? "" : " ", code.text, step.next_pc);
            fmt::format_to(put, "{:<9} {:<20}", code.bytes, event);
        }
        fmt::format_to(put, " A={:02X} {} BC={:04X} DE={:04X} HL={:04X} SP={:04X}", after.a,
                       flag_letters(after.f).data(), after.bc(), after.de(), after.hl(), after.sp);
        append_accesses(line_, step);
    }
    line_ += '\n';
    out_.write(line_.data(), static_cast<std::streamsize>(line_.size()));
    if (!out_) throw std::runtime_error("the execution trace cannot be written; free some space");
    ++lines_;
}

}  // namespace host_sim
