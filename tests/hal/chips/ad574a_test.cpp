// ad574a_test.cpp - the driver of the AD574A. Accesses: Analog Devices AD574A data sheet (rev. B),
// Table I and Figure 7; faults on the chip's model.
#include "hal/chips/ad574a.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/hal/chips/parts.hpp"

namespace {

using hal_test::Recorded;
using hal_test::Script;
using hal_test::SimBoard;
using hal_test::Simulated;

TEST(Ad574aAccesses, A0ChoosesTheByte) {
    Script bus;
    bus.in(0x28, {0xAB});
    bus.in(0x29, {0xC0});
    Recorded::Adc::start();
    Recorded::Adc::start(0x77);
    EXPECT_EQ(Recorded::Adc::high(), 0xAB);
    EXPECT_EQ(Recorded::Adc::low(), 0xC0);
    EXPECT_EQ(bus.accesses(), "28=00 28=77 <28 <29");
}

TEST(Ad574aAccesses, WaitLooksAtStsOnly) {
    Script bus;
    bus.in(0x21, {0xFF, 0x40, 0xBF});
    EXPECT_TRUE(Recorded::Adc::wait());
    EXPECT_EQ(bus.accesses(), "<21 <21 <21");
}

TEST(Ad574aAccesses, WaitHasABound) {
    Script bus;
    bus.in(0x21, {0x40});
    EXPECT_FALSE(Recorded::Adc::wait());
    std::string expected = "<21";
    for (unsigned i = 1; i < Recorded::Adc::kPollsMax; ++i) expected += " <21";
    EXPECT_EQ(bus.accesses(), expected);
    // IN, ANI and a jump are 27 T, a conversion is 108 T at most.
    EXPECT_GE(Recorded::Adc::kPollsMax * 27, 2 * 108);
}

TEST(Ad574aOnTheModel, ConvertsWhatIsThere) {
    SimBoard board;
    board.apply(hal_test::Stimulus::Kind::sensor, 15, 1'234'567);  // where reset leaves it
    board.elapse(100);
    Simulated::Adc::start();
    EXPECT_TRUE(Simulated::Adc::busy());
    EXPECT_TRUE(Simulated::Adc::wait());
    // -5 V and 2441.40625 uV a code: 1234567 uV is code 2048 + 505.67.
    EXPECT_EQ(Simulated::Adc::high() << 4 | Simulated::Adc::low() >> 4, 2554);
    EXPECT_EQ(board.state.analog.adc.busy_read_count, 0U);
    EXPECT_EQ(board.state.analog.unsettled_count, 0U);
}

}  // namespace
