// runtime_machine.cpp - see runtime_machine.hpp.
#include "tests/toolchain/runtime/runtime_machine.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "toolchain/asm/link.hpp"
#include "toolchain/asm/parse.hpp"
#include "toolchain/asm/replace.hpp"

namespace runtime_test {
namespace {

using namespace toolchain::assembly;

constexpr std::array kFiles = {"multiply", "divide", "shift", "copy", "wide", "call"};
constexpr uint16_t kHalt = 0x0000;  // where routines return to
constexpr uint16_t kCode = 0x0100;
constexpr uint16_t kStack = 0xFF00;
constexpr uint64_t kHaltT = 5;
constexpr uint64_t kLimitT = 3'000'000;

std::string file_text(const std::string& name) {
    const std::string path = std::string(ROVER_SOURCE_DIR "/toolchain/runtime/") + name;
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + " cannot be read");
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The words up to a semicolon; "none" is no word.
std::vector<std::string> words(std::string_view text) {
    std::istringstream stream{std::string(text.substr(0, text.find(';')))};
    std::vector<std::string> result;
    for (std::string word; stream >> word;) {
        if (word != "none") result.push_back(word);
    }
    return result;
}

/// Bits set where a register is named.
Registers mask_of(const std::vector<std::string>& names) {
    Registers mask;
    for (const std::string& name : names) {
        if (name == "A") mask.a = 0xFF;
        if (name == "BC" || name == "B") mask.bc |= 0xFF00;
        if (name == "BC" || name == "C") mask.bc |= 0x00FF;
        if (name == "DE" || name == "D") mask.de |= 0xFF00;
        if (name == "DE" || name == "E") mask.de |= 0x00FF;
        if (name == "HL" || name == "H") mask.hl |= 0xFF00;
        if (name == "HL" || name == "L") mask.hl |= 0x00FF;
    }
    return mask;
}

std::string shown(const Registers& registers) {
    return fmt::format("A {:02X} BC {:04X} DE {:04X} HL {:04X}", registers.a, registers.bc,
                       registers.de, registers.hl);
}

/// Takes "name value" of a comment block's line into the routine.
void take_field(Routine& routine, std::string_view line) {
    const auto all = words(line);
    if (all.empty()) return;
    const std::vector<std::string> rest(all.begin() + 1, all.end());
    if (all[0] == "in") routine.in = rest;
    if (all[0] == "out") routine.out = rest;
    if (all[0] == "clobbers") routine.clobbers = rest;
    if (all[0] == "calls") routine.calls = rest;
    if (all[0] == "t") {
        if (rest.size() != 3 || rest[1] != "to") {
            throw std::runtime_error(routine.name + ": t is not of the form 'n to n'");
        }
        routine.best_t = static_cast<unsigned>(std::stoul(rest[0]));
        routine.worst_t = static_cast<unsigned>(std::stoul(rest[2]));
    }
}

}  // namespace

Registers with_dehl(uint32_t value) {
    return {.de = static_cast<uint16_t>(value >> 16), .hl = static_cast<uint16_t>(value)};
}

RuntimeMachine::RuntimeMachine() {
    for (const std::string name : kFiles) {
        const std::string text = file_text(name + ".s85");
        read_blocks(text);
        modules_.push_back(parse(text, {.file = name + ".s85"}));
    }
    if (kSmall || kUndocumented || kTable) take_variant();
    place();
}

/// The routines of a variant in the place of the usual ones.
void RuntimeMachine::take_variant() {
    const std::vector<Routine> fast = std::exchange(routines_, {});
    std::vector<std::string> names;
    if (kSmall) names = {"small/multiply", "small/divide"};
    if (kUndocumented) names = {"undocumented/multiply"};
    if (kTable) names = {"table/multiply"};
    std::vector<Module> variant;
    for (const std::string& name : names) {
        const std::string text = file_text(name + ".s85");
        read_blocks(text);
        variant.push_back(parse(text, {.file = name + ".s85"}));
    }
    replace_sections(modules_, std::move(variant));
    for (Routine& routine : routines_) routine.is_variant = true;
    for (const Routine& routine : fast) {
        const bool replaced =
            std::any_of(routines_.begin(), routines_.end(),
                        [&](const Routine& other) { return other.name == routine.name; });
        if (replaced) continue;
        routines_.push_back(routine);
        routines_.back().is_stated = routine.calls.empty();
    }
}

/// One section behind the other.
void RuntimeMachine::place() {
    auto placed = modules_;
    uint32_t end = kCode;
    for (Module& module : placed) {
        for (Section& section : module.sections) {
            section.kind = SectionKind::code;
            end = (end + section.alignment - 1) / section.alignment * section.alignment;
            section.address = static_cast<uint16_t>(end);
            end += static_cast<uint32_t>(section_size(section));
        }
    }
    const Program program = link(placed);
    machine_.memory.bytes.fill(0);
    for (std::size_t i = kCode; i < end; ++i) machine_.memory.bytes[i] = program.image.bytes[i];
    machine_.memory.bytes[kHalt] = 0x76;
    for (const Symbol& symbol : program.symbols) symbols_[symbol.name] = symbol.value;
}

void RuntimeMachine::read_blocks(std::string_view text) {
    std::istringstream stream{std::string(text)};
    bool in_block = false;
    std::string section;
    unsigned bytes = 0;
    for (std::string line; std::getline(stream, line);) {
        if (line.starts_with("SECTION ")) {
            section = line.substr(8, line.find(',') - 8);
            const std::size_t remark = line.find("; ");
            bytes = remark == line.npos
                        ? 0
                        : static_cast<unsigned>(std::stoul(line.substr(remark + 2)));
        } else if (line.starts_with("; __")) {
            Routine routine;
            routine.name = line.substr(2, line.find(' ', 2) - 2);
            routine.section = section;
            routine.stated_bytes = bytes;
            routines_.push_back(routine);
            in_block = true;
        } else if (in_block && line.starts_with(";   ")) {
            take_field(routines_.back(), line.substr(4));
        } else {
            in_block = false;
        }
    }
}

const Routine& RuntimeMachine::routine(std::string_view name) const {
    const auto found =
        std::ranges::find_if(routines_, [&](const Routine& one) { return one.name == name; });
    if (found == routines_.end()) throw std::runtime_error(fmt::format("no routine {}", name));
    return *found;
}

Registers RuntimeMachine::call(uint16_t entry, const Registers& in) {
    auto& cpu = machine_.cpu;
    cpu.a = in.a;
    cpu.f = in.flags;
    cpu.b = static_cast<uint8_t>(in.bc >> 8);
    cpu.c = static_cast<uint8_t>(in.bc);
    cpu.d = static_cast<uint8_t>(in.de >> 8);
    cpu.e = static_cast<uint8_t>(in.de);
    cpu.h = static_cast<uint8_t>(in.hl >> 8);
    cpu.l = static_cast<uint8_t>(in.hl);
    cpu.pc = entry;
    cpu.sp = kStack;
    cpu.halted = false;
    write(kStack, 2, kHalt);
    const uint64_t begin = cpu.t;
    if (machine_.run(begin + kLimitT) != host_sim::RunEnd::halted || cpu.sp != kStack + 2) {
        throw std::runtime_error(
            fmt::format("the routine at {:04X}H does not return; PC {:04X}H", entry, cpu.pc));
    }
    last_t_ = static_cast<unsigned>(cpu.t - begin - kHaltT);
    return {.a = cpu.a, .flags = cpu.f, .bc = cpu.bc(), .de = cpu.de(), .hl = cpu.hl()};
}

uint64_t RuntimeMachine::read(uint16_t address, unsigned bytes) const {
    uint64_t value = 0;
    for (unsigned i = bytes; i-- > 0;) {
        value = value << 8 | machine_.memory.bytes[static_cast<uint16_t>(address + i)];
    }
    return value;
}

void RuntimeMachine::write(uint16_t address, unsigned bytes, uint64_t value) {
    for (unsigned i = 0; i < bytes; ++i) {
        machine_.memory.bytes[static_cast<uint16_t>(address + i)] =
            static_cast<uint8_t>(value >> (8 * i));
    }
}

RuntimeMachine& runtime() {
    static RuntimeMachine machine;
    return machine;
}

Calls::Calls(std::string_view name)
    : routine_(runtime().routine(name)), entry_(runtime().address(routine_.name)) {
    taken_ = mask_of(routine_.in);
    changing_ = mask_of(routine_.out);
    const Registers clobbered = mask_of(routine_.clobbers);
    changing_.a |= clobbered.a;
    changing_.bc |= clobbered.bc;
    changing_.de |= clobbered.de;
    changing_.hl |= clobbered.hl;
}

Registers Calls::filled(const Registers& in) {
    filler_ = filler_ * 6364136223846793005U + 1442695040888963407U;
    const auto mixed = [](uint16_t taken, uint16_t value, uint64_t other) {
        return static_cast<uint16_t>((value & taken) | (other & ~uint64_t{taken} & 0xFFFF));
    };
    return {.a = static_cast<uint8_t>(mixed(taken_.a, in.a, filler_ >> 56)),
            .flags = static_cast<uint8_t>(filler_ >> 48),
            .bc = mixed(taken_.bc, in.bc, filler_ >> 8),
            .de = mixed(taken_.de, in.de, filler_ >> 24),
            .hl = mixed(taken_.hl, in.hl, filler_ >> 40)};
}

Registers Calls::operator()(const Registers& operands) {
    const Registers in = filled(operands);
    const Registers out = runtime().call(entry_, in);
    const bool wrong =
        ((in.a ^ out.a) & ~changing_.a) != 0 || ((in.bc ^ out.bc) & ~changing_.bc) != 0 ||
        ((in.de ^ out.de) & ~changing_.de) != 0 || ((in.hl ^ out.hl) & ~changing_.hl) != 0;
    if (wrong && !reported_) {
        reported_ = true;
        ADD_FAILURE() << fmt::format("{} changes a register it should not: {} became {}",
                                     routine_.name, shown(in), shown(out));
    }
    const unsigned t = runtime().last_t();
    if (t < best_t_) {
        best_t_ = t;
        best_in_ = in;
    }
    if (t > worst_t_) {
        worst_t_ = t;
        worst_in_ = in;
    }
    return out;
}

void Calls::expect_stated() const {
    if (!routine_.is_stated) return;
    EXPECT_TRUE(best_t_ == routine_.best_t && worst_t_ == routine_.worst_t) << fmt::format(
        "{} states {} to {} T, seen {} to {}; with {} and with {}", routine_.name, routine_.best_t,
        routine_.worst_t, best_t_, worst_t_, shown(best_in_), shown(worst_in_));
}

std::mt19937_64& random_source() {
    static std::mt19937_64 source = [] {
        const char* wanted = std::getenv("ROVER_RUNTIME_SEED");
        const uint64_t seed = wanted != nullptr ? std::stoull(wanted) : std::random_device()();
        fmt::print(stderr, "ROVER_RUNTIME_SEED={}\n", seed);
        return std::mt19937_64(seed);
    }();
    return source;
}

uint64_t lumpy(std::mt19937_64& source, unsigned bits) {
    const uint64_t value = source();
    const uint64_t shape = source();
    const uint64_t all = ~uint64_t{0} >> (64 - bits);
    const auto keep = static_cast<unsigned>(shape % (bits + 1));
    const uint64_t low = keep == 64 ? value : value & ((uint64_t{1} << keep) - 1);
    switch (shape >> 61) {
        case 0:
            return low;  // leading zeros
        case 1:
            return ~low & all;  // leading ones
        case 2:
            return value << (bits - keep) % 64 & all;  // trailing zeros
        case 3:
            return ~(value << (bits - keep) % 64) & all;  // trailing ones
        default:
            return value & all;
    }
}

std::vector<uint64_t> corners(unsigned bits) {
    const uint64_t all = ~uint64_t{0} >> (64 - bits);
    std::vector<uint64_t> values;
    for (unsigned i = 0; i < bits; ++i) {
        const uint64_t power = uint64_t{1} << i;
        for (const uint64_t value : {power, power - 1, power + 1, ~power, 0 - power, 1 - power}) {
            values.push_back(value & all);
        }
    }
    std::ranges::sort(values);
    const auto [first, last] = std::ranges::unique(values);
    values.erase(first, last);
    return values;
}

}  // namespace runtime_test
