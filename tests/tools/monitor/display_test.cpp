// What reaches a terminal and what reaches a pipe.
#include "tools/monitor/display.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace {

using monitor::Display;
using monitor::Known;

TEST(Display, APipeGetsALineAMessage) {
    std::ostringstream out;
    {
        Display display(out, false);
        display.show(Known{}, "one");
        display.note("two");
        display.show(Known{}, "three");
    }
    EXPECT_EQ(out.str(), "one\ntwo\nthree\n");
}

TEST(Display, ATerminalGetsABlockInPlaceAndNotesAboveIt) {
    std::ostringstream out;
    Known known;
    known.port = "port";
    std::string block;
    for (const std::string& line : monitor::screen(known)) block += line + "\n";
    {
        Display display(out, true);
        display.show(known, "not shown");
        display.note("note");
        display.show(known, "not shown");
    }
    const std::string back = "\033[2F\033[J";  // two lines up, and away with them
    EXPECT_EQ(out.str(), "\033[?7l" + block + back + "note\n" + block + back + block + "\033[?7h");
}

}  // namespace
