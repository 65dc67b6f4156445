// A program's files are written all, or none.
#include "toolchain/driver/outputs.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <set>

#include "tests/toolchain/driver/compile.hpp"
#include "toolchain/asm/link.hpp"
#include "toolchain/asm/parse.hpp"
#include "toolchain/driver/work_folder.hpp"

namespace {

namespace fs = std::filesystem;
using namespace toolchain;
using driver_test::failure_of;
using testing::StartsWith;

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        names.insert(entry.path().filename().string());
    }
    return names;
}

TEST(Outputs, AreTheFiveFilesOfAProgram) {
    const auto module = assembly::parse("main: MVI A,5\n HLT\n", {.file = "p.s", .origin = 0});
    const auto files =
        driver::output_files(assembly::link({module}, {.roots = {"main"}}), "dir.d/prog.hex");
    std::map<std::string, std::string> contents;
    for (const auto& file : files) contents[file.path.string()] = file.contents;
    ASSERT_EQ(contents.size(), 5U);
    // Record of 3 bytes at 0000: 3E 05 76; the checksum makes all bytes add up to 0.
    EXPECT_THAT(contents["dir.d/prog.hex"], StartsWith(":030000003E057644"));
    EXPECT_EQ(contents["dir.d/prog.bin"], "\x3E\x05\x76");
    EXPECT_THAT(contents["dir.d/prog.sym"], testing::HasSubstr("main"));
    EXPECT_THAT(contents["dir.d/prog.map"], StartsWith("# rover85 map"));
    EXPECT_THAT(contents["dir.d/prog.lst"], testing::HasSubstr("MVI"));
}

TEST(Outputs, ReplaceWhatIsThere) {
    const driver::WorkFolder folder;
    const fs::path one = folder.path() / "one";
    const fs::path two = folder.path() / "two";
    std::ofstream(one) << "old";
    driver::write_all({{one, "new"}, {two, std::string("a\0b", 3)}});
    EXPECT_EQ(text_of(one), "new");
    EXPECT_EQ(text_of(two), std::string("a\0b", 3));
    EXPECT_EQ(names_in(folder.path()), (std::set<std::string>{"one", "two"}));
}

TEST(Outputs, LeaveEverythingAsItIsWhenOneCannotBeWritten) {
    const driver::WorkFolder folder;
    const fs::path one = folder.path() / "one";
    std::ofstream(one) << "old";
    const fs::path missing = folder.path() / "missing/two";
    EXPECT_EQ(failure_of([&] { driver::write_all({{one, "new"}, {missing, "x"}}); }),
              missing.string() +
                  ": cannot be written: No such file or directory: check path, "
                  "permissions and space");
    EXPECT_EQ(text_of(one), "old");
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"one"});
}

TEST(Outputs, DoNotReplaceAFolder) {
    const driver::WorkFolder folder;
    fs::create_directory(folder.path() / "two");
    EXPECT_THAT(failure_of([&] {
                    driver::write_all({{folder.path() / "one", "x"}, {folder.path() / "two", "x"}});
                }),
                testing::HasSubstr("two: cannot be written: it is a folder"));
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"two"});
}

TEST(Outputs, GoIntoPipesAndDevicesInsteadOfReplacingThem) {
    const driver::WorkFolder folder;
    const fs::path pipe = folder.path() / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    const int reader = open(pipe.c_str(), O_RDWR);  // does not wait for a writer
    ASSERT_GE(reader, 0);
    driver::write_all({{pipe, "text"}});
    ASSERT_TRUE(fs::is_fifo(pipe));
    std::array<char, 5> text{};
    ASSERT_EQ(read(reader, text.data(), 4), 4);
    EXPECT_STREQ(text.data(), "text");
    close(reader);
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{"pipe"});
}

TEST(Outputs, FollowLinks) {
    const driver::WorkFolder folder;
    std::ofstream(folder.path() / "target") << "old";
    fs::create_symlink("target", folder.path() / "link");
    driver::write_all({{folder.path() / "link", "new"}});
    EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
    EXPECT_EQ(text_of(folder.path() / "target"), "new");
}

TEST(Outputs, NoticeAFullDisk) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
    const driver::WorkFolder folder;
    // The draft is written beside its place, so the place has to be on the full device.
    fs::create_symlink("/dev/full", folder.path() / ("out." + std::to_string(getpid()) + ".tmp"));
    EXPECT_THAT(failure_of([&] { driver::write_all({{folder.path() / "out", "x"}}); }),
                testing::HasSubstr("out: cannot be written: No space left on device"));
}

}  // namespace
