// image_files_test.cpp - HEX and BIN, by hand and by the simulator's strict reader.
#include "toolchain/asm/image_files.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "host_sim/image/image.hpp"
#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

TEST(ImageFiles, ARecordByHand) {
    // Checksum: 03+00+24+00+C3+34+12 = 130H, so D0H. Start record: 04+05+12+34 = 4FH, so B1H.
    Program program;
    for (const auto& [at, byte] : {std::pair{0x24, 0xC3}, {0x25, 0x34}, {0x26, 0x12}}) {
        program.image.bytes[static_cast<std::size_t>(at)] = static_cast<uint8_t>(byte);
        program.image.present.set(static_cast<std::size_t>(at));
    }
    program.start = 0x1234;
    EXPECT_EQ(write_hex(program), ":03002400C33412D0\n:0400000500001234B1\n:00000001FF\n");
    program.rom = {0x20, 0x3F};
    const std::string bin = write_bin(program);
    EXPECT_EQ(bin, std::string("\xFF\xFF\xFF\xFF\xC3\x34\x12", 7));
}

TEST(ImageFiles, TheSimulatorReadsThemBack) {
    LinkOptions options;
    options.vectors = {{0x0000, "f"}};
    const Program program =
        linked("SECTION f,code\nf: JMP f\nDS 300\nSECTION x,constant,AT 0FFFFH\nDB 3\n", options);
    const host_sim::Image hex = host_sim::read_hex(write_hex(program), "test");
    EXPECT_EQ(hex.bytes, program.image.bytes);
    EXPECT_EQ(hex.present, program.image.present);
    EXPECT_EQ(hex.start, program.start);
    const host_sim::Image bin = host_sim::read_bin(write_bin(program), 0, "test");
    EXPECT_EQ(bin.byte_count(), 306u);
    EXPECT_TRUE(std::equal(bin.bytes.begin(), bin.bytes.begin() + 306, hex.bytes.begin()));
}

TEST(ImageFiles, SrecordAgrees) {
    if (std::system("srec_cat --version >/dev/null 2>&1") != 0) {
        FAIL() << "srec_cat is not installed (apt-get install srecord)";
    }
    LinkOptions options;
    options.vectors = {{0x0000, "f"}};
    const Program program = linked("SECTION f,code\nf: JMP f\nDS 300\n", options);
    const auto folder = std::filesystem::path(testing::TempDir()) / "rover85_image_files";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "p.hex") << write_hex(program);
    const std::string base = (folder / "p").string();
    ASSERT_EQ(
        std::system(("srec_cat '" + base + ".hex' -intel -o '" + base + ".bin' -binary").c_str()),
        0);
    std::ifstream in(folder / "p.bin", std::ios::binary);
    EXPECT_EQ(std::string((std::istreambuf_iterator<char>(in)), {}), write_bin(program));
    std::filesystem::remove_all(folder);
}

}  // namespace
