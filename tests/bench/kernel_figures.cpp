// kernel_figures.cpp - measuring: compile, run, count; see kernel_figures.hpp.
#include "tests/bench/kernel_figures.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/target/machine.hpp"

namespace bench {

namespace {

using toolchain::assembly::PlacedSection;
using toolchain::assembly::Program;
using toolchain::assembly::SectionKind;

constexpr uint64_t kHltT = 5;
constexpr uint16_t kReturn = 0xFFF0;  ///< behind the stack: a HLT

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
}

/// Lines without remarks; the first is the heading.
std::vector<std::string> read_lines(const std::string& file) {
    std::ifstream stream(file);
    if (!stream) throw std::runtime_error(file + " is not readable");
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        if (!line.empty() && line[0] != '#') lines.push_back(line);
    }
    return lines;
}

uint64_t number(const std::string& text, int base = 10) {
    return std::stoull(text, nullptr, base);
}

Program compiled(const std::string& name, const LevelName& level, const std::string& folder) {
    toolchain::driver::Request request;
    request.level = level.level;
    request.undocumented = level.undocumented;
    request.table_multiply = level.table_multiply;
    request.steps = level.steps;
    request.front_end = {"-I" + folder, "-std=c89"};
    request.keep = {"kernel", "ksum"};
    request.sources = {{.path = "main.c",
                        .text = "void kernel(void);\nint main(void) { kernel(); return 0; }\n",
                        .separate = true},
                       {.path = folder + "/" + name + ".c", .text = std::nullopt, .separate = true},
                       {.path = folder + "/kdata.c", .text = std::nullopt, .separate = true}};
    return toolchain::driver::compile_program(request).program;
}

void add_bytes(const Program& program, Figure& figure) {
    for (const PlacedSection& placed : program.sections) {
        if (placed.section.kind != SectionKind::code) continue;
        const std::string& function = placed.section.function;
        const std::string& name = placed.section.name;
        const bool runtime = name.starts_with("runtime.");
        const bool around =
            function == "main" || function == "__reset" || name == "__reset" || function.empty();
        if (around && !runtime) continue;
        figure.total_bytes += placed.size;
        if (!runtime) figure.own_bytes += placed.size;
    }
}

}  // namespace

std::vector<Kernel> read_kernels(const std::string& csv_file) {
    std::vector<Kernel> kernels;
    const std::vector<std::string> lines = read_lines(csv_file);
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const std::vector<std::string> field = split(lines[i]);
        if (field.size() != 6) throw std::runtime_error(csv_file + ": not 6 columns: " + lines[i]);
        kernels.push_back({.name = field[0],
                           .work = field[1],
                           .checksum = static_cast<uint32_t>(number(field[2], 16)),
                           .best_t = number(field[3]),
                           .best_by = field[4],
                           .z80_t = number(field[5])});
    }
    return kernels;
}

Figures read_figures(const std::string& csv_file) {
    Figures figures;
    const std::vector<std::string> lines = read_lines(csv_file);
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const std::vector<std::string> field = split(lines[i]);
        if (field.size() == 2 && field[0] == "clang") {
            figures.clang = field[1];
            continue;
        }
        if (field.size() != 5) throw std::runtime_error(csv_file + ": not 5 columns: " + lines[i]);
        figures.rows.push_back({.kernel = field[0],
                                .level = field[1],
                                .t_states = number(field[2]),
                                .own_bytes = static_cast<uint32_t>(number(field[3])),
                                .total_bytes = static_cast<uint32_t>(number(field[4]))});
    }
    return figures;
}

void write_figures(const std::string& csv_file, const Figures& figures) {
    std::ofstream stream(csv_file);
    stream << "# What the kernels cost: `kernel_benchmark --update`. Exact: better and worse both "
              "fail until\n# edited. Another clang's figures may differ, and are only reported.\n"
              "kernel,level,t_states,own_bytes,total_bytes\nclang,"
           << figures.clang << "\n";
    for (const Figure& row : figures.rows) {
        stream << fmt::format("{},{},{},{},{}\n", row.kernel, row.level, row.t_states,
                              row.own_bytes, row.total_bytes);
    }
    if (!stream.flush()) throw std::runtime_error(csv_file + " cannot be written");
}

std::string clang_version() {
    const char* chosen = std::getenv("I85CC_CLANG");
    const std::string command =
        fmt::format("{} --version 2>/dev/null", chosen == nullptr ? "clang-19" : chosen);
    std::FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return "none";
    std::array<char, 256> line = {};
    const bool read = std::fgets(line.data(), line.size(), pipe) != nullptr;
    pclose(pipe);
    const std::string text = read ? line.data() : "";
    const std::size_t at = text.find("version ");
    if (at == text.npos) return "none";
    return text.substr(at + 8, text.find_first_of(" (+-\n", at + 8) - at - 8);
}

Figure measure(const Kernel& kernel, const LevelName& level, const std::string& folder) {
    const Program program = compiled(kernel.name, level, folder);
    Figure figure{.kernel = kernel.name, .level = level.name};
    add_bytes(program, figure);
    target_test::Machine machine(program, level.undocumented
                                              ? host_sim::InstructionSet::all
                                              : host_sim::InstructionSet::documented);
    host_sim::CpuState& cpu = machine.machine().cpu;
    host_sim::StepRecord step;
    while (cpu.pc != machine.address("main")) {
        if (machine.machine().step(step) != host_sim::RunEnd::time_limit) {
            throw std::runtime_error(kernel.name + ": start-up does not reach main");
        }
    }
    machine.write(kReturn, 1, 0x76);
    cpu.sp = static_cast<uint16_t>(cpu.sp - 2);
    machine.write(cpu.sp, 2, kReturn);
    cpu.pc = machine.address("kernel");
    figure.t_states = machine.run() - kHltT;
    const uint64_t sum = machine.read(machine.address("ksum"), 4);
    if (cpu.pc != kReturn + 1 || sum != kernel.checksum) {
        throw std::runtime_error(fmt::format("{} at {}: checksum {:08X}, wanted {:08X}; PC {:04X}H",
                                             kernel.name, level.name, sum, kernel.checksum,
                                             cpu.pc));
    }
    return figure;
}

}  // namespace bench
