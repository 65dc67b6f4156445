// coverage_test.cpp - counting, listings, and .info files; genhtml (package lcov) is the
// independent reader.
#include "host_sim/trace/coverage.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "steps.hpp"

namespace {

namespace fs = std::filesystem;
using host_sim::BusAccess;
using host_sim::Coverage;
using host_sim::Image;
using host_sim::Listing;
using host_sim::Symbols;
using trace_test::add_access;
using trace_test::instruction;

void execute(Coverage& coverage, unsigned pc, const std::vector<unsigned>& code, int times = 1) {
    for (int i = 0; i < times; ++i) coverage.observe(instruction(pc, code, 0, 4));
}

Image image_of(unsigned address, const std::vector<unsigned>& bytes) {
    Image image;
    for (const unsigned byte : bytes) {
        image.put(static_cast<uint16_t>(address++), static_cast<uint8_t>(byte));
    }
    return image;
}

TEST(Coverage, CountsExecutionsReadsAndWritesByAddress) {
    Coverage coverage;
    auto step = instruction(0x0100, {0x34}, 0, 10);  // INR M
    add_access(step, BusAccess::Kind::read, 0x8000, 1);
    add_access(step, BusAccess::Kind::write, 0x8000, 2);
    coverage.observe(step);
    coverage.observe(step);
    auto out = instruction(0x0101, {0xD3, 0x08}, 0, 10);
    add_access(out, BusAccess::Kind::out, 0x08, 2);
    coverage.observe(out);
    EXPECT_EQ(coverage.opcode_count(0x34), 2u);
    EXPECT_EQ(coverage.executed(0x0100), 2u);
    EXPECT_EQ(coverage.executed(0x0102), 0u);  // an operand byte is no instruction
    EXPECT_EQ(coverage.read(0x8000), 2u);
    EXPECT_EQ(coverage.written(0x8000), 2u);
    EXPECT_EQ(coverage.written(0x0008), 0u);  // a port is no memory
    EXPECT_EQ(coverage.read(0x0100), 0u);
}

TEST(Coverage, AnInterruptIsNoInstruction) {
    Coverage coverage;
    host_sim::StepRecord trap;
    trap.kind = host_sim::StepRecord::Kind::trap;
    add_access(trap, BusAccess::Kind::write, 0x8FFF, 1);
    coverage.observe(trap);
    EXPECT_EQ(coverage.opcode_count(0x00), 0u);
    EXPECT_EQ(coverage.executed(0), 0u);
    EXPECT_EQ(coverage.written(0x8FFF), 1u);
}

TEST(Coverage, OpcodeTextNamesWhatIsMissing) {
    Coverage coverage;
    EXPECT_TRUE(coverage.opcode_text().starts_with("0 of 246 documented opcodes executed; not: "));
    for (unsigned opcode = 0; opcode < 256; ++opcode) {
        if (opcode != 0x27 && opcode != 0x4A && opcode != 0x08) execute(coverage, 0, {opcode});
    }
    EXPECT_EQ(coverage.opcode_text(),
              "244 of 246 documented opcodes executed; not: DAA; MOV C,D\n"
              "9 of 10 undocumented opcodes executed; not: DSUB\n");
    for (const unsigned opcode : {0x27u, 0x4Au, 0x08u}) execute(coverage, 0, {opcode});
    EXPECT_EQ(coverage.opcode_text(),
              "246 of 246 documented opcodes executed\n"
              "10 of 10 undocumented opcodes executed\n");
}

TEST(Listing, CodeAndDataBySymbols) {
    const Symbols symbols =
        host_sim::read_symbols("0100 0004 F main\n0104 0003 D table\n", "a.sym");
    const Image image = image_of(0x0100, {0xC3, 0x00, 0x01, 0xC9, 0xC3, 0x11, 0x22});
    const Listing listing = host_sim::make_listing(image, &symbols, Coverage());
    EXPECT_EQ(listing.text,
              "main:\n"
              "0100  C3 00 01  JMP main\n"
              "0103  C9        RET\n"
              "table:\n"
              "0104  C3        DB 0C3H\n"
              "0105  11        DB 11H\n"
              "0106  22        DB 22H\n");
    ASSERT_EQ(listing.lines.size(), 7u);
    EXPECT_FALSE(listing.lines[0].code);
    EXPECT_TRUE(listing.lines[1].code);
    EXPECT_EQ(listing.lines[2].address, 0x0103);
    EXPECT_FALSE(listing.lines[4].code);
}

TEST(Listing, AnExecutedInstructionStartsALineEvenBehindData) {
    // 21H would take the next two bytes as its operand, but 0101H was executed.
    Coverage coverage;
    execute(coverage, 0x0101, {0x00});
    const Listing listing =
        host_sim::make_listing(image_of(0x0100, {0x21, 0x00, 0xC9}), nullptr, coverage);
    EXPECT_EQ(listing.text, "0100  21        DB 21H\n0101  00        NOP\n0102  C9        RET\n");
    EXPECT_FALSE(listing.lines[0].code);
    EXPECT_TRUE(listing.lines[1].code);
}

TEST(Listing, OverlappingInstructionsThatBothRanAreBothShown) {
    Coverage coverage;
    execute(coverage, 0x0100, {0x21, 0x3C, 0xC9});  // LXI hides INR A, RET
    execute(coverage, 0x0101, {0x3C});
    execute(coverage, 0x0102, {0xC9});
    const Listing listing =
        host_sim::make_listing(image_of(0x0100, {0x21, 0x3C, 0xC9}), nullptr, coverage);
    EXPECT_EQ(listing.text,
              "0100  21 3C C9  LXI H,0C93CH\n0101  3C        INR A\n0102  C9        RET\n");
}

TEST(Listing, AnInstructionDoesNotReachBeyondTheImage) {
    EXPECT_EQ(host_sim::make_listing(image_of(0xFFFF, {0xC3}), nullptr, Coverage()).text,
              "FFFF  C3        DB 0C3H\n");
    EXPECT_EQ(host_sim::make_listing(image_of(0x0100, {0xC3, 0x00}), nullptr, Coverage()).text,
              "0100  C3        DB 0C3H\n0101  00        NOP\n");
}

TEST(Lcov, OfAListing) {
    const Symbols symbols = host_sim::read_symbols(
        "0100 0004 F f(int, char)\n0104 0001 F unused\n0105 0001 D data\n", "a.sym");
    Coverage coverage;
    execute(coverage, 0x0100, {0xC3, 0x03, 0x01}, 3);
    const Listing listing = host_sim::make_listing(
        image_of(0x0100, {0xC3, 0x03, 0x01, 0xC9, 0xC9, 0x55}), &symbols, coverage);
    EXPECT_EQ(host_sim::lcov_of_listing(listing, "image.lst", &symbols, coverage),
              "TN:\nSF:image.lst\nFN:2,f(int; char)\nFN:5,unused\nFNDA:3,f(int; char)\n"
              "FNDA:0,unused\nFNF:2\nFNH:1\nDA:2,3\nDA:3,0\nDA:5,0\nLF:3\nLH:1\nend_of_record\n");
}

TEST(Lcov, OfSources) {
    const Symbols symbols = host_sim::read_symbols(
        "0100 0010 F f @ a.cpp:10\n0104 0004 L - @ a.cpp:11\n0108 0004 L - @ a.cpp:12\n"
        "0200 0004 F g @ b.cpp:5\n8000 0001 D d @ a.cpp:1\n",
        "a.sym");
    Coverage coverage;
    execute(coverage, 0x0100, {0x00}, 2);
    execute(coverage, 0x0104, {0x00}, 2);
    execute(coverage, 0x0105, {0x00}, 7);
    EXPECT_EQ(host_sim::lcov_of_sources(symbols, coverage),
              "TN:\nSF:a.cpp\nFN:10,f\nFNDA:2,f\nFNF:1\nFNH:1\nDA:10,2\nDA:11,7\nDA:12,0\n"
              "LF:3\nLH:2\nend_of_record\n"
              "TN:\nSF:b.cpp\nFN:5,g\nFNDA:0,g\nFNF:1\nFNH:0\nDA:5,0\nLF:1\nLH:0\n"
              "end_of_record\n");
    EXPECT_EQ(host_sim::lcov_of_sources(Symbols(), coverage), "");
}

TEST(Lcov, GenhtmlTakesIt) {
    if (std::system("genhtml --version >/dev/null 2>&1") != 0) {
        FAIL() << "genhtml is not installed (apt-get install lcov)";
    }
    std::string pattern = (fs::temp_directory_path() / "rover85-lcov-XXXXXX").string();
    const fs::path folder = ::mkdtemp(pattern.data());
    const Symbols symbols =
        host_sim::read_symbols("0100 0004 F f(int, char)\n0104 0001 F unused\n", "a.sym");
    Coverage coverage;
    execute(coverage, 0x0100, {0xC3, 0x03, 0x01}, 3);
    const Listing listing = host_sim::make_listing(image_of(0x0100, {0xC3, 0x03, 0x01, 0xC9, 0xC9}),
                                                   &symbols, coverage);
    const fs::path file = folder / "image.lst";
    std::ofstream(file) << listing.text;
    std::ofstream(folder / "image.info")
        << host_sim::lcov_of_listing(listing, file.string(), &symbols, coverage);
    const std::string command =
        "cd '" + folder.string() + "' && genhtml --output-directory html image.info > out.txt 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::ifstream in(folder / "out.txt");
    const std::string out{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(out.find("lines......: 33.3% (1 of 3 lines)"), std::string::npos) << out;
    EXPECT_NE(out.find("functions..: 50.0% (1 of 2 functions)"), std::string::npos) << out;
    fs::remove_all(folder);
}

}  // namespace
