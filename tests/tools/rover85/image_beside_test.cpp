// image_beside_test.cpp - which image belongs to the program, and what --version says of it.
#include "tools/rover85/image_beside.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "host_sim/bind/host_target.hpp"
#include "host_sim/image/identity.hpp"
#include "tests/host_sim/image/identity_image.hpp"
#include "tests/tools/rover85/command_line.hpp"

namespace {

namespace fs = std::filesystem;

TEST(ImageBeside, IsInTheFolderOfTheRunningProgram) {
    EXPECT_TRUE(fs::exists(program_folder() / "rover85_output_test")) << program_folder();
    EXPECT_EQ(image_beside(), program_folder() / "rover85.hex");
    EXPECT_EQ(image_beside("there"), fs::path("there/rover85.hex"));
}

TEST(VersionText, NamesTheHostAndTheImageIfThereIsOne) {
    const rover85_test::TestFolder folder("version_" + std::to_string(getpid()));
    const fs::path place = fs::path(folder.file("x")).parent_path();
    EXPECT_EQ(version_text(place), host_sim::host_image_identity());
    host_sim::Image image = image_test::unstamped();
    std::ofstream(folder.file("rover85.hex")) << host_sim::write_hex(image);
    EXPECT_EQ(version_text(place).find(host_sim::host_image_identity() + "\n"), 0u);
    EXPECT_NE(version_text(place).find("rover85.hex: has never been stamped"), std::string::npos);
    const auto identity = host_sim::stamp_identity(image, {0, 9, 0}, 0x12345678);
    std::ofstream(folder.file("rover85.hex")) << host_sim::write_hex(image);
    EXPECT_EQ(version_text(place),
              host_sim::host_image_identity() + "\n" + host_sim::describe(identity) + " image");
}

}  // namespace
