// A compilation's temporary files are gone when it is over.
#include "toolchain/driver/work_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace {

namespace fs = std::filesystem;

TEST(WorkFolder, IsRemovedWithItsContents) {
    fs::path path;
    {
        const toolchain::driver::WorkFolder folder;
        path = folder.path();
        fs::create_directories(path / "inner");
        std::ofstream(path / "inner/file") << "text";
        EXPECT_TRUE(fs::exists(path / "inner/file"));
    }
    EXPECT_FALSE(fs::exists(path));
}

TEST(WorkFolder, IsAnotherOneEachTime) {
    const toolchain::driver::WorkFolder one;
    const toolchain::driver::WorkFolder other;
    EXPECT_NE(one.path(), other.path());
}

TEST(WorkFolder, IsForItsOwnerOnly) {
    const toolchain::driver::WorkFolder folder;
    EXPECT_EQ(fs::status(folder.path()).permissions(), fs::perms::owner_all);
}

TEST(WorkFolder, AllCanBeRemovedAtOnce) {
    const toolchain::driver::WorkFolder one;
    const toolchain::driver::WorkFolder other;
    std::ofstream(one.path() / "file") << "text";
    toolchain::driver::WorkFolder::remove_all();
    EXPECT_FALSE(fs::exists(one.path()));
    EXPECT_FALSE(fs::exists(other.path()));
}

}  // namespace
