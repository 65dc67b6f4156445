// The oracle and our compiler, each on programs whose checksum is known from elsewhere: zlib's CRC.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <fstream>
#include <vector>

#include "tests/toolchain/csmith/compare.hpp"
#include "tests/toolchain/csmith/process.hpp"

namespace csmith_test {
namespace {

using Kind = Observation::Kind;
using toolchain::codegen::Opcode;

/// A program of csmith's shape: `body` in func_1, and a checksum over g_1.
class Written {
public:
    explicit Written(const std::string& body, const std::string& before = "") {
        std::ofstream(program.source) << fmt::format(
            "#include \"csmith.h\"\n"
            "static volatile uint64_t g_1 = 5;\n"
            "{}\n"
            "static void func_1(void) {{ {} }}\n"
            "int main(void) {{\n"
            "    platform_main_begin();\n"
            "    crc32_gentab();\n"
            "    func_1();\n"
            "    transparent_crc(g_1, \"g_1\", 0);\n"
            "    platform_main_end(crc32_context ^ 0xFFFFFFFFUL, 0);\n"
            "    return 0;\n"
            "}}\n",
            before, body);
    }

private:
    WorkFolder folder_;

public:
    Program program{folder_.path() / "written.c", {}};
};

uint32_t crc_of(const std::vector<uint64_t>& values) {
    uLong crc = crc32(0, nullptr, 0);
    for (const uint64_t value : values) {
        std::array<Bytef, 8> bytes{};
        for (unsigned i = 0; i < 8; ++i) bytes.at(i) = static_cast<Bytef>(value >> 8 * i);
        crc = crc32(crc, bytes.data(), bytes.size());
    }
    return static_cast<uint32_t>(crc);
}

Observation checksum(uint32_t value) {
    return {Kind::checksum, value, {}};
}

constexpr const char* kArithmetic =
    "int16_t a = -300; uint8_t b = 200; int8_t i;"
    "for (i = 0; i < 3; ++i) g_1 = g_1 * 1000003u + (uint64_t)(a * (int32_t)b);";

uint64_t arithmetic() {
    uint64_t value = 5;
    for (int i = 0; i < 3; ++i) value = value * 1000003U + static_cast<uint64_t>(int64_t{-60000});
    return value;
}

Observation at_level(const Program& program, const std::string& level, Layer layer) {
    SubjectOptions options;
    options.level = level;
    return observe_subject(program, layer, options);
}

class Layers : public testing::TestWithParam<std::string> {};

TEST_P(Layers, ComputeTheChecksumThatZlibComputes) {
    const Written written(kArithmetic);
    const Observation expected = checksum(crc_of({arithmetic()}));
    EXPECT_EQ(observe_avr(written.program, GetParam()), expected);
    EXPECT_EQ(at_level(written.program, GetParam(), Layer::mir), expected);
    EXPECT_EQ(at_level(written.program, GetParam(), Layer::image), expected);
}

INSTANTIATE_TEST_SUITE_P(Level, Layers, testing::Values("0", "1", "2", "s"));

TEST(ObserveAvr, TellsEndlessFromRefused) {
    EXPECT_EQ(observe_avr(Written("for (;;) g_1 += 1;").program).kind, Kind::no_end);
    const Observation refused = observe_avr(Written("this is not C").program);
    EXPECT_EQ(refused.kind, Kind::refused);
    EXPECT_NE(refused.text.find("written.c:4"), std::string::npos) << refused.text;
}

TEST(ObserveSubject, TellsEndlessFromRefusedFromTooLarge) {
    for (const Layer layer : {Layer::mir, Layer::image}) {
        const Written endless("for (;;) g_1 += 1;");
        EXPECT_EQ(at_level(endless.program, "1", layer).kind, Kind::no_end);
        const Observation refused = at_level(Written("this is not C").program, "1", layer);
        EXPECT_EQ(refused.kind, Kind::refused);
        EXPECT_NE(refused.text.find("written.c:4"), std::string::npos) << refused.text;
    }
    const Written large("g_1 = g_3[g_1];", "static volatile uint8_t g_3[20000];");
    EXPECT_EQ(at_level(large.program, "1", Layer::image).kind, Kind::too_large);
}

TEST(Csmith_h, OnlyOneValueWhenAskedFor) {
    Written written(kArithmetic);
    written.program.options = {"-DROVER_ONLY=1"};
    const auto value = arithmetic();
    const Observation expected =
        checksum(static_cast<uint32_t>(value) ^ static_cast<uint32_t>(value >> 32));
    EXPECT_EQ(observe_avr(written.program), expected);
    EXPECT_EQ(at_level(written.program, "2", Layer::mir), expected);
}

TEST(Csmith_h, HidesFirstValuesFromTheOptimiser) {
    // Without the escape the product is a number to the optimiser, and no multiplication is
    // left.
    const char* body = "g_1 = g_2 * g_2;";
    const char* variable = "static uint32_t g_2 = 3;";
    const auto multiplies = [](const Program& program) {
        SubjectOptions options;
        options.level = "2";
        options.meddle_mir = [](toolchain::codegen::Module& module) {
            if (!module.symbol_ids.contains("__mul32")) throw std::runtime_error("none");
        };
        return observe_subject(program, Layer::mir, options).kind == Kind::checksum;
    };
    const Written plain(body, variable);
    Written opaque(body, variable + escapes_of(fmt::format("\n{}\n", variable)));
    opaque.program.options = {"-DROVER_OPAQUE"};
    EXPECT_FALSE(multiplies(plain.program));
    EXPECT_TRUE(multiplies(opaque.program));
}

// -- A comparison, with faults put in -----------------------------------------------------------

void spoil_first(toolchain::codegen::Module& module, Opcode opcode) {
    for (auto& function : module.functions) {
        for (auto& block : function.blocks) {
            for (auto& operation : block.operations) {
                if (operation.opcode != opcode) continue;
                operation.opcode = opcode == Opcode::add ? Opcode::subtract : Opcode::add;
                return;
            }
        }
    }
}

TEST(Compare, AgreesOnAProgramWithoutFault) {
    EXPECT_EQ(compare(Written(kArithmetic).program, {}), Finding{});
}

TEST(Compare, ReportsAFaultOfOneLevel) {
    CompareOptions options;
    options.layer = Layer::mir;
    options.levels = {"0", "1"};
    options.subject.meddle_mir = [](toolchain::codegen::Module& module) {
        spoil_first(module, Opcode::add);
    };
    const Finding finding = compare(Written(kArithmetic).program, options);
    EXPECT_EQ(finding.verdict, Verdict::difference);
    EXPECT_NE(finding.text.find("-O1: "), std::string::npos) << finding.text;
}

TEST(Compare, LocatesAFaultInTheFrontHalfOrInCodeGeneration) {
    const Written written(kArithmetic);
    CompareOptions options;
    options.levels = {"1"};
    options.subject.meddle_image = [](toolchain::assembly::Program& program) {
        const auto* table = program.find("rover_crc_nibbles");
        ASSERT_NE(table, nullptr);
        program.image.bytes.at(table->value + 5U) ^= 1;
    };
    const Finding back = compare(written.program, options);
    EXPECT_EQ(back.verdict, Verdict::difference);
    EXPECT_NE(back.text.find("code generation: right in MIR"), std::string::npos) << back.text;
    options.subject.meddle_mir = [](toolchain::codegen::Module& module) {
        spoil_first(module, Opcode::add);
    };
    const Finding front = compare(written.program, options);
    EXPECT_NE(front.text.find("front half: "), std::string::npos) << front.text;
}

TEST(Compare, ReportsAStoreIntoRom) {
    CompareOptions options;
    options.levels = {"1"};
    // The address of the jump at 0000: the program has come from there and does not go back.
    const Written written("*(volatile uint8_t*)0x0001 ^= 1;");
    const Finding finding = compare(written.program, options);
    EXPECT_EQ(finding.verdict, Verdict::failed);
    EXPECT_NE(finding.text.find("a store into ROM"), std::string::npos) << finding.text;
}

TEST(Compare, ReportsAProgramThatDoesNotEndAndACrash) {
    CompareOptions options;
    options.layer = Layer::mir;
    options.levels = {"1"};
    options.subject.meddle_mir = [](toolchain::codegen::Module& module) {
        for (auto& function : module.functions) {
            auto& end = function.blocks.at(0).terminator;
            end = {};
            end.kind = toolchain::codegen::Terminator::Kind::jump;
            end.edges = {{0, {}}};
        }
    };
    EXPECT_EQ(compare(Written(kArithmetic).program, options).verdict, Verdict::no_end);
    options.subject.meddle_mir = [](toolchain::codegen::Module&) { std::abort(); };
    EXPECT_EQ(compare(Written(kArithmetic).program, options).verdict, Verdict::failed);
}

TEST(Compare, SkipsWhatTheOracleDoesNotEnd) {
    EXPECT_EQ(compare(Written("for (;;) g_1 += 1;").program, {}).verdict, Verdict::skipped);
}

TEST(Compare, DoubtsAProgramThatOverflows) {
    // Level 1 alone is spoiled, so the difference is there; the program is wrong as well.
    CompareOptions options;
    options.layer = Layer::mir;
    options.levels = {"1"};
    options.subject.meddle_mir = [](toolchain::codegen::Module& module) {
        spoil_first(module, Opcode::add);
    };
    const std::string overflow = " volatile int16_t top = INT16_MAX; top = top + 1;";
    EXPECT_EQ(compare(Written(kArithmetic + overflow).program, options).verdict, Verdict::doubtful);
}

TEST(CompareSeed, KeepsTheProgramOfAFault) {
    const WorkFolder folder;
    CompareOptions options;
    options.layer = Layer::mir;
    options.levels = {"0"};
    options.keep = folder.path() / "kept";
    EXPECT_EQ(compare_seed(2, options).verdict, Verdict::agreed);
    EXPECT_FALSE(std::filesystem::exists(options.keep));
    options.subject.meddle_mir = [](toolchain::codegen::Module& module) {
        spoil_first(module, Opcode::bit_xor);
    };
    EXPECT_EQ(compare_seed(2, options).verdict, Verdict::difference);
    EXPECT_TRUE(std::filesystem::exists(options.keep / "2.c"));
}

}  // namespace
}  // namespace csmith_test
