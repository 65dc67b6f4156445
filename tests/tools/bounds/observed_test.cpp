// observed_test.cpp - a run on the simulated board against bounds that hold and that do not.
#include "tools/bounds/observed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host_sim/board/board.hpp"
#include "tests/tools/bounds/sample_program.hpp"

namespace {

using bounds_test::kLoopWorkT;
using bounds_test::kMainIsEndless;
using bounds_test::Sample;
using rover_bounds::Bounds;
using rover_bounds::Observed;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// Steps that do not wait for anything: wait is a RET. The stack begins at 9000H.
Sample stepping() {
    return {R"(
reset:  LXI  SP,9000H
        CALL main
        DS   1EH
v24:    RET
        DS   7
v2c:    RET
        DS   7
v34:    RET
        DS   7
v3c:    RET
main:   NOP
turn:   CALL wait
        CALL work
        JMP  turn
wait:   RET
work:   MVI  B,3
loop:   DCR  B
        JNZ  loop
        RET
)",
            {{"reset", "__reset"},
             {"v24", "__vector_0024"},
             {"v2c", "__vector_002C"},
             {"v34", "__vector_0034"},
             {"v3c", "__vector_003C"},
             {"main", "main"},
             {"wait", "x::rover_wait()"},
             {"work", "x::work()"}}};
}

/// Runs 5000 T-states: about 50 steps. @param turns  what the loop is said to do
Observed observe(const std::string& turns, const std::string& table = "") {
    Sample sample = stepping();
    sample.note("loop", turns);
    const auto program = sample.flow(kMainIsEndless + table);
    const Bounds bounds = find_bounds(program, {30'720, 1600, 307'200});
    host_sim::Board board;
    board.program(std::span(sample.image.bytes).first(0x80));
    rover_bounds::Observer observer(program, bounds, 0x9000);
    host_sim::StepRecord record;
    while (board.state.cpu.t < 5000) {
        board.step(record, 5000);
        observer.observe(record, board.state.cpu);
    }
    return observer.observed();
}

TEST(Observer, SeesWhatTheBoundsSayAndNothingAbove) {
    const Observed observed = observe("loop 3");
    EXPECT_THAT(observed.violations, IsEmpty());
    EXPECT_EQ(observed.step_t, 18 + 18 + 10 + kLoopWorkT);
    EXPECT_GT(observed.steps, 40U);
    EXPECT_EQ(observed.stack_bytes, 4U);
}

TEST(Observer, TellsALoopThatRunsMoreOftenAndWhatTakesLonger) {
    const Observed observed = observe("loop 2");
    EXPECT_THAT(observed.violations, Contains(HasSubstr("x::work(), loop 1: more than 2 turns")));
    EXPECT_THAT(observed.violations, Contains(HasSubstr("x::work(): 56 T, bound 42")));
    EXPECT_THAT(observed.violations, Contains(HasSubstr("step: 102 T, bound 88")));
}

TEST(Observer, TellsAFactThatDoesNotHold) {
    const Observed observed =
        observe("loop 3", "fact,x::work()#1 <= 3 x::work(),holds\nfact,x::work()#1 <= 2,wrong\n");
    EXPECT_THAT(observed.violations,
                Contains("flow.csv:3: does not hold in a step: x::work()#1 <= 2"));
    EXPECT_THAT(observed.violations, testing::Not(Contains(HasSubstr("flow.csv:2"))));
}

}  // namespace
