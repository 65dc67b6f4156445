// call_profile_test.cpp - T-states by function on hand-made runs; every expected number is added up
// by hand from the steps above it (CALL 18, RET 10, NOP 4, RST 12, JMP 10, PCHL 6, interrupt 12).
#include "host_sim/trace/call_profile.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <nlohmann/json.hpp>

#include "host_sim/trace/call_stack.hpp"
#include "steps.hpp"

namespace {

using host_sim::CallProfile;
using host_sim::FunctionProfile;
using host_sim::InterruptProfile;
using host_sim::ProfileReport;
using host_sim::read_symbols;
using host_sim::StepRecord;
using host_sim::Symbols;
using trace_test::Steps;
using Kind = StepRecord::Kind;

/// main 0100, f 0200, g 0300, h 0400, timer 0500; vector of RST 7.5 at 003C.
const Symbols& symbols() {
    static const Symbols table = read_symbols(
        "0100 0100 F main\n0200 0100 F f\n0300 0100 F g\n0400 0100 F h\n0500 0100 F timer\n"
        "003C 0003 I rst75\n",
        "test.sym");
    return table;
}

struct Trial {
    explicit Trial(const Symbols* names = &symbols())
        : profile(names), steps([this](const StepRecord& step) { profile.observe(step); }) {}
    CallProfile profile;
    Steps steps;
};

FunctionProfile function(const ProfileReport& report, const std::string& name) {
    for (const auto& entry : report.functions) {
        if (entry.name == name) return entry;
    }
    ADD_FAILURE() << "no function " << name;
    return {};
}

InterruptProfile input(const ProfileReport& report, const std::string& name) {
    for (const auto& entry : report.interrupts) {
        if (entry.name == name) return entry;
    }
    ADD_FAILURE() << "no interrupt " << name;
    return {};
}

uint64_t sum_of_exclusive(const ProfileReport& report) {
    uint64_t sum = report.halt_t;
    for (const auto& entry : report.functions) sum += entry.exclusive_t;
    return sum;
}

TEST(CallProfile, ACallBelongsToTheCallerAndTheReturnToTheCallee) {
    Trial run;
    run.steps.nop(2);           // main 8
    run.steps.call(0x0200);     // main 18
    run.steps.nop(3);           // f 12
    run.steps.call(0x0300);     // f 18
    run.steps.nop(1);           // g 4
    run.steps.ret(0x0200 + 6);  // g 10
    run.steps.ret(0x0105);      // f 10
    run.steps.nop(1);           // main 4
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "main").exclusive_t, 8u + 18 + 4);
    EXPECT_EQ(function(report, "main").inclusive_t, 84u);
    EXPECT_EQ(function(report, "main").completed, 0u);
    EXPECT_EQ(function(report, "f").exclusive_t, 12u + 18 + 10);
    EXPECT_EQ(function(report, "f").inclusive_t, 54u);
    EXPECT_EQ(function(report, "f").worst_t, 54u);
    EXPECT_EQ(function(report, "g").exclusive_t, 14u);
    EXPECT_EQ(function(report, "g").inclusive_t, 14u);
    EXPECT_EQ(report.total_t, 84u);
    EXPECT_EQ(report.functions[0].name, "f");  // the most exclusive T first
}

TEST(CallProfile, WorstAndMeanAreOfSingleCalls) {
    Trial run;
    for (const unsigned nops : {1u, 5u, 3u}) {
        const unsigned back = run.steps.pc() + 3;
        run.steps.call(0x0200);
        run.steps.nop(nops);
        run.steps.ret(back);
    }
    const auto f = function(run.profile.report(), "f");
    EXPECT_EQ(f.calls, 3u);
    EXPECT_EQ(f.worst_t, 30u);
    EXPECT_DOUBLE_EQ(f.mean_t(), 22.0);  // 14, 30, 22
}

TEST(CallProfile, ConditionalCallsAndReturnsCountWhenTaken) {
    Trial run;
    run.steps.call_not_taken();       // main 9
    run.steps.call_taken_if(0x0200);  // main 18
    run.steps.ret_not_taken();        // f 6
    run.steps.ret_taken_if(0x0106);   // f 12
    run.steps.rst(7);                 // main 12; 0038H has no symbol
    run.steps.ret(0x0107);            // 10
    run.steps.nop();                  // main 4
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "f").calls, 1u);
    EXPECT_EQ(function(report, "f").inclusive_t, 18u);
    EXPECT_EQ(function(report, "0038H").calls, 1u);
    EXPECT_EQ(function(report, "0038H").exclusive_t, 10u);
    EXPECT_EQ(function(report, "main").exclusive_t, 9u + 18 + 12 + 4);
}

TEST(CallProfile, RecursionIsNotCountedTwice) {
    Trial run;
    run.steps.call(0x0200);  // main 18
    run.steps.call(0x0200);  // f 18
    run.steps.call(0x0200);  // f 18
    run.steps.ret(0x0203);   // f 10
    run.steps.ret(0x0203);   // f 10
    run.steps.ret(0x0103);   // f 10
    const auto f = function(run.profile.report(), "f");
    EXPECT_EQ(f.calls, 3u);
    EXPECT_EQ(f.exclusive_t, 66u);
    EXPECT_EQ(f.inclusive_t, 66u);
    EXPECT_EQ(f.completed, 1u);
    EXPECT_EQ(f.worst_t, 66u);
}

TEST(CallProfile, MutualRecursionIsNotCountedTwice) {
    Trial run;
    run.steps.call(0x0200);  // main 18
    run.steps.call(0x0300);  // f 18
    run.steps.call(0x0200);  // g 18
    run.steps.ret(0x0303);   // f 10
    run.steps.ret(0x0203);   // g 10
    run.steps.ret(0x0103);   // f 10
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "f").inclusive_t, 66u);
    EXPECT_EQ(function(report, "g").inclusive_t, 38u);
    EXPECT_EQ(function(report, "f").exclusive_t, 38u);
}

TEST(CallProfile, AnInterruptIsNotTheInterruptedFunctionsTime) {
    Trial run;
    run.steps.call(0x0200);                    // main 18
    run.steps.nop(1);                          // f 4
    run.steps.interrupt(Kind::rst75, 0x003C);  // rst75 12
    run.steps.jump(0x0500);                    // rst75 10, tail call to timer
    run.steps.nop(2);                          // timer 8
    run.steps.call(0x0300);                    // timer 18
    run.steps.ret(0x0505);                     // g 10
    run.steps.ret(0x0201);                     // timer 10
    run.steps.nop(1);                          // f 4
    run.steps.ret(0x0103);                     // f 10
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "f").inclusive_t, 18u);
    EXPECT_EQ(function(report, "f").exclusive_t, 18u);
    EXPECT_EQ(function(report, "main").inclusive_t, 36u);
    EXPECT_EQ(function(report, "rst75").exclusive_t, 22u);
    EXPECT_EQ(function(report, "timer").exclusive_t, 36u);
    EXPECT_EQ(function(report, "timer").inclusive_t, 46u);
    EXPECT_EQ(function(report, "g").exclusive_interrupt_t, 10u);
    EXPECT_EQ(function(report, "f").exclusive_interrupt_t, 0u);
    EXPECT_EQ(report.interrupt_t, 68u);
    EXPECT_EQ(input(report, "RST 7.5").accepted, 1u);
    EXPECT_EQ(input(report, "RST 7.5").total_t, 68u);
    EXPECT_EQ(input(report, "RST 7.5").worst_t, 68u);
    EXPECT_EQ(report.total_t, 36u + 68);
}

TEST(CallProfile, NestedInterruptsAreApart) {
    Trial run;
    run.steps.nop(1);                          // main 4
    run.steps.interrupt(Kind::rst75, 0x003C);  // 12
    run.steps.nop(1);                          // 4
    run.steps.interrupt(Kind::trap, 0x0024);   // 12
    run.steps.ret(0x003D);                     // 10
    run.steps.nop(1);                          // 4
    run.steps.ret(0x0101);                     // 10
    run.steps.nop(1);                          // main 4
    const auto report = run.profile.report();
    EXPECT_EQ(input(report, "TRAP").total_t, 22u);
    EXPECT_EQ(input(report, "RST 7.5").total_t, 30u);
    EXPECT_EQ(function(report, "main").inclusive_t, 8u);
    EXPECT_EQ(report.interrupts[0].name, "TRAP");  // by priority
}

TEST(CallProfile, AFunctionInterruptedByOneThatCallsItTooIsWhole) {
    Trial run;
    run.steps.call(0x0200);                    // main 18
    run.steps.nop(1);                          // f 4
    run.steps.interrupt(Kind::rst75, 0x003C);  // 12
    run.steps.call(0x0200);                    // rst75 18
    run.steps.ret(0x003F);                     // f 10, in the interrupt
    run.steps.ret(0x0201);                     // rst75 10
    run.steps.ret(0x0103);                     // f 10
    const auto f = function(run.profile.report(), "f");
    EXPECT_EQ(f.inclusive_t, 24u);
    EXPECT_EQ(f.exclusive_t, 24u);
    EXPECT_EQ(f.exclusive_interrupt_t, 10u);
    EXPECT_EQ(f.completed, 2u);
    EXPECT_EQ(f.worst_t, 14u);
}

TEST(CallProfile, HaltIsApart) {
    Trial run;
    run.steps.nop(1);  // main 4
    run.steps.hlt();   // main 5
    run.steps.halted(1000);
    run.steps.interrupt(Kind::rst75, 0x003C);  // 12
    run.steps.ret(0x0102);                     // 10
    run.steps.nop(1);                          // main 4
    const auto report = run.profile.report();
    EXPECT_EQ(report.halt_t, 1000u);
    EXPECT_EQ(report.total_t, 1035u);
    EXPECT_EQ(function(report, "main").inclusive_t, 13u);
    EXPECT_EQ(sum_of_exclusive(report), report.total_t);
}

TEST(CallProfile, ATailCallByPchlReturnsForTheOther) {
    Trial run;
    run.steps.call(0x0200);  // main 18
    run.steps.pchl(0x0300);  // f 6
    run.steps.nop(1);        // g 4
    run.steps.ret(0x0103);   // g 10
    run.steps.nop(1);        // main 4
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "f").inclusive_t, 6u);
    EXPECT_EQ(function(report, "g").inclusive_t, 14u);
    EXPECT_EQ(function(report, "g").calls, 1u);
    EXPECT_EQ(function(report, "main").inclusive_t, 42u);
    EXPECT_EQ(function(report, "main").exclusive_t, 22u);
}

TEST(CallProfile, PushAndPchlIsACall) {
    Trial run;
    run.steps.call(0x0200);  // main 18
    run.steps.push();        // f 12: the return address 0210H
    run.steps.pchl(0x0300);  // f 6
    run.steps.ret(0x0210);   // g 10
    run.steps.ret(0x0103);   // f 10
    run.steps.nop(1);        // main 4
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "f").inclusive_t, 38u);
    EXPECT_EQ(function(report, "f").completed, 1u);
    EXPECT_EQ(function(report, "g").inclusive_t, 10u);
}

TEST(CallProfile, InlineParametersDoNotLoseTheTrack) {
    // f takes its return address off the stack, reads bytes behind the CALL in a loop, calls g
    // meanwhile, and goes back behind the bytes.
    Trial run;
    run.steps.call(0x0200);  // main 18
    run.steps.pop();         // f 10
    run.steps.jump(0x0201);  // f 10
    run.steps.call(0x0300);  // f 18, at the height of f itself
    run.steps.ret(0x0204);   // g 10
    run.steps.nop(1);        // f 4
    run.steps.pchl(0x0110);  // f 6, to behind the bytes
    run.steps.nop(1);        // main 4
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "f").exclusive_t, 48u);
    EXPECT_EQ(function(report, "f").inclusive_t, 58u);
    EXPECT_EQ(function(report, "f").completed, 1u);
    EXPECT_EQ(function(report, "g").inclusive_t, 10u);
    EXPECT_EQ(function(report, "main").exclusive_t, 22u);
}

TEST(CallProfile, ALongJumpEndsEverythingInBetween) {
    Trial run;
    const unsigned saved_sp = run.steps.sp();
    run.steps.call(0x0200);      // main 18
    run.steps.call(0x0300);      // f 18
    run.steps.call(0x0400);      // g 18
    run.steps.set_sp(saved_sp);  // h 6
    run.steps.pchl(0x0120);      // h 6
    run.steps.nop(1);            // main 4
    run.steps.call(0x0200);      // main 18
    run.steps.ret(0x0124);       // f 10
    run.steps.nop(1);            // main 4
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "h").exclusive_t, 12u);
    EXPECT_EQ(function(report, "main").exclusive_t, 44u);
    EXPECT_EQ(function(report, "f").completed, 2u);
    EXPECT_EQ(function(report, "f").inclusive_t, 18u + 18 + 12 + 10);
    EXPECT_EQ(function(report, "f").worst_t, 48u);
}

TEST(CallProfile, AbortingToTheCallersCallerEndsBoth) {
    Trial run;
    run.steps.call(0x0200);  // main 18
    run.steps.call(0x0300);  // f 18
    run.steps.pop();         // g 10: away with f's address
    run.steps.ret(0x0103);   // g 10: back to main
    run.steps.nop(1);        // main 4
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "f").completed, 1u);
    EXPECT_EQ(function(report, "g").completed, 1u);
    EXPECT_EQ(function(report, "main").exclusive_t, 22u);
}

TEST(CallProfile, ALoopThatResetsItsStackStaysBounded) {
    // main: LXI SP; CALL f; f: JMP main, never returning. The T-states of both stay right.
    Trial run;
    for (int i = 0; i < 100'000; ++i) {
        run.steps.set_sp(0x9000);  // main 6
        run.steps.call(0x0200);    // main 18
        run.steps.jump(0x0100);    // f 10
    }
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "main").exclusive_t, 2'400'000u);
    EXPECT_EQ(function(report, "f").exclusive_t, 1'000'000u);
    EXPECT_EQ(function(report, "f").calls, 100'000u);
}

TEST(CallProfile, AStackAtTheTopOfMemory) {
    CallProfile profile(nullptr);
    Steps steps([&](const StepRecord& step) { profile.observe(step); }, 0x0100, 0x0000);
    steps.call(0x0200);  // 0100H 18; SP 0000H to FFFEH
    steps.ret(0x0103);   // 0200H 10
    steps.nop(1);        // 0100H 4
    const auto report = profile.report();
    EXPECT_EQ(function(report, "0200H").completed, 1u);
    EXPECT_EQ(function(report, "0100H").exclusive_t, 22u);
}

TEST(CallProfile, AHaltAtTheEndOfAFunctionIsNoCallOfTheNext) {
    Trial run;
    run.steps.jump(0x01FF);  // main's last byte
    run.steps.hlt();
    run.steps.halted(100);
    const auto report = run.profile.report();
    ASSERT_EQ(report.functions.size(), 1u);
    EXPECT_EQ(report.functions[0].name, "main");
}

TEST(CallProfile, WithoutSymbolsFunctionsAreWhatIsCalled) {
    Trial run(nullptr);
    run.steps.nop(1);        // 0100H 4
    run.steps.call(0x0200);  // 18
    run.steps.jump(0x0280);  // 10, in the same function as far as anyone knows
    run.steps.ret(0x0104);   // 10
    run.steps.call(0x0300);  // 18
    run.steps.pchl(0x0200);  // 6, a tail call to a known function
    run.steps.ret(0x0107);   // 10
    const auto report = run.profile.report();
    ASSERT_EQ(report.functions.size(), 3u);
    EXPECT_EQ(function(report, "0100H").exclusive_t, 40u);
    EXPECT_EQ(function(report, "0200H").exclusive_t, 30u);
    EXPECT_EQ(function(report, "0200H").calls, 2u);
    EXPECT_EQ(function(report, "0300H").exclusive_t, 6u);
}

TEST(CallProfile, FallingIntoTheNextFunctionIsATailCall) {
    Trial run;
    run.steps.call(0x0200);
    run.steps.jump(0x02FF);  // f 10
    run.steps.nop(2);        // f 4, g 4
    run.steps.ret(0x0103);   // g 10
    const auto report = run.profile.report();
    EXPECT_EQ(function(report, "f").exclusive_t, 14u);
    EXPECT_EQ(function(report, "g").exclusive_t, 14u);
    EXPECT_EQ(function(report, "g").calls, 1u);
}

/// A listener that only listens.
class Deaf final : public host_sim::CallListener {
    void frame_begins(const host_sim::Frame&, bool) override {}
    void frame_ends(const host_sim::Frame&) override {}
    void time_passes(const host_sim::Frame&, uint64_t) override {}
};

TEST(CallStack, FramesAreTheActiveFunctions) {
    Deaf deaf;
    host_sim::CallStack stack(&symbols(), deaf);
    Steps steps([&](const StepRecord& step) { stack.observe(step); });
    steps.call(0x0200);
    steps.interrupt(Kind::rst65, 0x0034);
    steps.call(0x0300);
    std::vector<unsigned> functions;
    for (const auto& frame : stack.frames()) {
        functions.push_back(frame.interrupt ? 0xFFFFu : frame.function);
    }
    EXPECT_EQ(functions, (std::vector<unsigned>{0x0100, 0x0200, 0xFFFF, 0x0034, 0x0300}));
    EXPECT_EQ(stack.interrupt_depth(), 1u);
    EXPECT_EQ(stack.frames()[2].source, Kind::rst65);
    EXPECT_EQ(stack.frames()[3].return_address, 0x0200);
    steps.ret(0x0037);
    steps.ret(0x0200);
    EXPECT_EQ(stack.frames().size(), 2u);
    EXPECT_EQ(stack.interrupt_depth(), 0u);
}

TEST(CallStack, StaysBoundedWhereNothingReturns) {
    Deaf deaf;
    host_sim::CallStack stack(&symbols(), deaf);
    Steps steps([&](const StepRecord& step) { stack.observe(step); });
    for (int i = 0; i < 1000; ++i) {
        steps.set_sp(0x9000);
        steps.call(0x0200);
        steps.jump(0x0100);
    }
    EXPECT_LE(stack.frames().size(), 4u);
}

RC_GTEST_PROP(CallProfile, EveryTStateIsAccountedOnceWhateverTheProgramDoes, ()) {
    Trial run;
    uint64_t steps = 0;
    const auto count = *rc::gen::inRange(1, 200);
    for (int i = 0; i < count; ++i, ++steps) {
        const unsigned target = 0x0100u * *rc::gen::inRange(1u, 6u) + *rc::gen::inRange(0u, 2u);
        switch (*rc::gen::inRange(0, 9)) {
            case 0:
                run.steps.call(target);
                break;
            case 1:
                run.steps.ret(target);
                break;
            case 2:
                run.steps.jump(target);
                break;
            case 3:
                run.steps.pchl(target);
                break;
            case 4:
                run.steps.push();
                break;
            case 5:
                run.steps.pop();
                break;
            case 6:
                run.steps.interrupt(Kind::rst75, 0x003C);
                break;
            case 7:
                run.steps.halted(3);
                break;
            default:
                run.steps.set_sp(*rc::gen::arbitrary<uint16_t>());
                break;
        }
    }
    const auto report = run.profile.report();
    RC_ASSERT(report.total_t == run.steps.t());
    RC_ASSERT(sum_of_exclusive(report) == report.total_t);
    uint64_t in_interrupts = 0;
    for (const auto& entry : report.functions) {
        RC_ASSERT(entry.inclusive_t <= report.total_t - report.halt_t);
        RC_ASSERT(entry.worst_t <= entry.inclusive_t);
        in_interrupts += entry.exclusive_interrupt_t;
    }
    RC_ASSERT(in_interrupts == report.interrupt_t);
    uint64_t by_input = 0;
    for (const auto& entry : report.interrupts) by_input += entry.total_t;
    RC_ASSERT(by_input == report.interrupt_t);
}

TEST(ProfileReport, TextAndJsonSayTheSame) {
    Trial run;
    run.steps.call(0x0200);
    run.steps.nop(3);
    run.steps.interrupt(Kind::rst55, 0x002C);
    run.steps.ret(0x0203);
    run.steps.ret(0x0103);
    const auto report = run.profile.report();
    const auto json = nlohmann::json::parse(host_sim::profile_json(report));
    EXPECT_EQ(json["total_t"], 62);
    EXPECT_EQ(json["functions"][0]["name"], "002CH");  // it and f have 22 each: by address
    EXPECT_EQ(json["functions"][1]["name"], "f");
    EXPECT_EQ(json["functions"][1]["exclusive_t"], 22);
    EXPECT_EQ(json["interrupts"][0]["name"], "RST 5.5");
    EXPECT_EQ(json["interrupts"][0]["total_t"], 22);
    const std::string text = host_sim::profile_text(report);
    EXPECT_NE(text.find("62 T-states: 35.5 % in interrupts, 0.0 % in HALT\n"), std::string::npos);
    EXPECT_NE(text.find("            18   29.0             40          1          0.0            0"
                        "              0  main\n"),
              std::string::npos)
        << text;
}

}  // namespace
