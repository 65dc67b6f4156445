// refusals_test.cpp - exit codes and messages of the real i85run for bad files and bad usage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tools/i85run/run_program.hpp"

namespace {

using i85run_test::Folder;
using i85run_test::Outcome;
using testing::HasSubstr;

// NOP; HLT at 0000h. Checksum: -(02 + 00 + 00 + 00 + 00 + 76) = 88.
constexpr const char* kHex = ":02000000007688\n:00000001FF\n";

class I85runRefusals : public testing::Test {
protected:
    I85runRefusals() {
        folder_.write("good.hex", kHex);
        folder_.write("good.sym", "0000 0002 F main\n8000 0000 D unsized\n");
    }

    /// One line on standard error with these words and what to do; nothing on standard output.
    void expect(int exit_code, const std::vector<std::string>& arguments,
                const std::vector<std::string>& words) {
        const Outcome run = folder_.run(arguments);
        const std::string command = testing::PrintToString(arguments);
        EXPECT_EQ(run.exit_code, exit_code) << command << run.err;
        EXPECT_EQ(run.out, "") << command;
        EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << command << run.err;
        EXPECT_THAT(run.err, testing::StartsWith("i85run: "));
        EXPECT_THAT(run.err, HasSubstr("; ")) << "what to do";
        for (const std::string& word : words) EXPECT_THAT(run.err, HasSubstr(word)) << command;
    }

    void expect_bad(const std::vector<std::string>& arguments,
                    const std::vector<std::string>& words) {
        expect(3, arguments, words);
    }
    void expect_usage(const std::vector<std::string>& arguments,
                      const std::vector<std::string>& words) {
        expect(2, arguments, words);
    }

    Folder folder_;
};

TEST_F(I85runRefusals, TheGoodFileIsGood) {
    EXPECT_EQ(folder_.run({"good.hex"}).exit_code, 0);
}

TEST_F(I85runRefusals, DamagedHexFilesNameTheirLine) {
    folder_.write("torn.hex", ":02000000007688\n");
    expect_bad({"torn.hex"}, {"torn.hex"});
    folder_.write("sum.hex", ":02000000007689\n:00000001FF\n");
    expect_bad({"sum.hex"}, {"sum.hex:1: ", "checksum"});
    folder_.write("text.hex", "\nThe rover drove well.\n");
    expect_bad({"text.hex"}, {"text.hex:2: "});
    folder_.write("empty.hex", "");
    expect_bad({"empty.hex"}, {"empty.hex"});
    folder_.write("binary.hex", std::vector<uint8_t>{0x31, 0x00, 0x80, 0x76});
    expect_bad({"binary.hex"}, {"binary.hex:1: "});
}

TEST_F(I85runRefusals, FilesThatAreNotThere) {
    expect_bad({"absent.hex"}, {"absent.hex: cannot be opened"});
    expect_bad({"."}, {".: "});
    expect_bad({"absent.bin", "--load", "0"}, {"absent.bin: cannot be opened"});
    expect_bad({"--cpm", "absent.com"}, {"absent.com: cannot be opened"});
    expect_bad({"good.hex", "--symbols", "absent.sym"}, {"absent.sym: cannot be opened"});
    expect_bad({"good.hex", "--json", "nowhere/r.json"},
               {"nowhere/r.json: cannot be opened for writing"});
}

TEST_F(I85runRefusals, BinariesThatDoNotFit) {
    folder_.write("big.bin", std::vector<uint8_t>(0x1001, 0x76));
    expect_bad({"big.bin", "--load", "0xF000"}, {"big.bin", "4097", "F000"});
    folder_.write("empty.bin", "");
    expect_bad({"empty.bin", "--load", "0"}, {"empty.bin"});
    expect_bad({"--cpm", "empty.bin"}, {"empty.bin"});
    folder_.write("big.com", std::vector<uint8_t>(0xFD01, 0xC9));
    expect_bad({"--cpm", "big.com"}, {"big.com: has 64769 bytes", "at most 64768"});
    folder_.write("fits.com", std::vector<uint8_t>(0xFD00, 0x00));
    EXPECT_EQ(folder_.run({"--cpm", "fits.com", "--max-t", "100"}).exit_code, 1);
}

TEST_F(I85runRefusals, SymbolFilesNameTheirLine) {
    folder_.write("bad.sym", "0000 0002 F main\n12 34\n");
    expect_bad({"good.hex", "--symbols", "bad.sym"}, {"bad.sym:2: "});
    folder_.write("good.sym", "nonsense\n");
    expect_bad({"good.hex"}, {"good.sym:1: "});
}

TEST_F(I85runRefusals, UnknownNames) {
    expect_bad({"good.hex", "--entry", "mian"}, {"good.sym", "mian", "--entry"});
    expect_bad({"good.hex", "--count-function", "mian"}, {"mian", "--count-function"});
    expect_bad({"good.hex", "--dump", "mian"}, {"mian", "--dump"});
    expect_bad({"good.hex", "--dump", "mian:4"}, {"mian", "--dump"});
    expect_bad({"good.hex", "--dump", "unsized"}, {"good.sym:2: ", "--dump unsized:LEN"});
    folder_.write("alone.hex", kHex);
    expect_bad({"alone.hex", "--entry", "main"}, {"alone.hex", "no symbol file"});
}

TEST_F(I85runRefusals, Usage) {
    expect_usage({}, {"IMAGE"});
    expect_usage({"good.hex", "--bogus"}, {"--bogus"});
    expect_usage({"good.hex", "more.hex"}, {"more.hex"});
    expect_usage({"good.hex", "--max-t", "soon"}, {"soon"});
    expect_usage({"good.hex", "--max-t", "-1"}, {"-1"});
    expect_usage({"good.hex", "--load", "0x10000"}, {"0x10000", "is not an address"});
    expect_usage({"good.hex", "--sp", "top"}, {"top", "is not an address"});
    expect_usage({"good.hex", "--cpu", "z80"}, {"z80"});
    expect_usage({"good.hex", "--rom", "0x7FFF"}, {"0x7FFF", "LO:HI"});
    expect_usage({"good.hex", "--rom", "5:4"}, {"5:4"});
    expect_usage({"good.hex", "--strict"}, {"--rom"});
    expect_usage({"good.hex", "--dump", "0x8000"}, {"0x8000", "ADDR:LEN"});
    expect_usage({"good.hex", "--dump", "main:0"}, {"main:0"});
    expect_usage({"good.hex", "--dump", "0xFFFF:2"}, {"0xFFFF:2", "beyond FFFFh"});
    expect_usage({"--cpm", "good.hex", "--entry", "main"}, {"--cpm"});
    expect_usage({"good.hex", "--trace-from", "5"}, {"--trace"});
}

TEST_F(I85runRefusals, HelpTeachesByExample) {
    const Outcome help = folder_.run({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.err, "");
    for (const char* words : {"Examples", "--cpm 8080EX1.COM", "--count-function", "Exit codes"}) {
        EXPECT_THAT(help.out, HasSubstr(words));
    }
}

}  // namespace
