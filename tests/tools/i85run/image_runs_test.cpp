// image_runs_test.cpp - the real i85run on images: ends, entry, counts, dumps, protected memory.
// T-states are added up by hand from Intel's table, beside each program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "host_sim/image/image.hpp"
#include "tests/support/assemble.hpp"
#include "tests/tools/i85run/run_program.hpp"

namespace {

using i85run_test::Folder;
using i85run_test::Outcome;
using nlohmann::json;
using testing::HasSubstr;

/// A folder with prog.hex and the symbols of its functions and data.
class I85runImage : public testing::Test {
protected:
    void write_hex(const std::string& source) {
        const test_support::Assembled program = test_support::assemble(source);
        host_sim::Image image;
        for (std::size_t i = 0; i < program.bytes.size(); ++i) {
            image.put(static_cast<uint16_t>(program.origin + i), program.bytes[i]);
        }
        folder_.write("prog.hex", host_sim::write_hex(image));
    }

    void write_symbols(const std::string& lines) { folder_.write("prog.sym", lines); }

    /// Runs prog.hex with these options and --json.
    Outcome run(std::vector<std::string> options) {
        options.insert(options.begin(), {"prog.hex", "--json", "prog.json"});
        Outcome outcome = folder_.run(options);
        results_ = json::parse(folder_.read("prog.json"));
        return outcome;
    }

    Folder folder_;
    json results_;
};

// MVI 7; loop 3 x (DCR 4, JNZ 10 10 7): 39; STA 13; HLT 5: 64 T, 9 instructions
constexpr const char* kLoop = R"(
        MVI  B,3
LOOP:   DCR  B
        JNZ  LOOP
        MVI  A,5AH     ; 7 T
        STA  8000H
        HLT
)";
constexpr int kLoopT = 7 + 39 + 7 + 13 + 5;

TEST_F(I85runImage, RunsToHltAndTellsWhatItTook) {
    write_hex(kLoop);
    const Outcome outcome = run({"--dump", "0x7FFE:4", "--dump", "8000h:1"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(results_, (json{{"halted", true},
                              {"pc", 0x000C},
                              {"instructions", 10},
                              {"t_states", kLoopT},
                              {"function_t_states", nullptr},
                              {"dumps", {{"0x7FFE:4", "00765a00"}, {"8000h:1", "5a"}}},
                              {"end", "halt"}}))
        << "7FFFh holds the return trap";
    EXPECT_EQ(outcome.out,
              "end           HLT at 000Bh\n"
              "instructions  10\n"
              "t_states      71\n"
              "time          0.023 ms at 3.072 MHz, 0.035 ms at 2.000 MHz\n"
              "dump          0x7FFE:4: 4 bytes at 7FFEh\n"
              "  7FFEh       00 76 5a 00\n"
              "dump          8000h:1: 1 bytes at 8000h\n"
              "  8000h       5a\n");
}

TEST_F(I85runImage, MaxTEndsItWithOne) {
    write_hex("LOOP: JMP LOOP");
    const Outcome outcome = run({"--max-t", "1005"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(results_["halted"], false);
    EXPECT_EQ(results_["end"], "time_limit");
    EXPECT_EQ(results_["t_states"], 1010);
    EXPECT_EQ(results_["instructions"], 101);
    EXPECT_EQ(results_["pc"], 0);
    EXPECT_THAT(outcome.out, HasSubstr("did not finish: --max-t reached at PC 0000h"));
}

// From FIR: LXI 10, CALL 18 (SQUARE: MOV 4, ADD 4, RNC 12), STA 13, RET 10
constexpr const char* kFunctions = R"(
        HLT
        ORG  100H
FIR:    LXI  H,1234H
        CALL SQUARE
        STA  TOTAL
        RET
SQUARE: MOV  A,H
        ADD  H
        RNC
        HLT
        ORG  9000H
TOTAL:  DS   2
)";
TEST_F(I85runImage, AnEntryByNameRunsToItsReturn) {
    write_hex(kFunctions);
    write_symbols("0100 000A F fir\n9000 0002 D rover::total\n");
    const Outcome outcome = run({"--entry", "fir", "--dump", "rover::total"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(results_["halted"], true);
    EXPECT_EQ(results_["end"], "return");
    EXPECT_EQ(results_["t_states"], 10 + 18 + 4 + 4 + 12 + 13 + 10);
    EXPECT_EQ(results_["instructions"], 7);
    EXPECT_EQ(results_["dumps"]["rover::total"], "2400");
}

TEST_F(I85runImage, AnEntryMayBeAnAddress) {
    write_hex(kFunctions);
    EXPECT_EQ(run({"--entry", "0x10A"}).exit_code, 0);
    EXPECT_EQ(results_["t_states"], 4 + 4 + 12) << "H is 0: no carry";
}

TEST_F(I85runImage, CountFunctionIsExact) {
    write_hex(kFunctions);
    write_symbols("0100 000A F fir\n010A 0004 F square(unsigned char)\n9000 0002 D rover::total\n");
    Outcome outcome = run({"--entry", "fir", "--count-function", "square(unsigned char)"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(results_["function_t_states"], 20);
    EXPECT_EQ(results_["function"]["calls"], 1);
    EXPECT_THAT(outcome.out, HasSubstr("square(unsigned char): 1 calls, 20 T-states in all"));
    outcome = run({"--entry", "fir", "--count-function", "fir"});
    EXPECT_EQ(results_["function_t_states"], results_["t_states"]) << "the entry counts whole";
}

TEST_F(I85runImage, ACountChangesNothingElse) {
    write_hex(kLoop);
    run({});
    const json alone = results_;
    run({"--count-function", "2"});
    EXPECT_EQ(results_["t_states"], alone["t_states"]);
    EXPECT_EQ(results_["instructions"], alone["instructions"]);
    EXPECT_EQ(results_["pc"], alone["pc"]);
    EXPECT_EQ(results_["function_t_states"], 0);
    EXPECT_EQ(results_["function"]["unfinished"], true) << "reached, and HLT before a return";
}

TEST_F(I85runImage, DumpTakesSizesAndLengths) {
    write_hex(kFunctions);
    write_symbols("9000 0002 D rover::total\n9002 0000 D unsized\n");
    const Outcome outcome = run({"--entry", "0x100", "--dump", "rover::total", "--dump",
                                 "rover::total:1", "--dump", "unsized:2", "--dump", "0:65536"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(results_["dumps"]["rover::total"], "2400");
    EXPECT_EQ(results_["dumps"]["rover::total:1"], "24");
    EXPECT_EQ(results_["dumps"]["unsized:2"], "0000");
    EXPECT_EQ(results_["dumps"]["0:65536"].get<std::string>().size(), 131072u);
}

TEST_F(I85runImage, SymbolsMayComeFromElsewhere) {
    write_hex(kFunctions);
    folder_.write("other.sym", "0100 000A F start_here\n");
    EXPECT_EQ(run({"--symbols", "other.sym", "--entry", "start_here"}).exit_code, 0);
}

TEST_F(I85runImage, BinIsLoadedAndStartedAtItsAddress) {
    folder_.write("code.bin", std::vector<uint8_t>{0x3E, 0x77, 0x32, 0x00, 0x80, 0xC9});
    const Outcome outcome =
        folder_.run({"code.bin", "--load", "0x9000", "--dump", "0x8000:1", "--json", "code.json"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const json results = json::parse(folder_.read("code.json"));
    EXPECT_EQ(results["end"], "return");
    EXPECT_EQ(results["t_states"], 7 + 13 + 10);  // MVI, STA, RET
    EXPECT_EQ(results["dumps"]["0x8000:1"], "77");
}

TEST_F(I85runImage, TheStartRecordOfAHexFileIsTheEntry) {
    host_sim::Image image;
    image.put(0x0000, 0x00);
    image.put(0x2000, 0x76);
    image.start = 0x2000;
    folder_.write("prog.hex", host_sim::write_hex(image));
    EXPECT_EQ(run({}).exit_code, 0);
    EXPECT_EQ(results_["instructions"], 1);
}

TEST_F(I85runImage, WithoutByteAtZeroTheLowestOneIsTheEntry) {
    write_hex("ORG 4000H\nNOP\nHLT");
    EXPECT_EQ(run({}).exit_code, 0);
    EXPECT_EQ(results_["instructions"], 2);
    EXPECT_EQ(results_["pc"], 0x4002);
}

TEST_F(I85runImage, TheStackIsWhereTheUserSays) {
    write_hex("ORG 100H\nLXI H,0\nDAD SP\nSHLD 9000H\nRET");
    run({"--entry", "0x100", "--sp", "0xF000", "--dump", "0x9000:2"});
    EXPECT_EQ(results_["dumps"]["0x9000:2"], "feef") << "the return address is below it";
    run({"--entry", "0x100", "--dump", "0x9000:2"});
    EXPECT_EQ(results_["dumps"]["0x9000:2"], "feff");
}

TEST_F(I85runImage, UndocumentedInstructionsRunUnlessRefused) {
    write_hex("LXI H,8000H\nARHL\nHLT");
    EXPECT_EQ(run({}).exit_code, 0);
    EXPECT_EQ(results_["t_states"], 10 + 7 + 5);
    const Outcome outcome = run({"--cpu", "8085"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(results_["end"], "undefined_instruction");
    EXPECT_EQ(results_["pc"], 3);
    EXPECT_EQ(results_["halted"], false);
}

TEST_F(I85runImage, WritesToRomAreCountedOrFatal) {
    // MVI 7; STA 13, of which the last 3 T write; STA 13; HLT 5
    write_hex("MVI A,99H\nSTA 0\nSTA 7FFEH\nHLT");
    Outcome outcome = run({"--rom", "0:0x7FFF", "--dump", "0:1"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(results_["dumps"]["0:1"], "3e") << "ROM keeps its byte";
    EXPECT_EQ(
        results_["rom_writes"],
        (json{{"count", 2}, {"first", {{"pc", 2}, {"t", 20}, {"address", 0}, {"value", 0x99}}}}));
    outcome = run({"--rom", "0:0x7FFF", "--strict"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(results_["end"], "rom_write");
    EXPECT_EQ(results_["t_states"], 20);
    EXPECT_THAT(outcome.out, HasSubstr("the first at PC 0002h, T 20: 99h to 0000h"));
}

TEST_F(I85runImage, AnOverwrittenReturnIsNotTakenForTheEnd) {
    write_hex("ORG 100H\nMVI A,0\nSTA 7FFFH\nRET");
    const Outcome outcome = run({"--entry", "0x100"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(results_["end"], "return_lost");
}

TEST_F(I85runImage, WhereTheImageFillsTheRomHalfTheReturnIsAboveTheStack) {
    folder_.write("rom.bin", std::vector<uint8_t>(0x8000, 0xC9));  // RET everywhere
    const Outcome outcome = folder_.run(
        {"rom.bin", "--load", "0", "--entry", "0x10", "--dump", "0xFFFD:3", "--json", "rom.json"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const json results = json::parse(folder_.read("rom.json"));
    EXPECT_EQ(results["t_states"], 10);
    EXPECT_EQ(results["dumps"]["0xFFFD:3"], "ffff76");
}

TEST_F(I85runImage, AFullImageRunsWithoutAReturn) {
    std::vector<uint8_t> bytes(0x10000, 0x76);
    folder_.write("full.bin", bytes);
    EXPECT_EQ(folder_.run({"full.bin", "--load", "0"}).exit_code, 0);
    const Outcome outcome = folder_.run({"full.bin", "--load", "0", "--entry", "0x10"});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("full.bin: leaves no room for the return address"));
}

TEST_F(I85runImage, CpmInputComesFromStandardInput) {
    // Reads a character (function 1, echoed) and prints it again with function 2.
    const auto program =
        test_support::assemble("ORG 100H\nMVI C,1\nCALL 5\nMOV E,A\nMVI C,2\nCALL 5\nRET");
    folder_.write("echo.com", program.bytes);
    const Outcome outcome = folder_.run({"--cpm", "echo.com"}, "x");
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.out, testing::StartsWith("xx\nend "));
}

TEST_F(I85runImage, UnsupportedCpmCallsAreReportedOnce) {
    const auto program =
        test_support::assemble("ORG 100H\nMVI C,15\nCALL 5\nMVI C,15\nCALL 5\nJMP 0");
    folder_.write("open.com", program.bytes);
    const Outcome outcome = folder_.run({"--cpm", "open.com"});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_EQ(outcome.err,
              "i85run: BDOS function 15 is not supported; it reports an error (first called at T "
              "25)\n");
}

}  // namespace
