// stamp_test.cpp - rover_stamp as the build runs it, and the image that rover_image made with it.
#include <gtest/gtest.h>

#include "host_sim/bind/host_target.hpp"
#include "host_sim/image/identity.hpp"
#include "host_sim/image/symbols.hpp"
#include "tests/host_sim/image/identity_image.hpp"
#include "tests/system/program.hpp"
#include "toolchain/driver/process.hpp"

namespace {

namespace fs = std::filesystem;
using system_test::Folder;
using toolchain::driver::Outcome;

constexpr const char* kEndings[] = {".hex", ".bin", ".map", ".lst", ".sym"};

Outcome stamp(const Folder& folder, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), ROVER_STAMP_PROGRAM);
    const std::vector<toolchain::driver::Command> commands = {{arguments, folder / "output"}};
    return toolchain::driver::run_all(commands, 1).at(0);
}

std::vector<std::string> usual(const Folder& folder) {
    return {folder / "in.hex", "-o",        folder / "out.hex", "--image-version",
            "0.1.0",           "--sources", "1a2b3c4d"};
}

void write_linked(const Folder& folder, const host_sim::Image& image) {
    system_test::write_bytes(folder / "in.hex", host_sim::write_hex(image));
    for (const char* ending : {".map", ".lst", ".sym"}) {
        system_test::write_bytes(folder / (std::string("in") + ending),
                                 std::string("of ") + ending);
    }
}

TEST(RoverStamp, WritesTheStampedImageAndItsCompanions) {
    const Folder folder;
    write_linked(folder, image_test::unstamped());
    const Outcome outcome = stamp(folder, usual(folder));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
    const host_sim::Image hex = host_sim::load_hex(folder / "out.hex");
    const host_sim::ImageIdentity identity = host_sim::read_identity(hex);
    EXPECT_EQ(identity.version, (host_sim::ImageVersion{0, 1, 0}));
    EXPECT_EQ(identity.source_hash, 0x1A2B3C4Du);
    const host_sim::Image bin = host_sim::load_bin(folder / "out.bin", 0);
    EXPECT_EQ(bin.bytes, hex.bytes);
    EXPECT_EQ(system_test::read_bytes(folder / "out.map"), "of .map");
    EXPECT_EQ(system_test::read_bytes(folder / "out.lst"), "of .lst");
    EXPECT_EQ(system_test::read_bytes(folder / "out.sym"), "of .sym");
}

TEST(RoverStamp, AnImageWithoutABlockIsRefusedAndNothingWritten) {
    const Folder folder;
    host_sim::Image image;
    image.put(0, 0x76);
    write_linked(folder, image);
    const Outcome outcome = stamp(folder, usual(folder));
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.messages.find("in.hex: holds no identity block"), std::string::npos)
        << outcome.messages;
    for (const char* ending : kEndings) {
        EXPECT_FALSE(fs::exists(folder / (std::string("out") + ending))) << ending;
    }
}

TEST(RoverStamp, AddsTheLoaderItsSymbolsAndTheBootRecord) {
    const Folder folder;
    write_linked(folder, image_test::unstamped());
    system_test::write_bytes(folder / "in.sym", "0C00 0010 F main\n");
    host_sim::Image start, program;
    start.put(0x0000, 0xC3);
    program.put(0xE000, 0xC9);
    system_test::write_bytes(folder / "start.hex", host_sim::write_hex(start));
    system_test::write_bytes(folder / "program.hex", host_sim::write_hex(program));
    system_test::write_bytes(folder / "start.sym", "0000 0003 F main\n0000 0001 L - @ a.cpp:1\n");
    system_test::write_bytes(folder / "program.sym", "E000 0001 F main\n");
    std::vector<std::string> arguments = usual(folder);
    for (const std::string& argument : {std::string("--loader-start"), folder / "start.hex",
                                        std::string("--loader-program"), folder / "program.hex"}) {
        arguments.push_back(argument);
    }
    const Outcome outcome = stamp(folder, arguments);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.messages;
    const host_sim::Image hex = host_sim::load_hex(folder / "out.hex");
    EXPECT_EQ(hex.bytes[0x0000], 0xC3);
    EXPECT_EQ(hex.bytes[0x0200], 0xC9);
    EXPECT_EQ(hex.bytes[0x7FC0], 'R');
    EXPECT_EQ(system_test::read_bytes(folder / "out.sym"),
              "0C00 0010 F main\n0000 0003 F loader start: main\n0000 0001 L - @ a.cpp:1\n"
              "E000 0001 F loader: main\n");
    arguments.resize(arguments.size() - 2);
    EXPECT_EQ(stamp(folder, arguments).exit_code, 2) << "one part without the other";
}

TEST(RoverStamp, UsageErrors) {
    const Folder folder;
    write_linked(folder, image_test::unstamped());
    EXPECT_EQ(stamp(folder, {}).exit_code, 2);
    for (const auto& [option, value] : {std::pair{4, "0.1"}, {6, "1a2b3c4"}, {6, "1a2b3c4g"}}) {
        std::vector<std::string> arguments = usual(folder);
        arguments[static_cast<std::size_t>(option)] = value;
        EXPECT_EQ(stamp(folder, arguments).exit_code, 2) << value;
    }
}

// The rule of toolchain/cmake/rover_image.cmake, on a small program.
TEST(RoverImage, MakesAllFilesStampedWithTheHashOfTheHostBuild) {
    const fs::path made = ROVER_STAND_IN_IMAGE;
    for (const char* ending : kEndings) {
        EXPECT_TRUE(fs::exists(fs::path(made).replace_extension(ending))) << ending;
    }
    const host_sim::Image image = host_sim::load_hex(made);
    const host_sim::ImageIdentity identity = host_sim::read_identity(image);
    EXPECT_EQ(host_sim::describe_sources(identity) + " host", host_sim::host_image_identity());
    EXPECT_EQ(identity.vehicle, "Rocky3.2");
    const host_sim::Symbols symbols =
        host_sim::load_symbols(fs::path(made).replace_extension(".sym"));
    const host_sim::Symbol* block = symbols.find("rover_identity");
    ASSERT_NE(block, nullptr);
    EXPECT_EQ(block->address, identity.address);
}

}  // namespace
