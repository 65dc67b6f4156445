// breakpoints_test.cpp - what stops, counts, and goes away, on hand-made steps.
#include "tools/debug/breakpoints.hpp"

#include <gtest/gtest.h>

#include "tools/debug/debug_error.hpp"

namespace debug_console {
namespace {

using host_sim::BoardState;
using host_sim::BusAccess;
using host_sim::StepRecord;

Breakpoint at_address(uint16_t address) {
    Breakpoint breakpoint;
    breakpoint.first = breakpoint.last = address;
    return breakpoint;
}

StepRecord step_with(BusAccess::Kind kind, uint16_t address) {
    StepRecord record;
    record.access_count = 2;
    record.accesses[0] = {BusAccess::Kind::fetch, 0x8000, 0, 0};
    record.accesses[1] = {kind, address, 0x42, 0};
    return record;
}

TEST(Breakpoints, AddressesStopBeforeTheInstruction) {
    Breakpoints breakpoints;
    EXPECT_FALSE(breakpoints.any_enabled());
    EXPECT_EQ(breakpoints.add(at_address(0x100)), 1u);
    EXPECT_EQ(breakpoints.add(at_address(0x200)), 2u);
    EXPECT_TRUE(breakpoints.any_enabled());
    EXPECT_TRUE(breakpoints.waits_at(0x100));
    EXPECT_FALSE(breakpoints.waits_at(0x101));
    BoardState state;
    state.cpu.pc = 0x200;
    const auto hit = breakpoints.before(state);
    ASSERT_TRUE(hit.has_value());
    EXPECT_EQ(hit->id, 2u);
    EXPECT_EQ(breakpoints.at(2).hits, 1u);
    EXPECT_EQ(breakpoints.at(1).hits, 0u);
    state.cpu.pc = 0x300;
    EXPECT_FALSE(breakpoints.before(state).has_value());
}

TEST(Breakpoints, IgnoredAndConditionalHitsPass) {
    Breakpoints breakpoints;
    Breakpoint breakpoint = at_address(0x100);
    breakpoint.ignore = 2;
    breakpoint.condition = Condition::parse("A > 1", Names());
    breakpoints.add(breakpoint);
    BoardState state;
    state.cpu.pc = 0x100;
    int stopped_with = -1;
    for (state.cpu.a = 0; state.cpu.a < 10 && stopped_with < 0; ++state.cpu.a) {
        if (breakpoints.before(state)) stopped_with = state.cpu.a;
    }
    EXPECT_EQ(stopped_with, 4) << "2 and 3 were ignored";
    EXPECT_EQ(breakpoints.at(1).hits, 3u);
    EXPECT_EQ(breakpoints.at(1).ignore, 0u);
}

TEST(Breakpoints, TemporaryOnesGoAndDisabledOnesWait) {
    Breakpoints breakpoints;
    Breakpoint once = at_address(0x100);
    once.temporary = true;
    breakpoints.add(once);
    breakpoints.add(at_address(0x200));
    BoardState state;
    state.cpu.pc = 0x100;
    EXPECT_TRUE(breakpoints.before(state).has_value());
    EXPECT_FALSE(breakpoints.waits_at(0x100));
    EXPECT_THROW(breakpoints.at(1), DebugError);
    breakpoints.set_enabled(2, false);
    EXPECT_FALSE(breakpoints.waits_at(0x200));
    EXPECT_FALSE(breakpoints.any_enabled());
    breakpoints.set_enabled(2, true);
    EXPECT_TRUE(breakpoints.waits_at(0x200));
    breakpoints.remove(2);
    EXPECT_TRUE(breakpoints.list().empty());
    EXPECT_EQ(breakpoints.add(at_address(1)), 3u) << "numbers are not used again";
    breakpoints.clear();
    EXPECT_FALSE(breakpoints.any_enabled());
}

TEST(Breakpoints, MemoryRangesDistinguishReadsAndWrites) {
    struct Case {
        bool reads, writes;
        BusAccess::Kind kind;
        uint16_t address;
        bool stops;
    };
    using Kind = BusAccess::Kind;
    const Case cases[] = {
        {true, false, Kind::read, 0x8010, true},    {true, false, Kind::write, 0x8010, false},
        {false, true, Kind::write, 0x8010, true},   {false, true, Kind::read, 0x8010, false},
        {true, true, Kind::read, 0x801F, true},     {true, true, Kind::write, 0x8020, false},
        {true, true, Kind::write, 0x800F, false},   {true, true, Kind::fetch, 0x8010, false},
        {true, true, Kind::operand, 0x8010, false}, {true, true, Kind::in, 0x8010, false},
    };
    for (const Case& each : cases) {
        Breakpoints breakpoints;
        Breakpoint breakpoint;
        breakpoint.kind = Breakpoint::Kind::memory;
        breakpoint.first = 0x8010;
        breakpoint.last = 0x801F;
        breakpoint.reads = each.reads;
        breakpoint.writes = each.writes;
        breakpoints.add(breakpoint);
        const auto hit = breakpoints.behind(step_with(each.kind, each.address), BoardState());
        EXPECT_EQ(hit.has_value(), each.stops) << int(each.kind) << " " << each.address;
    }
}

TEST(Breakpoints, PortsDistinguishInAndOut) {
    Breakpoints breakpoints;
    Breakpoint breakpoint;
    breakpoint.kind = Breakpoint::Kind::port;
    breakpoint.first = breakpoint.last = 8;
    breakpoint.reads = false;
    breakpoints.add(breakpoint);
    EXPECT_TRUE(breakpoints.behind(step_with(BusAccess::Kind::out, 8), BoardState()).has_value());
    EXPECT_FALSE(breakpoints.behind(step_with(BusAccess::Kind::in, 8), BoardState()).has_value());
    EXPECT_FALSE(breakpoints.behind(step_with(BusAccess::Kind::out, 9), BoardState()).has_value());
    EXPECT_FALSE(
        breakpoints.behind(step_with(BusAccess::Kind::write, 8), BoardState()).has_value());
    const StepRecord record = step_with(BusAccess::Kind::out, 8);
    EXPECT_EQ(matching_access(breakpoints.at(1), record), &record.accesses[1]);
}

TEST(Breakpoints, InterruptsStopWhenTheyAreTaken) {
    Breakpoints breakpoints;
    Breakpoint breakpoint;
    breakpoint.kind = Breakpoint::Kind::interrupt;
    breakpoint.interrupt = StepRecord::Kind::trap;
    breakpoints.add(breakpoint);
    StepRecord record;
    EXPECT_FALSE(breakpoints.behind(record, BoardState()).has_value());
    record.kind = StepRecord::Kind::rst75;
    EXPECT_FALSE(breakpoints.behind(record, BoardState()).has_value());
    record.kind = StepRecord::Kind::trap;
    EXPECT_TRUE(breakpoints.behind(record, BoardState()).has_value());
    breakpoint.interrupt = StepRecord::Kind::instruction;
    breakpoints.clear();
    breakpoints.add(breakpoint);
    EXPECT_TRUE(breakpoints.behind(record, BoardState()).has_value()) << "any";
    record.kind = StepRecord::Kind::halt;
    EXPECT_FALSE(breakpoints.behind(record, BoardState()).has_value());
    EXPECT_EQ(interrupt_name(StepRecord::Kind::rst55), "RST 5.5");
}

}  // namespace
}  // namespace debug_console
