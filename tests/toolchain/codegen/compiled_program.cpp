// compiled_program.cpp - see compiled_program.hpp.
#include "tests/toolchain/codegen/compiled_program.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "host_sim/cpu/flat_bus.hpp"
#include "host_sim/cpu/reference.hpp"
#include "tests/toolchain/codegen/plain_generator.hpp"
#include "toolchain/asm/link.hpp"
#include "toolchain/asm/parse.hpp"

namespace codegen_test {

using namespace toolchain;

namespace {

constexpr uint16_t kStackSize = 0x400;
constexpr uint64_t kInstructionLimit = 20'000'000;

}  // namespace

const std::vector<assembly::Module>& runtime_modules() {
    static const std::vector<assembly::Module> kModules = [] {
        std::vector<std::filesystem::path> paths;
        for (const auto& entry :
             std::filesystem::directory_iterator(ROVER_SOURCE_DIR "/toolchain/runtime")) {
            if (entry.path().extension() == ".s85") paths.push_back(entry.path());
        }
        std::ranges::sort(paths);
        std::vector<assembly::Module> modules;
        for (const auto& path : paths) {
            std::ifstream in(path);
            const std::string source((std::istreambuf_iterator<char>(in)), {});
            modules.push_back(assembly::parse(source, {path.filename().string(), {}, true}));
        }
        return modules;
    }();
    return kModules;
}

std::vector<NamedGenerator> generators() {
    const auto slots_only = [](const codegen::Module& module, const codegen::Function& function,
                               const codegen::GenerateOptions& options) {
        codegen::GenerateOptions without = options;
        without.search = false;
        return codegen::generate(module, function, without);
    };
    const auto undocumented = [](const codegen::Module& module, const codegen::Function& function,
                                 const codegen::GenerateOptions& options) {
        codegen::GenerateOptions with = options;
        with.undocumented = true;
        return codegen::generate(module, function, with);
    };
    return {{"Real", codegen::generate},
            {"WithoutSearch", slots_only},
            {"Undocumented", undocumented},
            {"Plain", plain_code}};
}

CompiledProgram::CompiledProgram(codegen::Generator generator, codegen::Module module,
                                 const codegen::CompileOptions& options)
    : compiled_(codegen::compile_with(generator, std::move(module), runtime_modules(), options)) {
    std::vector<assembly::Module> modules = runtime_modules();
    modules.push_back(compiled_.module);
    assembly::LinkOptions link;
    link.rom = {0x0040, 0x7FFF};
    link.ram = {0x8000, 0xFEFF};
    link.stack_size = kStackSize;
    link.roots = options.roots;
    link.vectors = compiled_.vectors;
    link.startup = assembly::StartupOptions{options.main, compiled_.constructors};
    program_ = assembly::link(std::move(modules), link);
}

void CompiledProgram::load() {
    machine_.cpu = {};
    machine_.memory = host_sim::all_ram();
    machine_.memory.bytes.fill(0x76);  // HLT, and no zeros that nobody has written
    for (std::size_t i = 0; i < program_.image.bytes.size(); ++i) {
        if (program_.image.present[i]) machine_.memory.bytes[i] = program_.image.bytes[i];
    }
    instructions_ = 0;
    accepted_ = 0;
    deepest_stack_ = 0;
}

void CompiledProgram::run(const std::function<host_sim::Interrupt(uint64_t)>& interrupt) {
    load();
    host_sim::FlatBus bus{machine_.memory};
    host_sim::CpuState& cpu = machine_.cpu;
    host_sim::Reference<host_sim::FlatBus> processor(cpu, bus, host_sim::InstructionSet::all);
    const uint32_t top = program_.stack.end();
    while (!cpu.halted) {
        const host_sim::Interrupt wanted = interrupt(instructions_);
        const bool possible =
            wanted == host_sim::Interrupt::trap || (cpu.interrupt_enable && !cpu.ei_shadow);
        if (wanted != host_sim::Interrupt::none && possible) {
            processor.accept(wanted);
            ++accepted_;
        }
        if (!processor.execute()) throw std::runtime_error("an instruction that is not documented");
        if (++instructions_ > kInstructionLimit) throw std::runtime_error("does not halt");
        if (cpu.sp >= program_.stack.first && cpu.sp <= top) {
            deepest_stack_ = std::max(deepest_stack_, top - cpu.sp);
        }
    }
}

uint64_t CompiledProgram::variable(const std::string& name, unsigned size) const {
    const assembly::Symbol* symbol = program_.find(name);
    if (symbol == nullptr) throw std::runtime_error("no variable " + name);
    return word_at(symbol->value, size);
}

uint64_t CompiledProgram::word_at(uint32_t address, unsigned size) const {
    uint64_t value = 0;
    for (unsigned i = size; i-- > 0;) {
        value = value << 8 | machine_.memory.bytes[static_cast<uint16_t>(address + i)];
    }
    return value;
}

}  // namespace codegen_test
