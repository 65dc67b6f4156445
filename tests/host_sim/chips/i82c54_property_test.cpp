// i82c54_property_test.cpp - 82C54: any program agrees with counting clock by clock; strides;
// copies.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "host_sim/chips/i82c54.hpp"
#include "tests/host_sim/chips/i82c54_fixture.hpp"
#include "tests/host_sim/chips/i82c54_reference.hpp"

namespace {

using namespace host_sim::chips_test;

// -- Properties ----------------------------------------------------------------------------------

TEST(I82c54Speed, LongTimesNeedNoSteps) {
    for (unsigned mode = 0; mode < 6; ++mode) {
        I82c54 timer = timer_in_mode(mode);
        timer.write(0, 7, 20);
        timer.advance(1'000'000'000'000);  // would take minutes clock by clock
        EXPECT_TRUE(timer.output(0) || mode == 2 || mode == 3) << mode;
    }
    I82c54 timer = timer_in_mode(2);
    timer.write(0, 7, 20);
    timer.advance(21 + 7'000'000'000'006);
    EXPECT_EQ(timer.read(0, timer.last_t), 1);
    EXPECT_FALSE(timer.output(0));
}

/// One action on a counter; what it means depends on `kind`.
struct Action {
    uint8_t kind = 0;
    uint8_t mode = 0;
    bool bcd = false;
    uint16_t count = 0;
    uint32_t wait_t = 0;
};

rc::Gen<Action> any_action() {
    return rc::gen::apply(
        [](uint8_t kind, uint8_t mode, bool bcd, uint16_t count, uint32_t wait_t) {
            return Action{kind, mode, bcd, count, wait_t};
        },
        rc::gen::inRange<uint8_t>(0, 8), rc::gen::inRange<uint8_t>(0, 6),
        rc::gen::weightedElement<bool>({{3, false}, {1, true}}),
        rc::gen::oneOf(rc::gen::inRange<uint16_t>(2, 10), rc::gen::just<uint16_t>(0),
                       rc::gen::just<uint16_t>(0x1357)),
        rc::gen::oneOf(rc::gen::inRange<uint32_t>(0, 30), rc::gen::inRange<uint32_t>(0, 6000)));
}

/// Does one action to chip and reference (0 and 1 only wait).
void act(I82c54& timer, TimerReference& reference, const Action& action, uint64_t now_t) {
    switch (action.kind) {
        case 2:
            timer.write(I82c54::kControlAddress,
                        control(0, kBoth, action.mode, action.bcd ? kBcd : 0), now_t);
            reference.write_control(action.mode, action.bcd);
            break;
        case 3:
        case 4:
            write_two(timer, 0, action.count, now_t);
            reference.write_first_byte();
            reference.write_count(action.count);
            break;
        case 5:
            timer.set_gate(0, !reference.gate, now_t);
            reference.set_gate(!reference.gate);
            break;
        case 6:
            timer.write(0, static_cast<uint8_t>(action.count), now_t);
            timer.write(0, static_cast<uint8_t>(action.count >> 8), now_t + 3);
            break;
        default:
            break;
    }
}

RC_GTEST_PROP(I82c54Property, AgreesWithCountingClockByClock, ()) {
    const auto period_t = *rc::gen::element<uint64_t>(1, 1, 3);
    const auto actions = *rc::gen::container<std::vector<Action>>(any_action());
    I82c54 timer;
    timer.set_periodic_clock(0, period_t);
    timer.write(I82c54::kControlAddress, control(0, kBoth, 2), 0);
    TimerReference reference;
    reference.write_control(2, false);
    uint64_t now_t = 0;
    for (Action action : actions) {
        action.kind = action.kind == 6 ? uint8_t{1} : action.kind;
        act(timer, reference, action, now_t);
        RC_ASSERT(timer.output(0) == reference.output);
        const uint64_t end_t = now_t + action.wait_t;
        while (now_t < end_t) {
            ++now_t;
            const bool before = reference.output;
            if (now_t % period_t == 0) {
                reference.pulse();
            }
            RC_ASSERT((reference.output != before) == (timer.next_event_t() == now_t));
            if (timer.next_event_t() == now_t) {
                timer.advance(now_t);
                RC_ASSERT(timer.output(0) == reference.output);
            }
        }
        RC_ASSERT(read_two(timer, 0, now_t) == reference.count());
        RC_ASSERT(((status_of(timer) & kStatusNull) != 0) == reference.null_count);
    }
}

RC_GTEST_PROP(I82c54Property, OneStrideOrManyAndCopiesLeaveTheSameState, ()) {
    const auto actions = *rc::gen::container<std::vector<Action>>(any_action());
    const auto step_t = *rc::gen::inRange<uint64_t>(1, 400);
    I82c54 strides;
    strides.set_periodic_clock(0, *rc::gen::inRange<uint64_t>(1, 5), 1);
    strides.set_periodic_clock(1, 7);
    strides.write(I82c54::kControlAddress, control(1, kLsb, 3), 0);
    strides.write(1, 5, 0);
    I82c54 steps = strides;
    TimerReference ignored;
    uint64_t now_t = 10;
    for (const Action& action : actions) {
        TimerReference same = ignored;
        act(strides, ignored, action, now_t);
        act(steps, same, action, now_t);
        now_t += 3 + action.wait_t;
        strides.advance(now_t);
        while (steps.last_t < now_t) {
            steps.advance(std::min(now_t, steps.last_t + step_t));
        }
        RC_ASSERT(strides == steps);
        I82c54 copy = steps;
        RC_ASSERT(copy == steps);
        steps = copy;
    }
}

}  // namespace
