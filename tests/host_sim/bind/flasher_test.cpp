// flasher_test.cpp - what is made of wrong bytes. Whole transfers: tests/system/loader.
#include "host_sim/bind/flasher.hpp"

#include <gtest/gtest.h>

namespace {

using Bytes = std::vector<uint8_t>;

std::string cause(const Bytes& expected, const Bytes& found) {
    return host_sim::likely_cause(expected, found);
}

TEST(LikelyCause, TellsWhatTheBytesTell) {
    EXPECT_NE(cause({1, 2, 3}, {0xFF, 0xFF, 0xFF}).find("nothing was written"), std::string::npos);
    EXPECT_NE(cause({0x10, 0x55}, {0x18, 0x5D}).find("same bit"), std::string::npos);
    EXPECT_NE(cause({0x10, 0x55}, {0x11, 0x5D}).find("several bits"), std::string::npos);
}

}  // namespace
