// i82c55a_test.cpp - the driver of the 82C55A. Accesses: Intel 82C55A data sheet (231256), "Mode
// Selection", "Single Bit Set/Reset Feature"; consequences: the chip's model.
#include "hal/chips/i82c55a.hpp"

#include <gtest/gtest.h>

#include "tests/hal/chips/parts.hpp"

namespace {

using hal_test::Recorded;
using hal_test::Script;
using hal_test::SimBoard;
using hal_test::Simulated;
using Port = host_sim::chips::I82c55a::Port;

TEST(I82c55aAccesses, AreOneEach) {
    Script bus;
    using Ppi = Recorded::PpiB;
    Ppi::set_mode<0x93>();
    bus.in(0x24, {1});
    bus.in(0x25, {2});
    bus.in(0x26, {3});
    EXPECT_EQ(Ppi::read_a(), 1);
    EXPECT_EQ(Ppi::read_b(), 2);
    EXPECT_EQ(Ppi::read_c(), 3);
    Ppi::write_a(4);
    Ppi::write_b(5);
    Ppi::write_c(6);
    EXPECT_EQ(bus.accesses(), "27=93 <24 <25 <26 24=04 25=05 26=06");
}

// Bits 3 to 1 are the bit's number, bit 0 its level.
TEST(I82c55aAccesses, BitsOfPortCAreNumbered) {
    Script bus;
    using Ppi = Recorded::PpiA;
    Ppi::set_c<0x01>();
    Ppi::clear_c<0x01>();
    Ppi::set_c<0x08>();
    Ppi::clear_c<0x40>();
    Ppi::put_c<0x80>(true);
    Ppi::put_c<0x80>(false);
    EXPECT_EQ(bus.accesses(), "23=01 23=00 23=07 23=0C 23=0F 23=0E");
}

TEST(I82c55aAccesses, SomeBitsOfPortCAreReplaced) {
    Script bus;
    bus.in(0x22, {0xA6});
    Recorded::PpiA::replace_c<0x0F>(0x79);
    EXPECT_EQ(bus.accesses(), "<22 22=A9");
}

TEST(I82c55aOnTheModel, BitsOfPortCLeaveTheOthers) {
    SimBoard board;
    using Ppi = Simulated::PpiA;
    Ppi::set_mode<hal::rb85::kPpiAMode>();
    const auto& part = board.state.ppis[0];
    EXPECT_EQ(part.port_level(Port::c), 0);
    Ppi::write_c(0x5A);
    Ppi::set_c<0x01>();
    EXPECT_EQ(part.port_level(Port::c), 0x5B);
    Ppi::clear_c<0x40>();
    EXPECT_EQ(part.port_level(Port::c), 0x1B);
    Ppi::set_c<0x80>();
    EXPECT_EQ(Ppi::read_c(), 0x9B);
    Ppi::replace_c<0x0F>(0x04);
    EXPECT_EQ(part.port_level(Port::c), 0x94);
    EXPECT_EQ(part.input_write_count, 0U);
}

TEST(I82c55aOnTheModel, ModesDriveWhatTheBoardWants) {
    SimBoard board;
    Simulated::PpiA::set_mode<hal::rb85::kPpiAMode>();
    Simulated::PpiB::set_mode<hal::rb85::kPpiBMode>();
    EXPECT_EQ(board.state.ppis[0].port_output_mask(Port::a), 0xFF);
    EXPECT_EQ(board.state.ppis[0].port_output_mask(Port::b), 0x00);
    EXPECT_EQ(board.state.ppis[0].port_output_mask(Port::c), 0xFF);
    EXPECT_EQ(board.state.ppis[1].port_output_mask(Port::a), 0x00);
    EXPECT_EQ(board.state.ppis[1].port_output_mask(Port::b), 0x00);
    EXPECT_EQ(board.state.ppis[1].port_output_mask(Port::c), 0xF0);
}

}  // namespace
