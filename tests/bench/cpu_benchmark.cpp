// cpu_benchmark.cpp - speed of the fast interpreter beside the plain one, for people.
// Depends on   host_sim/board, tests/support/assemble.hpp; callgrind (package valgrind) if present.
// Usage        cpu_benchmark [--seconds S] [--callgrind]
//              cpu_benchmark --run fast|plain PROGRAM INSTRUCTIONS     one run, for callgrind
// Prints       million instructions a second, emulated clock, and fast over plain. Both
// interpreters
//              take turns in one process, the best of several turns counts, so that a busy machine
//              disturbs the ratio little.
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "host_sim/board/board.hpp"
#include "host_sim/cpu/flat_machine.hpp"
#include "tests/bench/cpu_programs.hpp"
#include "tests/support/assemble.hpp"

namespace {

using Clock = std::chrono::steady_clock;

struct Program {
    const char* name;
    std::string_view source;
    bool on_board;
};
constexpr std::array<Program, 5> kPrograms = {{
    {"compute", cpu_benchmark::kCompute, false},
    {"memory", cpu_benchmark::kMemory, false},
    {"calls", cpu_benchmark::kCalls, false},
    {"board-tick", cpu_benchmark::kBoardTick, true},
    {"board-poll", cpu_benchmark::kBoardPoll, true},
}};

/// A machine with a program, and its two ways to run. `t` counts on from call to call.
struct Subject {
    std::function<void(bool fast, uint64_t t_states)> run;
    std::function<uint64_t()> instructions;
    std::shared_ptr<void> machine;
};

Subject make_subject(const Program& program) {
    const test_support::Assembled code = test_support::assemble(program.source);
    if (program.on_board) {
        auto board = std::make_shared<host_sim::Board>();
        board->program(code.bytes, code.origin);
        return {[board](bool fast, uint64_t t_states) {
                    const uint64_t until_t = board->state.cpu.t + t_states;
                    fast ? board->run(until_t) : board->run_reference(until_t);
                    board->take_transmitted();
                },
                [board] { return board->state.cpu.instructions; }, board};
    }
    auto machine = std::make_shared<host_sim::FlatMachine>();
    std::copy(code.bytes.begin(), code.bytes.end(), machine->memory.bytes.begin() + code.origin);
    return {[machine](bool fast, uint64_t t_states) {
                const uint64_t until_t = machine->cpu.t + t_states;
                fast ? machine->run(until_t) : machine->run_reference(until_t);
            },
            [machine] { return machine->cpu.instructions; }, machine};
}

struct Speed {
    double instructions_per_s = 0;
    double t_states_per_s = 0;
};

/// One turn of about `seconds`.
Speed measure(const Subject& subject, bool fast, double seconds) {
    constexpr uint64_t kSliceT = 20'000'000;
    const uint64_t instructions = subject.instructions();
    uint64_t t_states = 0;
    const auto start = Clock::now();
    double elapsed = 0;
    while (elapsed < seconds) {
        subject.run(fast, kSliceT);
        t_states += kSliceT;
        elapsed = std::chrono::duration<double>(Clock::now() - start).count();
    }
    return {static_cast<double>(subject.instructions() - instructions) / elapsed,
            static_cast<double>(t_states) / elapsed};
}

void keep_best(Speed& best, const Speed& speed) {
    if (speed.instructions_per_s > best.instructions_per_s) best = speed;
}

/// Host instructions executed by `--run` with a number of guest instructions, by callgrind.
std::optional<double> host_instructions(const std::string& self, const char* core,
                                        const char* program, uint64_t guest_instructions) {
    const std::filesystem::path out =
        std::filesystem::temp_directory_path() / fmt::format("callgrind.{}.{}", core, program);
    const std::string command = fmt::format(
        "valgrind --tool=callgrind --callgrind-out-file='{}' '{}' --run {} {} {} "
        ">/dev/null 2>&1",
        out.string(), self, core, program, guest_instructions);
    if (std::system(command.c_str()) != 0) return std::nullopt;
    std::ifstream file(out);
    std::optional<double> total;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with("summary: ")) total = std::stod(line.substr(9));
    }
    std::filesystem::remove(out);
    return total;
}

/// Host instructions per guest instruction: the difference of two runs, so that start-up drops out.
std::string host_per_guest(const std::string& self, const char* core, const char* program) {
    constexpr uint64_t kShort = 200'000;
    constexpr uint64_t kLong = 1'200'000;
    const auto few = host_instructions(self, core, program, kShort);
    const auto many = host_instructions(self, core, program, kLong);
    if (!few || !many) return "-";
    return fmt::format("{:.1f}", (*many - *few) / static_cast<double>(kLong - kShort));
}

void print_table(const std::string& self, double seconds, bool callgrind) {
    fmt::print("{:<11} {:>10} {:>10} {:>11} {:>11} {:>7}{}\n", "program", "plain", "fast", "plain",
               "fast", "ratio", callgrind ? "   host instructions per instruction" : "");
    fmt::print("{:<11} {:>10} {:>10} {:>11} {:>11} {:>7}{}\n", "", "MIPS", "MIPS", "MHz", "MHz", "",
               callgrind ? "   plain   fast" : "");
    for (const Program& program : kPrograms) {
        const Subject subject = make_subject(program);
        Speed plain;
        Speed fast;
        for (int turn = 0; turn < 5; ++turn) {
            keep_best(plain, measure(subject, false, seconds));
            keep_best(fast, measure(subject, true, seconds));
        }
        fmt::print("{:<11} {:>10.0f} {:>10.0f} {:>11.0f} {:>11.0f} {:>7.2f}", program.name,
                   plain.instructions_per_s / 1e6, fast.instructions_per_s / 1e6,
                   plain.t_states_per_s / 1e6, fast.t_states_per_s / 1e6,
                   fast.instructions_per_s / plain.instructions_per_s);
        if (callgrind) {
            fmt::print("   {:>5} {:>6}", host_per_guest(self, "plain", program.name),
                       host_per_guest(self, "fast", program.name));
        }
        fmt::print("\n");
        std::fflush(stdout);
    }
}

int run_once(std::string_view core, std::string_view name, uint64_t instructions) {
    constexpr uint64_t kSliceT = 10'000;
    for (const Program& program : kPrograms) {
        if (name != program.name) continue;
        const Subject subject = make_subject(program);
        while (subject.instructions() < instructions) subject.run(core == "fast", kSliceT);
        return 0;
    }
    fmt::print(stderr, "cpu_benchmark: {}: no such program\n", name);
    return 2;
}

}  // namespace

int main(int argc, char** argv) {
    double seconds = 0.3;
    bool callgrind = false;
    for (int i = 1; i < argc; ++i) {
        const std::string_view option = argv[i];
        if (option == "--run" && i + 3 < argc) {
            return run_once(argv[i + 1], argv[i + 2], std::strtoull(argv[i + 3], nullptr, 10));
        }
        if (option == "--callgrind") {
            callgrind = true;
        } else if (option == "--seconds" && i + 1 < argc) {
            seconds = std::strtod(argv[++i], nullptr);
        } else {
            fmt::print(stderr, "usage: cpu_benchmark [--seconds S] [--callgrind]\n");
            return 2;
        }
    }
    print_table(argv[0], seconds, callgrind);
    return 0;
}
