// Signals as a wish to end.
#include "tools/rover85/end_signal.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace {

TEST(EndSignal, TellsOfEachOfTheThreeAndKillsNothing) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const EndSignal end;
        EXPECT_FALSE(end.came()) << "a new one has seen nothing";
        std::raise(signal);
        EXPECT_TRUE(end.came()) << signal;
    }
}

TEST(EndSignal, GivesSignalsBack) {
    const auto old = std::signal(SIGTERM, SIG_IGN);
    {
        const EndSignal end;
    }
    EXPECT_EQ(std::signal(SIGTERM, old), SIG_IGN);
}

}  // namespace
