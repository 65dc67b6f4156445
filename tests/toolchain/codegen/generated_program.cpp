// generated_program.cpp - see generated_program.hpp.
#include "tests/toolchain/codegen/generated_program.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "toolchain/asm/link.hpp"
#include "toolchain/asm/listing.hpp"
#include "toolchain/asm/object.hpp"
#include "toolchain/asm/parse.hpp"

namespace codegen_test {

namespace assembly = toolchain::assembly;
using namespace toolchain::codegen;

namespace {

std::string frame_of(const Module& module, const Function& function) {
    return module.symbols[function.symbol] + "/slots";
}

/// The assembler takes names that begin with a dot or question mark for local ones.
std::string safe(const std::string& name) {
    return name.starts_with('.') || name.starts_with('?') ? "v" + name : name;
}

assembly::Operand operand_of(const Module& module, const Function& function,
                             const CodeOperand& from) {
    assembly::Operand operand;
    operand.offset = from.offset;
    operand.part = static_cast<assembly::Part>(from.part);
    if (from.kind == CodeOperand::Kind::symbol) operand.symbol = safe(module.symbols[from.id]);
    if (from.kind == CodeOperand::Kind::frame) operand.symbol = frame_of(module, function);
    if (from.kind == CodeOperand::Kind::label) operand.symbol = fmt::format(".{}", from.id);
    return operand;
}

assembly::Section code_section(const Module& module, const Function& function,
                               const FunctionCode& code) {
    assembly::Section section;
    section.name = module.symbols[function.symbol];
    section.function = section.name;
    section.items.push_back(assembly::label(section.name));
    for (const CodeItem& item : code.items) {
        const assembly::Operand operand = operand_of(module, function, item.operand);
        switch (item.kind) {
            case CodeItem::Kind::instruction:
                section.items.push_back(assembly::instruction(item.opcode, operand));
                break;
            case CodeItem::Kind::label:
                section.items.push_back(assembly::label(operand.symbol));
                break;
            case CodeItem::Kind::word:
                section.items.push_back(assembly::data_word(operand));
                break;
            case CodeItem::Kind::loop_bound:
                break;
        }
    }
    return section;
}

assembly::Section space_section(const std::string& name, uint32_t size) {
    assembly::Section section;
    section.name = name;
    section.kind = assembly::SectionKind::zero;
    section.items = {assembly::label(name), assembly::space(size)};
    return section;
}

assembly::Section variable_section(const Module& module, const Variable& variable) {
    if (variable.initial.empty()) {
        return space_section(safe(module.symbols[variable.symbol]), variable.size);
    }
    assembly::Section section;
    section.name = safe(module.symbols[variable.symbol]);
    section.kind = assembly::SectionKind::constant;  // the machine has RAM everywhere
    section.items.push_back(assembly::label(section.name));
    for (const Datum& datum : variable.initial) {
        assembly::Operand operand;
        operand.offset = datum.value;
        if (datum.symbol != kNone) {
            operand.symbol = safe(module.symbols[datum.symbol]);
            operand.offset = datum.offset;
            operand.part = datum.high ? assembly::Part::high : assembly::Part::low;
        }
        section.items.push_back(assembly::data_byte(operand));
    }
    return section;
}

std::vector<assembly::Module> parse_runtime() {
    std::vector<assembly::Module> modules;
    const auto folder = std::filesystem::path(ROVER_SOURCE_DIR) / "toolchain/runtime";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".s85") continue;
        std::ifstream file(entry.path());
        std::stringstream text;
        text << file.rdbuf();
        modules.push_back(assembly::parse(
            text.str(), {.file = entry.path().filename().string(), .routine_comments = true}));
    }
    return modules;
}

const std::vector<assembly::Module>& runtime_modules() {
    static const std::vector<assembly::Module> modules = parse_runtime();
    return modules;
}

constexpr uint16_t kReturn = 0xFFF0;  ///< where a HLT waits for the function's RET
constexpr uint16_t kStack = 0xFFE0;

}  // namespace

GeneratedProgram::GeneratedProgram(const Module& lowered, GenerateOptions options,
                                   bool ask_clobbers)
    : machine(options.undocumented ? host_sim::InstructionSet::all
                                   : host_sim::InstructionSet::documented) {
    std::map<SymbolId, RegisterSet> clobbers;
    if (ask_clobbers) {
        options.clobbers_of = [&clobbers](SymbolId symbol) {
            const auto known = clobbers.find(symbol);
            return known == clobbers.end() ? kAllRegisters : known->second;
        };
    }
    assembly::Module module;
    module.name = "program";
    std::set<std::string> defined;
    std::vector<std::string> roots;
    for (const Function& function : lowered.functions) {
        const FunctionCode code = generate(lowered, function, options);
        clobbers[function.symbol] = code.clobbers;
        module.sections.push_back(code_section(lowered, function, code));
        roots.push_back(lowered.symbols[function.symbol]);
        if (code.frame_bytes != 0) {
            module.sections.push_back(space_section(frame_of(lowered, function), code.frame_bytes));
        }
        for (const FrameObject& object : function.frame) {
            module.sections.push_back(space_section(lowered.symbols[object.symbol], object.size));
        }
    }
    for (const Variable& variable : lowered.variables) {
        module.sections.push_back(variable_section(lowered, variable));
        roots.push_back(safe(lowered.symbols[variable.symbol]));
    }
    std::vector<assembly::Module> modules = runtime_modules();
    modules.push_back(std::move(module));
    assembly::LinkOptions link_options;
    link_options.rom = {0x0100, 0x9FFF};
    link_options.ram = {0xA000, 0xFEFF};
    link_options.roots = roots;
    program = assembly::link(std::move(modules), link_options);
    for (std::size_t i = 0; i < program.image.bytes.size(); ++i) {
        machine.memory.bytes[i] = program.image.present.test(i) ? program.image.bytes[i] : 0;
    }
    machine.memory.bytes[kReturn] = 0x76;
}

uint16_t GeneratedProgram::address(const std::string& name) const {
    const assembly::Symbol* symbol = program.find(safe(name));
    if (symbol == nullptr) throw std::runtime_error("no symbol " + name);
    return symbol->value;
}

uint64_t GeneratedProgram::call(const std::string& name, uint64_t limit_t) {
    constexpr unsigned kHaltT = 5;
    machine.cpu = {};
    machine.cpu.pc = address(name);
    machine.cpu.sp = kStack;
    machine.memory.bytes[kStack] = kReturn & 0xFF;
    machine.memory.bytes[kStack + 1] = kReturn >> 8;
    const auto end = machine.run(limit_t);
    if (end != host_sim::RunEnd::halted) {
        throw std::runtime_error(
            fmt::format("{} ended as {} at {:04X}", name, static_cast<int>(end), machine.cpu.pc));
    }
    if (machine.cpu.pc != kReturn + 1 || machine.cpu.sp != kStack + 2) {
        throw std::runtime_error(fmt::format("{} halted at {:04X} with SP {:04X}", name,
                                             machine.cpu.pc, machine.cpu.sp));
    }
    return machine.cpu.t - kHaltT;
}

uint64_t GeneratedProgram::variable(const std::string& name, unsigned size) const {
    uint64_t value = 0;
    for (unsigned i = 0; i < size; ++i) {
        value |= uint64_t{machine.memory.bytes[(address(name) + i) & 0xFFFFU]} << 8 * i;
    }
    return value;
}

uint32_t GeneratedProgram::code_bytes(const std::string& function) const {
    for (const assembly::PlacedSection& placed : program.sections) {
        if (placed.section.name == function) return placed.size;
    }
    return 0;
}

std::string GeneratedProgram::listing() const {
    return assembly::listing(program);
}

}  // namespace codegen_test
