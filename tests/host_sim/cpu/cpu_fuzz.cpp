// cpu_fuzz.cpp - libFuzzer target for the processor: any bytes as a program, any pin events.
// Neither interpreter may crash or leave its arrays, and both must leave the same machine. Run by
// ctest -L fuzz: `cpu_fuzz --seeds FOLDER` writes the corpus, then a run with it. Input instruction
// set, IE, masks, protected pages (2 bytes); SP (2); number of events (1),
//              each: T-states since the one before, pin and level (2); the program, from 0000H on.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "random_program.hpp"
#include "scripted_machine.hpp"

namespace {

using cpu_test::ScriptedMachine;
using host_sim::InstructionSet;
using host_sim::Pin;

/// Reads the input from its front; zeros behind its end.
class Input {
public:
    Input(const uint8_t* data, std::size_t size) : data_(data), size_(size) {}
    uint8_t byte() { return at_ < size_ ? data_[at_++] : 0; }
    [[nodiscard]] bool empty() const { return at_ >= size_; }

private:
    const uint8_t* data_;
    std::size_t size_;
    std::size_t at_ = 0;
};

void set_up(ScriptedMachine& machine, Input& input) {
    const unsigned options = input.byte();
    machine =
        ScriptedMachine((options & 1) != 0 ? InstructionSet::documented : InstructionSet::all);
    machine.cpu.interrupt_enable = (options & 2) != 0;
    machine.cpu.masks = options >> 2 & 7;
    const unsigned first_page = input.byte();
    if ((options & 0x20) != 0) machine.protect(first_page, 255, (options & 0x40) != 0);
    machine.cpu.sp = input.byte();
    machine.cpu.sp = static_cast<uint16_t>(machine.cpu.sp | input.byte() << 8);
    uint64_t t = 0;
    for (unsigned n = input.byte() % 32; n > 0; --n) {
        const unsigned wait = input.byte();
        const unsigned change = input.byte();
        t += wait;
        machine.events.push_back(
            {t, static_cast<Pin>(change % host_sim::kPinCount), change >= 0x80});
    }
    machine.acknowledge_bytes = {0xFF, 0xCD, 0x00, 0x01, 0xD7};
    for (uint16_t address = 0; !input.empty(); ++address) {
        machine.memory.bytes[address] = input.byte();
    }
}

void compare(ScriptedMachine& fast, ScriptedMachine& plain) {
    // Slices of many lengths, the first of one T-state.
    for (uint64_t slice = 1; slice < 5000 && !plain.stopped; slice = slice * 5 / 2 + 1) {
        const uint64_t until_t = fast.cpu.t + slice;
        fast.run_quickly(until_t);
        plain.run_stepwise(until_t);
        if (fast.same(plain)) continue;
        std::fprintf(stderr, "interpreters differ in the slice up to T %llu: PC %04X and %04X\n",
                     static_cast<unsigned long long>(until_t), fast.cpu.pc, plain.cpu.pc);
        std::abort();
    }
}

/// Code that looks like code, behind a header.
void write_seeds(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::ofstream list(folder / "list");
    for (uint32_t seed = 0; seed < 32; ++seed) {
        ScriptedMachine machine;
        cpu_test::RandomProgram program(seed);
        program.make(machine.cpu, machine.memory);
        std::string bytes;
        for (int i = 0; i < 4; ++i) bytes += static_cast<char>(program.below(256));
        const uint32_t events = program.below(32);
        bytes += static_cast<char>(events);
        for (uint32_t i = 0; i < 2 * events; ++i) bytes += static_cast<char>(program.below(256));
        bytes.append(machine.memory.bytes.begin(), machine.memory.bytes.begin() + 0x700);
        const auto file = folder / ("program" + std::to_string(seed));
        std::ofstream(file, std::ios::binary) << bytes;
        list << (seed == 0 ? "" : ",") << file.string();
    }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* count, char*** arguments) {
    if (*count == 3 && std::string_view((*arguments)[1]) == "--seeds") {
        write_seeds((*arguments)[2]);
        std::exit(0);
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    static ScriptedMachine fast;
    static ScriptedMachine plain;
    Input input(data, size);
    set_up(fast, input);
    plain = fast;
    compare(fast, plain);
    return 0;
}
