// cpm_programs_test.cpp - two whole CP/M programs on the real i85run: exact cost of one, and an
// exerciser whose expected CRCs come from a bit-level model of the instructions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/assemble.hpp"
#include "tests/tools/i85run/instruction_model.hpp"
#include "tests/tools/i85run/run_program.hpp"

namespace {

using i85run_test::Folder;
using i85run_test::ModelState;
using i85run_test::Outcome;
using nlohmann::json;
using test_support::Assembled;
using testing::HasSubstr;
using testing::StartsWith;

Assembled assemble_file(const std::string& name) {
    std::ifstream in(std::string(ROVER_SOURCE_DIR) + "/tests/tools/i85run/" + name);
    const std::string source{std::istreambuf_iterator<char>(in), {}};
    return test_support::assemble(source);
}

// T-states and instructions of hello.asm, from Intel's table. A BDOS call costs CALL 18 and RET 10.
//   text     LXI 10, MVI 7, CALL 18, RET 10                                  45 T     4
//   instructions set-up   LXI 10, LXI 10                                                  20 2 loop
//   100 x (DAD 10, DCX 6, MOV 4, ORA 4) + 99 x JNZ 10 + JNZ 7     3397     500 digit d  LXI 10,
//   CALL 18, MVI 7, (d+1) x (INR 4, DAD 10), d x JC 10, JC 7,
//            6 x MOV/SUB/SBB 4, PUSH 12, MOV 4, MVI 7, CALL 18, RET 10, POP 10, RET 10
//                                                                   151 + 24 d     19 + 3 d
//            for 5, 0, 5                                                    693      87
//   unit     MOV 4, ADI 7, MOV 4, MVI 7, CALL 18, RET 10                     50       6
//   newline  as text                                                         45       4
//   JMP 0                                                                    10       1
constexpr uint64_t kHelloT = 45 + 20 + 3397 + 693 + 50 + 45 + 10;
constexpr uint64_t kHelloInstructions = 4 + 2 + 500 + 87 + 6 + 4 + 1;

TEST(I85runCpmPrograms, HelloPrintsItsSumAtExactlyItsCost) {
    const Folder folder;
    folder.write("hello.com", assemble_file("hello.asm").bytes);
    const Outcome run = folder.run({"--cpm", "hello.com", "--json", "hello.json"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_THAT(run.out, StartsWith("The sum of 1 to 100 is 5050\r\n"));
    EXPECT_THAT(run.out, HasSubstr("\nt_states      " + std::to_string(kHelloT) + "\n"));
    const json results = json::parse(folder.read("hello.json"));
    EXPECT_EQ(results["t_states"], kHelloT);
    EXPECT_EQ(results["instructions"], kHelloInstructions);
    EXPECT_EQ(results["halted"], true);
    EXPECT_EQ(results["end"], "warm_boot");
}

TEST(I85runCpmPrograms, ObservedItCostsTheSame) {
    const Folder folder;
    const Assembled hello = assemble_file("hello.asm");
    folder.write("hello.com", hello.bytes);
    const std::string digit = std::to_string(hello.symbols.at("DIGIT"));
    const Outcome run =
        folder.run({"--cpm", "hello.com", "--json", "hello.json", "--count-function", digit});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const json results = json::parse(folder.read("hello.json"));
    EXPECT_EQ(results["t_states"], kHelloT);
    EXPECT_EQ(results["instructions"], kHelloInstructions);
    // DIGIT alone: 151 + 24 d less LXI 10 and CALL 18.
    EXPECT_EQ(results["function_t_states"], 3 * 123 + 24 * (5 + 0 + 5));
    EXPECT_EQ(results["function"]["calls"], 3);
    EXPECT_EQ(results["function"]["t_states_worst"], 123 + 24 * 5);
}

// -- The exerciser -------------------------------------------------------------------------------

constexpr std::size_t kEntryBytes = 9, kOpcode = 2, kMask = 3, kKind = 4, kCrc = 5;
constexpr std::array<uint8_t, 4> kFlagValues = {0x00, 0xF7, 0x01, 0x10};

/// The CRC that exerciser.asm must reach for a group, without the final complement of CRC-32.
uint32_t expected_crc(uint8_t opcode, uint8_t mask, unsigned flag_values) {
    std::vector<uint8_t> states;
    const unsigned b_count = flag_values == 4 ? 1 : 256;
    for (unsigned f = 0; f < flag_values; ++f) {
        for (unsigned b = 0; b < b_count; ++b) {
            for (unsigned a = 0; a < 256; ++a) {
                ModelState state;
                state.a = state.l = static_cast<uint8_t>(a);
                state.b = state.h = static_cast<uint8_t>(b);
                state.c = static_cast<uint8_t>(~a);
                set_flag_byte(state, kFlagValues[f]);
                EXPECT_TRUE(execute(state, opcode)) << "not in the model: " << int{opcode};
                states.insert(states.end(), {static_cast<uint8_t>(flag_byte(state) & mask), state.a,
                                             state.l, state.h});
            }
        }
    }
    const auto size = static_cast<uInt>(states.size());
    return ~static_cast<uint32_t>(crc32(0, states.data(), size));
}

class I85runExerciser : public testing::Test {
protected:
    I85runExerciser() {
        const Assembled exerciser = assemble_file("exerciser.asm");
        program_ = exerciser.bytes;
        const std::size_t groups = exerciser.symbols.at("GROUPS") - 0x0100U;
        for (std::size_t at = groups; program_[at] != 0 || program_[at + 1] != 0;
             at += kEntryBytes) {
            set_crc(at, expected_crc(program_[at + kOpcode], program_[at + kMask],
                                     program_[at + kKind]));
            entries_.push_back(at);
        }
    }

    void set_crc(std::size_t entry, uint32_t crc) {
        for (std::size_t byte = 0; byte < 4; ++byte) {
            program_[entry + kCrc + byte] = static_cast<uint8_t>(crc >> (8 * byte));
        }
    }

    /// The first word of each line that ends in `verdict`.
    static std::vector<std::string> groups_with(const std::string& verdict,
                                                const std::string& out) {
        std::vector<std::string> groups;
        std::istringstream lines(out);
        for (std::string line; std::getline(lines, line);) {
            if (line.ends_with(verdict + "\r")) groups.push_back(line.substr(0, line.find("  ")));
        }
        return groups;
    }

    Outcome run() {
        folder_.write("exercise.com", program_);
        return folder_.run({"--cpm", "exercise.com"});
    }

    Folder folder_;
    std::vector<uint8_t> program_;
    std::vector<std::size_t> entries_;
};

TEST_F(I85runExerciser, PassesEveryGroup) {
    const Outcome outcome = run();
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(
        groups_with("PASS", outcome.out),
        (std::vector<std::string>{"ADD B", "ADC B", "SUB B", "SBB B", "ANA B", "XRA B", "ORA B",
                                  "CMP B", "DAD B", "INX H", "DCX H", "INR A", "DCR A", "DAA",
                                  "RLC",   "RRC",   "RAL",   "RAR",   "CMA",   "CMC"}))
        << outcome.out;
    EXPECT_EQ(groups_with("FAIL", outcome.out), std::vector<std::string>());
}

TEST_F(I85runExerciser, AWrongResultFailsItsGroupAlone) {
    program_[entries_[4] + kOpcode] = 0xB0;  // ORA B where ANA B is expected
    program_[entries_[13] + kCrc] ^= 1;
    const Outcome outcome = run();
    EXPECT_EQ(groups_with("FAIL", outcome.out), (std::vector<std::string>{"ANA B", "DAA"}));
    EXPECT_EQ(groups_with("PASS", outcome.out).size(), entries_.size() - 2);
}

}  // namespace
