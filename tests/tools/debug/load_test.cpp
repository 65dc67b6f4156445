// load_test.cpp - images and symbols from files onto the board.
#include "tools/debug/load.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tools/debug/debug_error.hpp"

namespace debug_console {
namespace {

using host_sim::Board;
using host_sim::Image;
using host_sim::ImageError;
using testing::HasSubstr;

class LoadTest : public testing::Test {
protected:
    LoadTest() {
        std::string name = (std::filesystem::temp_directory_path() / "debug_load_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
        folder_ = name;
    }
    ~LoadTest() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    std::filesystem::path folder_;
};

// Checksums: two's complement of the sum of a record's bytes.
TEST_F(LoadTest, HexAndBinAreToldApart) {
    const Image hex = read_image(write("a.hex", ":020100003E05BA\n:00000001FF\n"), {});
    EXPECT_EQ(hex.bytes[0x100], 0x3E);
    const Image bin = read_image(write("a.bin", "\x3E\x05"), 0x8000);
    EXPECT_EQ(bin.bytes[0x8001], 0x05);
    EXPECT_EQ(read_image(folder_ / "a.bin", {}).bytes[0], 0x3E);
    EXPECT_THROW(static_cast<void>(read_image(folder_ / "a.hex", 0x8000)), DebugError);
    EXPECT_THROW(static_cast<void>(read_image(folder_ / "no.hex", {})), ImageError);
}

TEST_F(LoadTest, BytesGoToEepromAndRam) {
    Image image;
    image.put(0x0000, 0xC3);
    image.put(0x7FFF, 0x11);
    image.put(0x8000, 0x22);
    image.put(0xFFFF, 0x33);
    Board board;
    load_image(image, board);
    EXPECT_EQ(board.state.memory.bytes[0], 0xC3);
    EXPECT_EQ(board.state.memory.bytes[0x7FFF], 0x11);
    EXPECT_EQ(board.state.eeprom.data()[0x7FFF], 0x11);
    EXPECT_EQ(board.state.memory.bytes[0x8000], 0x22);
    EXPECT_EQ(board.state.memory.bytes[0xFFFF], 0x33);
    EXPECT_EQ(board.state.memory.bytes[0x7FFE], 0xFF);
}

TEST_F(LoadTest, AByteWithoutMemoryIsRefusedAndNothingIsLoaded) {
    host_sim::BoardOptions options;
    options.memory_map.ram_last = 0x83FF;
    Board board(options);
    Image image;
    image.file = "big.hex";
    image.put(0x0000, 0x11);
    image.put(0x83FF, 0x22);
    load_image(image, board);
    image.put(0x0000, 0x12);
    image.put(0x8400, 0x33);
    try {
        load_image(image, board);
        FAIL();
    } catch (const ImageError& error) {
        EXPECT_THAT(error.what(), HasSubstr("big.hex"));
        EXPECT_THAT(error.what(), HasSubstr("8400H"));
    }
    EXPECT_EQ(board.state.memory.bytes[0], 0x11);
}

TEST_F(LoadTest, SymbolsAreFoundBesideTheImage) {
    EXPECT_TRUE(find_symbols({}, folder_ / "a.hex").all().empty());
    write("a.sym", "0100 0000 F main\n");
    EXPECT_NE(find_symbols({}, folder_ / "a.hex").find("main"), nullptr);
    write("b.sym", "0100 0000 F other\n");
    EXPECT_NE(find_symbols(folder_ / "b.sym", folder_ / "a.hex").find("other"), nullptr);
    EXPECT_THROW(static_cast<void>(find_symbols(folder_ / "no.sym", folder_ / "a.hex")),
                 ImageError);
    write("a.sym", "nonsense\n");
    EXPECT_THROW(static_cast<void>(find_symbols({}, folder_ / "a.hex")), ImageError);
}

}  // namespace
}  // namespace debug_console
