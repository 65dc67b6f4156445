// Every integer operation on images: widths x corner operands, at run time and as constants, at
// every optimisation level; expected values from 128-bit arithmetic on the host.
// ROVER_TARGET_FULL=1 tries all widths at all levels (minutes).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "tests/target/compile.hpp"
#include "tests/target/machine.hpp"
#include "tests/target/operation_table.hpp"

namespace target_test {
namespace {

/// How all cases of a table are compiled.
struct Setting {
    Level level;
    bool in_ir = false;
    bool undocumented = false;  ///< instructions too
};

toolchain::assembly::Program compiled(const std::vector<Case>& cases, const Setting& setting) {
    toolchain::driver::Request made = request(setting.level.level);
    made.undocumented = setting.undocumented;
    made.front_end = {"-std=c2x", "-fwrapv"};
    made.keep = {"in_a", "in_b", "out", "request"};
    made.sources = {{.path = "main.c", .text = c_main(cases.size())}};
    if (setting.in_ir) {
        made.sources.push_back({.path = "operations.ll", .text = ir_functions(cases)});
    } else {
        made.sources.push_back({.path = "operations.c", .text = c_functions(cases)});
    }
    return toolchain::driver::compile_program(made).program;
}

/// Runs a case for one pair of operands.
/// @return  checks made
std::size_t check(Machine& machine, const Case& one, uint64_t a, uint64_t b) {
    std::vector<std::optional<uint64_t>> wanted;
    for (const Output& output : one.outputs) wanted.push_back(output.expected(a, b));
    if (std::ranges::none_of(wanted, [](const auto& value) { return value.has_value(); })) return 0;
    machine.write(machine.address("in_a"), 8, a);
    machine.write(machine.address("in_b"), 8, b);
    machine.run();
    std::size_t checks = 0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (!wanted[i]) continue;
        const IntType type = one.outputs[i].type;
        const auto slot = static_cast<uint16_t>(machine.address("out") + 8 * i);
        EXPECT_EQ(machine.read(slot, type.bytes()) & type.mask(), *wanted[i])
            << fmt::format("{}: {}; operands {:X}, {:X}", one.name, one.outputs[i].what, a, b);
        ++checks;
    }
    return checks;
}

/// All cases of one image.
std::size_t check_image(const std::vector<Case>& cases, const Setting& setting) {
    Machine machine(compiled(cases, setting), setting.undocumented
                                                  ? host_sim::InstructionSet::all
                                                  : host_sim::InstructionSet::documented);
    machine.run();
    std::size_t checks = 0;
    for (std::size_t i = 0; i < cases.size() && !testing::Test::HasFailure(); ++i) {
        const Case& one = cases[i];
        machine.write(machine.address("request"), 2, i);
        for (const uint64_t a : corners(one.left)) {
            if (one.unary) {
                checks += check(machine, one, a, 0);
                continue;
            }
            for (const uint64_t b : corners(one.right)) checks += check(machine, one, a, b);
        }
    }
    EXPECT_TRUE(machine.rom_is_intact());
    return checks;
}

/// In as many images as they take.
std::size_t check_images(const std::vector<Case>& cases, const Setting& setting) {
    try {
        return check_image(cases, setting);
    } catch (const toolchain::driver::Failed& failed) {
        const bool too_large = std::string(failed.what()).starts_with("ROM: ");
        if (!too_large || cases.size() == 1) throw;
    }
    const auto middle = cases.begin() + static_cast<std::ptrdiff_t>(cases.size() / 2);
    return check_images({cases.begin(), middle}, setting) +
           check_images({middle, cases.end()}, setting);
}

/// About what fits into an image: results times their width.
constexpr std::size_t kImageBits = 7000;

void check_all(const std::vector<Case>& cases, const Setting& setting) {
    std::vector<Case> group;
    std::size_t bits = 0;
    std::size_t checks = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        ASSERT_LE(cases[i].outputs.size(), kOutputSlots);
        bits += cases[i].outputs.size() * cases[i].left.bits;
        group.push_back(cases[i]);
        if (bits < kImageBits && i + 1 < cases.size()) continue;
        checks += check_images(group, setting);
        group.clear();
        bits = 0;
    }
    EXPECT_GT(checks, cases.size());
    fmt::print("{} cases, {} checks\n", cases.size(), checks);
}

bool is_full() {
    return std::getenv("ROVER_TARGET_FULL") != nullptr;
}

/// Without the cases that take longest to compile: many wide results in one function. Of 32 bits
/// those stay that selection treats by constant.
std::vector<Case> quick(std::vector<Case> cases) {
    std::erase_if(cases, [](const Case& one) {
        if (one.name.find("constant") == one.name.npos) return false;
        const bool is_special = one.name.starts_with("mul") || one.name.starts_with("sh") ||
                                one.name.starts_with("cmp");
        return one.left.bits > (is_special ? 32 : 16);
    });
    return cases;
}

struct Table {
    Setting setting;
    std::vector<unsigned> widths;
};

void PrintTo(const Table& table, std::ostream* stream) {
    *stream << table.setting.level.name;
}

class Operations : public testing::TestWithParam<Table> {};

TEST_P(Operations, GiveWhatTheLanguageSays) {
    const Table& table = GetParam();
    for (const unsigned bits : table.widths) {
        auto cases = table.setting.in_ir ? ir_cases({bits}) : c_cases({bits});
        const bool searches = table.setting.level.level != Optimisation::none;
        if (searches && !is_full()) cases = quick(std::move(cases));
        check_all(cases, table.setting);
    }
}

/// Everything, or what a run of all tests has time for: without search for registers all tables,
/// with it those that differ most.
std::vector<Table> tables() {
    const bool full = is_full();
    const Level& none = kLevels.front();
    const Level& size = kLevels.back();
    std::vector<Table> made;
    for (const unsigned bits : {8U, 16U, 32U, 64U}) {
        for (const Level& level : kLevels) {
            // For single operations -O1, -O2 and -Os give nearly the same.
            const bool typical = (&level == &size && !kSlowBuild) || bits == 8;
            if (full || &level == &none || typical) {
                made.push_back({{level}, {bits}});
            }
        }
    }
    // Widths that only LLVM makes.
    for (const unsigned bits :
         {1U, 2U, 3U, 5U, 7U, 8U, 9U, 12U, 15U, 17U, 20U, 24U, 31U, 33U, 40U, 48U, 63U}) {
        made.push_back({{none, true}, {bits}});
        const bool typical =
            !kSlowBuild && (bits == 1 || bits == 3 || bits == 8 || bits == 12 || bits == 40);
        if (full || typical) made.push_back({{size, true}, {bits}});
    }
    for (std::size_t i = 0, count = made.size(); i < count; ++i) {
        Table with = made[i];
        with.setting.undocumented = true;
        made.push_back(with);
    }
    return made;
}

INSTANTIATE_TEST_SUITE_P(Tables, Operations, testing::ValuesIn(tables()), [](const auto& test) {
    const Setting& setting = test.param.setting;
    return fmt::format("{}_{}{}{}", setting.level.name, setting.in_ir ? "i" : "c",
                       test.param.widths.front(), setting.undocumented ? "_undocumented" : "");
});

class BitFields : public testing::TestWithParam<Level> {};

TEST_P(BitFields, KeepTheirValuesAndLeaveTheirNeighboursAlone) {
    for (const bool undocumented : {false, true}) {
        check_all(field_cases(1, 20), {GetParam(), false, undocumented});
    }
}

INSTANTIATE_TEST_SUITE_P(Levels, BitFields, testing::Values(kLevels.front(), kLevels.back()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace target_test
