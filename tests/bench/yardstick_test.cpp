// Compiled functions of the firmware beside the same by hand, on the simulated processor with the
// same operands: both give what the host gives, and compiled code takes at most 1.5 times as long.
// What the difference consists of: docs/design/optimisations.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "tests/bench/yardsticks/functions.hpp"
#include "tests/target/machine.hpp"
#include "toolchain/asm/link.hpp"
#include "toolchain/asm/parse.hpp"
#include "toolchain/driver/driver.hpp"

namespace {

using toolchain::assembly::Module;
using toolchain::assembly::Program;
using yardstick::Cells;

constexpr unsigned kRuns = 500;
constexpr double kMostRatio = 1.5;
constexpr unsigned kSeed = 1994;
constexpr uint16_t kReturn = 0xFFF0;  ///< behind the stack: a HLT
constexpr uint64_t kHltT = 5;
const std::string kRoot = ROVER_SOURCE_DIR;

std::string text_of(const std::string& path) {
    std::ifstream file(kRoot + path);
    return {std::istreambuf_iterator<char>(file), {}};
}

Program compiled(toolchain::ir::Optimisation level) {
    toolchain::driver::Request request;
    request.level = level;
    request.front_end = {"-I" + kRoot, "-I" + kRoot + "/firmware/config/native"};
    request.keep = {"cells", "wss_search", "ring_update", "square_root", "arctangent"};
    request.sources = {{kRoot + "/tests/bench/yardsticks/functions.cpp"}};
    return toolchain::driver::compile_program(request).program;
}

Program by_hand() {
    std::vector<Module> modules;
    modules.push_back(toolchain::assembly::parse(text_of("/tests/bench/yardsticks/functions.s85"),
                                                 {.file = "functions.s85"}));
    for (const std::string routines : {"multiply.s85", "divide.s85"}) {
        modules.push_back(toolchain::assembly::parse(text_of("/toolchain/runtime/" + routines),
                                                     {.file = routines}));
    }
    std::string tables = "SECTION squares,constant,ALIGN 256\nsquares:\n";
    for (const uint8_t square : rover::slip::kSquareQ3) tables += fmt::format(" DB {}\n", square);
    tables += "SECTION arctangents,constant\narctangents:\n";
    for (const uint16_t angle : rover::kArctangentQ2Brad) tables += fmt::format(" DW {}\n", angle);
    modules.push_back(toolchain::assembly::parse(tables, {.file = "tables.s85"}));
    toolchain::assembly::LinkOptions options;
    options.roots = {"wss_search", "ring_update", "square_root", "arctangent"};
    options.stack_size = 64;
    return toolchain::assembly::link(std::move(modules), options);
}

/// Every byte as it lies in the 8085's memory.
std::vector<uint8_t> bytes_of(const Cells& cells) {
    std::vector<uint8_t> bytes;
    const auto add_word = [&](int word) {
        bytes.push_back(static_cast<uint8_t>(word));
        bytes.push_back(static_cast<uint8_t>(word >> 8));
    };
    for (const int16_t item : cells.ring.items) add_word(item);
    bytes.push_back(cells.ring.origin);
    bytes.insert(bytes.end(), std::begin(cells.match.steps), std::end(cells.match.steps));
    for (const uint8_t byte :
         {cells.match.last, cells.match.best, cells.match.least_q3, cells.match.fit_q3, cells.first,
          static_cast<uint8_t>(cells.off), cells.whole, cells.fraction, cells.root}) {
        bytes.push_back(byte);
    }
    for (const int word : {int{cells.square}, int{cells.y}, int{cells.x}, int{cells.angle_brad}}) {
        add_word(word);
    }
    return bytes;
}

Cells random_cells(std::mt19937& random) {
    Cells cells{};
    const auto below = [&](unsigned bound) { return static_cast<uint8_t>(random() % bound); };
    auto height = static_cast<int16_t>(random());
    for (int16_t& item : cells.ring.items) {  // neighbours differ by up to 128 mm
        item = height;
        height = static_cast<int16_t>(height + static_cast<int>(random() % 4096) - 2048);
    }
    cells.ring.origin = below(yardstick::kItems);
    // Misfits of some sigma around a place somewhere near.
    const int middle = 128 + below(60) - 30;
    for (uint8_t& step : cells.match.steps) {
        step = static_cast<uint8_t>(std::clamp(middle + below(41) - 20, 0, 255));
    }
    cells.first = static_cast<uint8_t>(2 * below(3));
    cells.off = static_cast<int8_t>(below(64) - 31);
    cells.whole = below(4);
    cells.fraction = below(256);
    const auto word = [&] { return static_cast<uint16_t>(random()); };
    cells.square = word();
    cells.y = static_cast<int16_t>(word());
    cells.x = static_cast<int16_t>(word());
    return cells;
}

/// A program, of which functions are called one at a time.
class Caller {
public:
    explicit Caller(const Program& program)
        : machine_(program), top_(static_cast<uint16_t>(program.stack.end())) {
        machine_.write(kReturn, 1, 0x76);
    }

    /// @return  T-states, RET included
    uint64_t call(const std::string& function, const Cells& before) {
        const std::vector<uint8_t> bytes = bytes_of(before);
        machine_.write(machine_.address("cells"), bytes);
        host_sim::CpuState& cpu = machine_.machine().cpu;
        cpu.halted = false;
        cpu.pc = machine_.address(function);
        cpu.sp = static_cast<uint16_t>(top_ - 2);
        machine_.write(cpu.sp, 2, kReturn);
        return machine_.run() - kHltT;
    }
    [[nodiscard]] std::vector<uint8_t> cells(std::size_t size) const {
        const auto seen = machine_.bytes(machine_.address("cells"), static_cast<uint32_t>(size));
        return {seen.begin(), seen.end()};
    }

private:
    target_test::Machine machine_;
    uint16_t top_;
};

struct Function {
    const char* name;
    void (*on_host)(Cells&);
};

void PrintTo(const Function& function, std::ostream* out) {  // name from GoogleTest
    *out << function.name;
}

class Yardstick : public testing::TestWithParam<Function> {};

void compare(const Function& function, toolchain::ir::Optimisation level, const char* name) {
    const Program ours = compiled(level);
    const Program hand = by_hand();
    Caller compiled_code(ours);
    Caller hand_written(hand);
    std::mt19937 random(kSeed);
    uint64_t compiled_t = 0;
    uint64_t hand_t = 0;
    for (unsigned run = 0; run < kRuns; ++run) {
        const Cells before = random_cells(random);
        Cells after = before;
        function.on_host(after);
        const std::vector<uint8_t> expected = bytes_of(after);
        compiled_t += compiled_code.call(function.name, before);
        hand_t += hand_written.call(function.name, before);
        ASSERT_EQ(compiled_code.cells(expected.size()), expected) << run;
        ASSERT_EQ(hand_written.cells(expected.size()), expected) << run;
    }
    const double ratio = static_cast<double>(compiled_t) / static_cast<double>(hand_t);
    EXPECT_LE(ratio, kMostRatio);
    fmt::print("{} {}: compiled {} T, by hand {} T on average, ratio {:.2f}, seed {}\n",
               function.name, name, compiled_t / kRuns, hand_t / kRuns, ratio, kSeed);
}

TEST_P(Yardstick, CompiledCodeIsNotMuchSlowerThanHandWritten) {
    compare(GetParam(), toolchain::ir::Optimisation::more, "-O2");
    compare(GetParam(), toolchain::ir::Optimisation::size, "-Os");
}

INSTANTIATE_TEST_SUITE_P(Functions, Yardstick,
                         testing::Values(Function{"wss_search", yardstick::wss_search},
                                         Function{"ring_update", yardstick::ring_update},
                                         Function{"square_root", yardstick::square_root},
                                         Function{"arctangent", yardstick::arctangent}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
