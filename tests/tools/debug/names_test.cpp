// names_test.cpp - symbols by name, by beginning of a C++ name, and by address.
#include "tools/debug/names.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace debug_console {
namespace {

using testing::ElementsAre;

Names example() {
    return Names(
        host_sim::read_symbols("0100 0040 F rover::drive(rover::State&) @ drive.cpp:30\n"
                               "0104 0006 L - @ drive.cpp:31\n"
                               "0104 0000 L again\n"
                               "0200 0000 F stop(int)\n"
                               "0210 0000 F stop(char)\n"
                               "8000 0010 D rover::state\n",
                               "example.sym"));
}

TEST(Names, FindExactNamesAndThoseWithoutParameters) {
    const Names names = example();
    EXPECT_EQ(names.find("rover::state"), 0x8000);
    EXPECT_EQ(names.find("rover::drive(rover::State&)"), 0x100);
    EXPECT_EQ(names.find("rover::drive"), 0x100);
    EXPECT_EQ(names.find("stop(char)"), 0x210);
    EXPECT_FALSE(names.find("stop").has_value()) << "two have this name";
    EXPECT_FALSE(names.find("rover").has_value());
    EXPECT_FALSE(names.find("-").has_value());
    EXPECT_FALSE(names.find("").has_value());
}

TEST(Names, DescribeAddresses) {
    const Names names = example();
    EXPECT_EQ(names.near(0x105), "rover::drive(rover::State&)+5");
    EXPECT_EQ(names.address_text(0x8000), "8000H rover::state");
    EXPECT_EQ(names.address_text(0xA000), "0A000H");
    EXPECT_THAT(names.at(0x104), ElementsAre("again"));
    EXPECT_THAT(names.at(0x101), ElementsAre());
    EXPECT_EQ(names.source_text(0x105), "drive.cpp:31");
    EXPECT_EQ(names.source_text(0x120), "drive.cpp:30");
    EXPECT_EQ(names.source_text(0x200), "");
}

TEST(Names, AreSearchedInAnyCase) {
    std::vector<std::string> found;
    for (const auto& symbol : example().containing("ROVER")) found.push_back(symbol.name);
    EXPECT_THAT(found, ElementsAre("rover::drive(rover::State&)", "rover::state"));
    EXPECT_EQ(example().containing("").size(), 5u) << "all that have a name";
}

}  // namespace
}  // namespace debug_console
