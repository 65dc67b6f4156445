// Interrupt functions and the main program share functions, runtime routines and volatile counters:
// whenever interrupts come, one or many, main's result is the same, none is lost, and what is
// disabled stays so (TRAP's function must not enable it). Expected values: the same mathematics
// here, in 64-bit integers. ROVER_INTERRUPT_SEED changes the storms.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include "host_sim/cpu/flat_bus.hpp"
#include "host_sim/cpu/interrupts.hpp"
#include "host_sim/cpu/reference.hpp"
#include "tests/target/compile.hpp"

namespace target_test {
namespace {

using host_sim::Interrupt;
using host_sim::Pin;

constexpr uint64_t kStride = kSlowBuild ? 61 : 5;

constexpr std::array kPins = {Pin::trap, Pin::rst75, Pin::rst65, Pin::rst55};
constexpr std::array kInterrupts = {Interrupt::trap, Interrupt::rst75, Interrupt::rst65,
                                    Interrupt::rst55};

/// mix() of the program.
uint32_t mix(uint16_t a, uint16_t b) {
    std::array<uint64_t, 6> digits = {};
    uint64_t rest = (a ^ b * 77U) & 0xFFFFU;
    for (uint64_t& digit : digits) {
        digit = rest % 10;
        rest /= 10;
    }
    uint64_t sum = 0;
    for (std::size_t i = digits.size(); i-- > 0;) {
        sum = (sum * 31 + (digits[i] << (b & 7U))) & 0xFFFFFFFFU;
    }
    return static_cast<uint32_t>(sum / (b | 1U) + sum % 1000);
}

uint32_t sum_of(unsigned kind, unsigned served) {
    uint32_t sum = 0;
    for (unsigned i = 1; i <= served; ++i) {
        sum += mix(static_cast<uint16_t>(i), static_cast<uint16_t>(kind * 13 + 5));
    }
    return sum;
}

uint32_t main_result() {
    uint32_t sum = 0;
    for (unsigned round = 0; round < 4; ++round) {
        sum = sum * 7 + mix(static_cast<uint16_t>(sum), static_cast<uint16_t>(round * 999));
        sum += mix(static_cast<uint16_t>(round), 40);
    }
    return sum;
}

toolchain::assembly::Program compiled(const Level& level) {
    const std::string root = ROVER_SOURCE_DIR;
    toolchain::driver::Request made = request(level);
    made.sources = {{.path = root + "/tests/target/interrupt_program.c"}};
    made.keep = {"ready", "served", "sums", "broken", "result"};
    return toolchain::driver::compile_program(made).program;
}

/// The processor with its interrupt pins.
class Processor {
public:
    explicit Processor(const toolchain::assembly::Program& program) : program_(program) {
        memory_.bytes.fill(0xA7);
        for (std::size_t i = 0; i < toolchain::assembly::kMemorySize; ++i) {
            if (program.image.present[i]) memory_.bytes[i] = program.image.bytes[i];
        }
        cpu_.pc = program.start.value_or(0);
    }

    /// Runs up to the HLT at main's end.
    /// @param raise  called at every instruction boundary behind `ready` with its number; the pin
    ///               that goes high there, if any
    template <class Raise>
    void run(Raise raise) {
        const uint16_t ready = address("ready");
        while (!cpu_.halted) {
            if (cpu_.t > 100'000'000) throw std::runtime_error("no end");
            if (memory_.bytes[ready] == 1) {
                const std::optional<std::size_t> kind = raise(boundaries_++);
                if (kind) raise_pin(*kind);
            }
            step();
        }
    }

    [[nodiscard]] uint32_t number(const std::string& name, unsigned index, unsigned bytes) const {
        uint32_t value = 0;
        const auto from = address(name) + index * bytes;
        for (unsigned i = bytes; i-- > 0;) value = value << 8 | memory_.bytes[from + i];
        return value;
    }
    [[nodiscard]] uint64_t boundaries() const { return boundaries_; }
    [[nodiscard]] unsigned taken(std::size_t kind) const { return taken_[kind]; }
    [[nodiscard]] bool active(std::size_t kind) const { return active_[kind]; }

private:
    [[nodiscard]] uint16_t address(const std::string& name) const {
        const auto* symbol = program_.find(name);
        if (symbol == nullptr) throw std::runtime_error(name + " is not there");
        return symbol->value;
    }
    void raise_pin(std::size_t kind) {
        if (cpu_.pin(kPins[kind]).level || active_[kind]) return;
        host_sim::set_pin(cpu_, kPins[kind], true, cpu_.t);
    }
    /// One instruction, or an interrupt; its pin goes low again. An interrupt's function is over
    /// when the stack is where it was.
    void step() {
        host_sim::FlatBus bus{memory_};
        // What i85cc uses is checked where images are linked.
        host_sim::Reference<host_sim::FlatBus> processor(cpu_, bus, host_sim::InstructionSet::all);
        const Interrupt interrupt = host_sim::pending_interrupt(cpu_);
        if (interrupt == Interrupt::none) {
            if (!processor.execute()) throw std::runtime_error("no such instruction");
            for (std::size_t kind = 0; kind < kPins.size(); ++kind) {
                if (active_[kind] && cpu_.sp >= stack_[kind]) active_[kind] = false;
            }
            return;
        }
        for (std::size_t kind = 0; kind < kPins.size(); ++kind) {
            if (kInterrupts[kind] != interrupt) continue;
            ++taken_[kind];
            active_[kind] = true;
            stack_[kind] = cpu_.sp;
            host_sim::set_pin(cpu_, kPins[kind], false, cpu_.t);
        }
        processor.accept(interrupt);
    }

    const toolchain::assembly::Program& program_;
    host_sim::CpuState cpu_;
    host_sim::FlatMemory memory_ = host_sim::all_ram();
    uint64_t boundaries_ = 0;
    std::array<unsigned, 4> taken_ = {};
    std::array<bool, 4> active_ = {};
    std::array<uint16_t, 4> stack_ = {};
};

/// What must hold however interrupts came.
void expect_right(const Processor& processor, const std::string& what) {
    EXPECT_EQ(processor.number("result", 0, 4), main_result()) << what;
    EXPECT_EQ(processor.number("broken", 0, 1), 0U) << what;
    for (unsigned kind = 0; kind < kPins.size(); ++kind) {
        const unsigned served = processor.number("served", kind, 2);
        EXPECT_EQ(served, processor.taken(kind)) << what << ", kind " << kind;
        EXPECT_EQ(processor.number("sums", kind, 4), sum_of(kind, served)) << what;
    }
}

class Interrupts : public testing::TestWithParam<Level> {};

TEST_P(Interrupts, OneAtAnyInstruction) {
    const auto program = compiled(GetParam());
    Processor quiet(program);
    quiet.run([](uint64_t) { return std::optional<std::size_t>(); });
    expect_right(quiet, "without interrupts");
    unsigned taken = 0;
    uint64_t runs = 0;
    const uint64_t stride = std::getenv("ROVER_TARGET_FULL") != nullptr ? 1 : kStride;
    // With the stride every kind comes everywhere in the loops' bodies, in one round or another.
    for (uint64_t at = 0; at < quiet.boundaries() && !HasFailure(); at += stride) {
        const std::size_t kind = runs++ % kPins.size();
        Processor processor(program);
        processor.run(
            [&](uint64_t boundary) { return boundary == at ? std::optional(kind) : std::nullopt; });
        expect_right(processor, fmt::format("kind {} at boundary {}", kind, at));
        taken += processor.taken(kind);
    }
    // Those in the last instructions come too late, when interrupts are disabled.
    EXPECT_GT(taken, runs * 9 / 10);
    fmt::print("{} of {} boundaries\n", runs, quiet.boundaries());
}

TEST_P(Interrupts, Storms) {
    const char* text = std::getenv("ROVER_INTERRUPT_SEED");
    const uint64_t first = text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
    const auto program = compiled(GetParam());
    unsigned taken = 0;
    for (uint64_t seed = first; seed < first + 50 && !HasFailure(); ++seed) {
        std::mt19937_64 random(seed);
        Processor processor(program);
        const uint64_t rarity = 20 + random() % 1000;
        unsigned left = 40;  // without an end main would never come to its turn
        processor.run([&](uint64_t) -> std::optional<std::size_t> {
            if (random() % rarity != 0 || left == 0) return std::nullopt;
            --left;
            return random() % kPins.size();
        });
        expect_right(processor, fmt::format("seed {}", seed));
        for (std::size_t kind = 0; kind < kPins.size(); ++kind) taken += processor.taken(kind);
    }
    fmt::print("storms from seed {}: {} interrupts\n", first, taken);
    EXPECT_GT(taken, 500U);
}

INSTANTIATE_TEST_SUITE_P(Levels, Interrupts, testing::ValuesIn(kSettings),
                         [](const auto& test) { return test.param.name; });

// Every function of i85.h is one instruction, in the place where it stands.
TEST(ProcessorFunctions, AreSingleInstructionsInOrder) {
    for (const Level& level : kLevels) {
        toolchain::driver::Request made = request(level.level);
        made.sources = {{.path = "instructions.c", .text = R"(#include <i85.h>
int main(void) {
    __i85_di();
    __i85_nop();
    __i85_sim(0x4D);
    __i85_sim(0xCD);
    __i85_out(0x21, __i85_in(0x20));
    __i85_out(0x21, __i85_rim());
    __i85_ei();
    __i85_nop();
    __i85_nop();
    __i85_hlt();
    return 0;
})"}};
        const auto program = toolchain::driver::compile_program(made).program;
        host_sim::FlatMemory memory = host_sim::all_ram();
        for (std::size_t i = 0; i < toolchain::assembly::kMemorySize; ++i) {
            if (program.image.present[i]) memory.bytes[i] = program.image.bytes[i];
        }
        host_sim::CpuState cpu;
        cpu.pc = program.find("main")->value;
        cpu.sp = 0xFF00;
        std::string seen;
        host_sim::FlatBus bus{memory};
        host_sim::Reference<host_sim::FlatBus> processor(cpu, bus,
                                                         host_sim::InstructionSet::documented);
        while (!cpu.halted && cpu.t < 10'000) {
            const uint8_t opcode = memory.bytes[cpu.pc];
            const uint8_t port = memory.bytes[cpu.pc + 1U];
            const uint8_t a = cpu.a;
            ASSERT_TRUE(processor.execute());
            if (opcode == 0xF3) seen += "DI ";
            if (opcode == 0x00) seen += "NOP ";
            if (opcode == 0xFB) seen += "EI ";
            if (opcode == 0x76) seen += "HLT";
            if (opcode == 0x20) seen += fmt::format("RIM{:02X} ", cpu.a);
            if (opcode == 0x30) seen += fmt::format("SIM{:02X} ", a);
            if (opcode == 0xDB) seen += fmt::format("IN{:02X} ", port);
            if (opcode == 0xD3) seen += fmt::format("OUT{:02X}={:02X} ", port, a);
        }
        // The bus reads FFH; masks 101 are read back by RIM, and interrupts are disabled.
        EXPECT_EQ(seen, "DI NOP SIM4D SIMCD IN20 OUT21=FF RIM05 OUT21=05 EI NOP NOP HLT")
            << level.name;
        EXPECT_TRUE(cpu.sod) << level.name;
    }
}

}  // namespace
}  // namespace target_test
