// session_test.cpp - runs of a real board under the debugger, exact to the T-state.
#include "tools/debug/session.hpp"

#include "tests/support/trap_gate.hpp"
#include "tests/tools/debug/bench.hpp"

namespace debug_console {
namespace {

using debug_test::Bench;

Breakpoint at_address(uint16_t address) {
    Breakpoint breakpoint;
    breakpoint.first = breakpoint.last = address;
    return breakpoint;
}

TEST(Session, StepsCountInstructions) {
    Bench bench;
    EXPECT_EQ(bench.session.step(1).kind, Stop::Kind::done);
    EXPECT_EQ(bench.t(), 10u) << "JMP";
    EXPECT_EQ(bench.pc(), 0x100);
    bench.session.step(3);
    EXPECT_EQ(bench.t(), 37u) << "LXI, MVI, OUT";
    bench.session.step(0);
    EXPECT_EQ(bench.t(), 37u);
}

TEST(Session, ABreakpointStopsBeforeItsInstructionAndIsLeftByContinuing) {
    Bench bench;
    bench.session.breakpoints.add(at_address(bench.symbol("print")));
    const Stop stop = bench.session.run();
    EXPECT_EQ(stop.kind, Stop::Kind::breakpoint);
    EXPECT_EQ(stop.text, "breakpoint 1: " + bench.session.names.address_text(bench.pc()));
    EXPECT_EQ(bench.t(), 182u);
    ASSERT_EQ(bench.session.calls.frames().size(), 1u);
    EXPECT_EQ(bench.session.calls.frames()[0].from, bench.symbol("call"));
    EXPECT_EQ(bench.session.run().kind, Stop::Kind::breakpoint) << "the loop jumps to print";
    EXPECT_EQ(bench.session.breakpoints.at(1).hits, 2u);
}

// Observed and unobserved runs must be the same run.
TEST(Session, ObservingChangesNothing) {
    Bench plain, observed;
    plain.session.run(1'000'000);
    uint64_t steps = 0;
    observed.session.observer = [&steps](const auto&, const auto&) { ++steps; };
    observed.session.run(1'000'000);
    EXPECT_GT(steps, 300u);
    // What was sent is taken from the board now and then.
    plain.session.between_slices();
    observed.session.between_slices();
    EXPECT_TRUE(plain.session.board.state == observed.session.board.state);

    Bench stopped;
    stopped.session.breakpoints.add(at_address(stopped.symbol("tick")));
    unsigned ticks = 0;
    while (stopped.session.run(1'000'000).kind == Stop::Kind::breakpoint) ++ticks;
    EXPECT_EQ(ticks, 32u) << "every 30720 T, the first one about 30792";
    stopped.session.between_slices();
    EXPECT_TRUE(plain.session.board.state == stopped.session.board.state);
}

TEST(Session, OverTakesCallsAsAWhole) {
    Bench bench;
    bench.session.breakpoints.add(at_address(bench.symbol("call")));
    bench.session.run();
    EXPECT_EQ(bench.t(), 164u);
    EXPECT_EQ(bench.session.over().kind, Stop::Kind::done);
    EXPECT_EQ(bench.pc(), bench.symbol("loop"));
    EXPECT_EQ(bench.session.board.state.cpu.sp, 0);
    EXPECT_TRUE(bench.session.calls.frames().empty());
    bench.session.over();
    EXPECT_TRUE(bench.session.board.state.cpu.halted) << "HLT is no call";
}

TEST(Session, OverTakesAnInterruptBeforeTheInstructionAsAWhole) {
    Bench bench(R"(
            JMP main
            ORG 24H
            RET
    main:   LXI SP,9000H
            NOP
            NOP
    )");
    bench.session.step(2);
    EXPECT_EQ(bench.t(), 20u);
    test_support::open_trap_gate(bench.session.board.state);
    bench.session.board.schedule({15, host_sim::Stimulus::Kind::bumper, 0, 1});
    bench.session.step(1);  // sampled at the end of the first NOP
    EXPECT_EQ(bench.t(), 24u);
    bench.session.over();
    EXPECT_EQ(bench.pc(), bench.symbol("main") + 5);
    EXPECT_EQ(bench.t(), 24u + 12 + 10 + 4) << "TRAP, RET, NOP";
}

TEST(Session, FinishRunsToTheReturn) {
    Bench bench;
    bench.session.breakpoints.add(at_address(bench.symbol("wait")));
    bench.session.run();
    bench.session.breakpoints.clear();
    EXPECT_EQ(bench.session.finish().kind, Stop::Kind::done);
    EXPECT_EQ(bench.pc(), bench.symbol("loop"));
}

TEST(Session, FinishWithoutAShadowGoesByReturnsAndSp) {
    Bench bench(R"(
    main:   LXI SP,9000H
            CALL outer
            HLT
    outer:  CALL inner
            NOP
    here:   CALL inner
            RET
    inner:  PUSH B
            POP B
            RET
    )");
    bench.session.run(10 + 18 + 18 + 12 + 10 + 10);  // unobserved, to the NOP
    EXPECT_EQ(bench.pc(), bench.symbol("here") - 1);
    EXPECT_TRUE(bench.session.calls.frames().empty());
    const auto guesses = bench.session.calls.backtrace(bench.session.board.state);
    ASSERT_EQ(guesses.size(), 1u);
    EXPECT_EQ(guesses[0].target, bench.symbol("outer"));
    bench.session.finish();
    EXPECT_EQ(bench.pc(), bench.symbol("main") + 6);
    EXPECT_EQ(bench.t(), 78u + 4 + 18 + 12 + 10 + 10 + 10);
}

// In HALT the tick wakes the processor; from one to the next it takes the timer's 30720 clocks.
TEST(Session, InterruptBreakpointsStopBehindTheAcceptance) {
    Bench bench;
    Breakpoint breakpoint;
    breakpoint.kind = Breakpoint::Kind::interrupt;
    breakpoint.interrupt = host_sim::StepRecord::Kind::rst75;
    bench.session.breakpoints.add(breakpoint);
    const Stop stop = bench.session.run();
    EXPECT_EQ(stop.text, "breakpoint 1: RST 7.5 taken instead of " +
                             bench.session.names.address_text(
                                 static_cast<uint16_t>(bench.symbol("loop") + 1)));
    EXPECT_EQ(bench.pc(), 0x3C);
    const uint64_t first_t = bench.t();
    bench.session.run();
    EXPECT_EQ(bench.t() - first_t, 30720u);
}

TEST(Session, MemoryAndPortBreakpointsSayWhatHappened) {
    Bench bench;
    Breakpoint breakpoint;
    breakpoint.kind = Breakpoint::Kind::port;
    breakpoint.first = breakpoint.last = 0x11;
    bench.session.breakpoints.add(breakpoint);
    EXPECT_EQ(bench.session.run().text, "breakpoint 1: OUT 11H of 0AH by 0115H main+21");
    EXPECT_EQ(bench.t(), 105u);
    bench.session.breakpoints.clear();
    breakpoint.kind = Breakpoint::Kind::memory;
    breakpoint.first = breakpoint.last = 0x8000;
    breakpoint.reads = false;
    bench.session.breakpoints.add(breakpoint);
    const Stop stop = bench.session.run();
    EXPECT_EQ(stop.text, "breakpoint 2: 01H written to 8000H count by " +
                             bench.session.names.address_text(
                                 static_cast<uint16_t>(bench.symbol("tick") + 5)));
}

TEST(Session, AnInterruptThatComesFirstDoesNotHitTheBreakpointTwice) {
    Bench bench(R"(
            JMP main
            ORG 24H
            RET
    main:   LXI SP,9000H
            NOP
    here:   NOP
            NOP
            HLT
    )");
    bench.session.breakpoints.add(at_address(bench.symbol("here")));
    // From T 21 on: seen at the end of the first NOP, T 24, two T-states later or more.
    test_support::open_trap_gate(bench.session.board.state);
    bench.session.board.schedule({21, host_sim::Stimulus::Kind::bumper, 0, 1});
    EXPECT_EQ(bench.session.run(100).kind, Stop::Kind::breakpoint);
    EXPECT_EQ(bench.pc(), bench.symbol("here"));
    EXPECT_EQ(bench.t(), 24u + 12 + 10) << "behind TRAP and RET";
    EXPECT_EQ(bench.session.run(100).kind, Stop::Kind::done);
    EXPECT_EQ(bench.session.breakpoints.at(1).hits, 1u);
}

TEST(Session, UndocumentedInstructionsStopADocumentedProcessor) {
    host_sim::BoardOptions options;
    options.instruction_set = host_sim::InstructionSet::documented;
    Bench bench("        NOP\n        DB 08H\n", options);
    const Stop stop = bench.session.run();
    EXPECT_EQ(stop.kind, Stop::Kind::undefined_instruction);
    EXPECT_EQ(stop.text, "08H at 0001H is no documented instruction; --cpu 8085u runs it");
    EXPECT_EQ(bench.session.step(1).kind, Stop::Kind::undefined_instruction);
    EXPECT_EQ(bench.t(), 4u);
}

TEST(Session, ViolationsAndHaltsStopWhenAskedFor) {
    host_sim::BoardOptions options;
    options.stop_at_violation = true;
    options.stop_at_halt = true;
    Bench bench("        OUT 0F0H\n        HLT\n", options);
    const Stop stop = bench.session.run();
    EXPECT_EQ(stop.kind, Stop::Kind::violation);
    EXPECT_EQ(stop.text, "violation: OUT 0F0H of 00H to no chip, by 0000H at T 10 (0.003 ms)");
    EXPECT_EQ(bench.session.run().kind, Stop::Kind::halted);
    EXPECT_EQ(bench.t(), 15u);
    EXPECT_EQ(bench.session.step(1).kind, Stop::Kind::halted);
}

TEST(Session, AnInterruptedRunStopsBothWays) {
    Bench bench("here:   JMP here\n");
    unsigned asked = 0;
    bench.session.interrupted = [&asked] { return ++asked == 3; };
    EXPECT_EQ(bench.session.run().kind, Stop::Kind::interrupted);
    EXPECT_EQ(bench.t() / 307'200, 3u) << "slices of 100 ms";
    asked = 0;
    bench.session.breakpoints.add(at_address(0x4000));
    EXPECT_EQ(bench.session.run().kind, Stop::Kind::interrupted);
    EXPECT_EQ(asked, 3u);
}

// Nobody toggles SOD: the watchdog presses RESET after 0.5 s, and the stack is as new.
TEST(Session, AResetEndsAllFrames) {
    Bench bench(R"(
            LXI SP,9000H
            CALL here
    here:   JMP here
    )");
    bench.session.step(2);
    EXPECT_EQ(bench.session.calls.frames().size(), 1u);
    bench.session.breakpoints.add(at_address(0));
    EXPECT_EQ(bench.session.run(2'000'000).kind, Stop::Kind::breakpoint);
    EXPECT_EQ(bench.pc(), 0);
    EXPECT_TRUE(bench.session.calls.frames().empty());
    EXPECT_TRUE(bench.session.calls.backtrace(bench.session.board.state).empty());
    bench.session.step(2);
    bench.session.reset();
    EXPECT_TRUE(bench.session.calls.frames().empty());
    bench.session.step(2);
    bench.session.power_cycle();
    EXPECT_TRUE(bench.session.calls.frames().empty());
    EXPECT_EQ(bench.pc(), 0);
}

TEST(Session, ViolationTextNamesEveryKind) {
    using Kind = host_sim::Violation::Kind;
    const Names names;
    EXPECT_EQ(violation_text({}, names), "none");
    EXPECT_EQ(violation_text({Kind::unmapped_write, 0x103, 0x9000, 5, 20}, names),
              "write of 05H to 9000H where no memory is, by 0103H at T 20 (0.007 ms)");
    EXPECT_EQ(violation_text({Kind::eeprom_write, 0x103, 0x4000, 5, 20}, names),
              "write of 05H to 4000H that the EEPROM ignored, by 0103H at T 20 (0.007 ms)");
    EXPECT_EQ(violation_text({Kind::unmapped_in, 0x103, 0xF0, 0xFF, 20}, names),
              "IN 0F0H that no chip answers, by 0103H at T 20 (0.007 ms)");
}

}  // namespace
}  // namespace debug_console
