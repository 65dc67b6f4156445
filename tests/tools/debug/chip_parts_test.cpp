// chip_parts_test.cpp - every chip of the board is shown, as of now.
#include "tools/debug/chip_parts.hpp"

#include <gtest/gtest.h>

#include <set>

#include "host_sim/board/board.hpp"

namespace debug_console {
namespace {

TEST(ChipParts, HaveDifferentNamesAndSomethingToShow) {
    const host_sim::BoardState state;
    std::set<std::string_view> names;
    for (const ChipPart& part : chip_parts()) {
        EXPECT_TRUE(names.insert(part.name).second) << part.name;
        EXPECT_FALSE(part.properties(state).empty()) << part.name;
        EXPECT_TRUE(part.equal(state, state)) << part.name;
    }
    EXPECT_EQ(names.size(), 12u);
}

TEST(ChipParts, ADifferenceIsSeenInTheChipThatHasIt) {
    const host_sim::BoardState one;
    host_sim::BoardState other;
    other.usart.command = 1;
    other.timers[1].last_t = 1;
    other.ppis[1].control = 0x80;
    std::set<std::string_view> different;
    for (const ChipPart& part : chip_parts()) {
        if (!part.equal(one, other)) different.insert(part.name);
    }
    EXPECT_EQ(different, (std::set<std::string_view>{"usart", "timer-b", "ppi-b"}));
}

// The AD574A converts for 35 us, 108 T; nobody reads it, so only the copy knows that it is ready.
TEST(ChipParts, AreShownAsOfNow) {
    host_sim::BoardState state;
    state.analog.write(0, 0, 100);
    const auto status = [&state] {
        for (const ChipPart& part : chip_parts()) {
            if (part.name != "analog") continue;
            for (const auto& [name, value] : part.properties(state)) {
                if (name == "converter: status") return value;
            }
        }
        return std::string("not found");
    };
    state.cpu.t = 207;
    EXPECT_EQ(status(), "converts 12 bits until T 208");
    state.cpu.t = 208;
    EXPECT_EQ(status(), "ready");
    EXPECT_TRUE(state.analog.adc.converting) << "looking changes nothing";
}

}  // namespace
}  // namespace debug_console
