// What the compiler carries inside itself is what the source tree has.
#include "toolchain/driver/resources.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

Files files_of(const std::string& folder, const std::string& extension) {
    Files files;
    for (const auto& entry : fs::directory_iterator(ROVER_SOURCE_DIR "/toolchain/" + folder)) {
        if (entry.path().extension() != extension) continue;
        std::ifstream file(entry.path(), std::ios::binary);
        files[entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
    }
    return files;
}

Files files_of(std::span<const toolchain::driver::Resource> resources) {
    Files files;
    for (const auto& resource : resources) {
        files[std::string(resource.name)] = std::string(resource.text);
    }
    return files;
}

TEST(Resources, AreTheFilesOfTheSourceTree) {
    EXPECT_EQ(files_of(toolchain::driver::runtime_files()), files_of("runtime", ".s85"));
    EXPECT_EQ(files_of(toolchain::driver::include_files()), files_of("include", ".h"));
    EXPECT_EQ(files_of(toolchain::driver::library_files()), files_of("library", ".c"));
    EXPECT_GE(toolchain::driver::runtime_files().size(), 5U);
}

}  // namespace
