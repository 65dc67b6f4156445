// i8251a_property_test.cpp - 8251A: strides, copies, events, and one part talking to another.
// Times        TxC = RxC = 10 T with falling edges at multiples of 10, factor 16, so 160 T per bit
//              (19,200 baud at 3.072 MHz) and 1600 T per frame 8N1. Rising edges at 5, 15, ...
#include "host_sim/chips/i8251a.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/host_sim/chips/i8251a_fixture.hpp"

namespace {

using namespace host_sim::chips_test;
using host_sim::chips::kNever;

// -- Properties ----------------------------------------------------------------------------------

struct Action {
    uint8_t kind = 0;
    uint8_t value = 0;
    uint16_t wait_t = 0;
};

rc::Gen<std::vector<Action>> any_actions() {
    return rc::gen::container<std::vector<Action>>(rc::gen::apply(
        [](uint8_t kind, uint8_t value, uint16_t wait_t) { return Action{kind, value, wait_t}; },
        rc::gen::inRange<uint8_t>(0, 11), rc::gen::arbitrary<uint8_t>(),
        rc::gen::oneOf(rc::gen::inRange<uint16_t>(0, 100), rc::gen::inRange<uint16_t>(0, 9000))));
}

void act(I8251a& usart, const Action& action, uint64_t now_t) {
    const Format format{static_cast<uint8_t>(5 + action.value % 4),
                        static_cast<Parity>(action.value / 4 % 3), 3};
    switch (action.kind) {
        case 0:
            usart.write(kControl, kBothWays, now_t);
            break;
        case 1:
            usart.write(kControl, action.value, now_t);
            break;
        case 2:
        case 3:
            usart.write(kData, action.value, now_t);
            break;
        case 4:
            usart.advance(now_t);
            usart.line_in(action.value, now_t + 7, 39'000 + 20U * action.value, format);
            break;
        case 5:
            usart.advance(now_t);
            usart.line_in(action.value, now_t, kBitQ8T);
            break;
        case 6:
            usart.advance(now_t);
            usart.line_break(now_t + 5, now_t + 5 + 20U * action.value);
            break;
        case 7:
            usart.read(kData, now_t);
            break;
        case 8:
            usart.set_cts(action.value > 80, now_t);
            break;
        case 9:
            usart.set_clock_period_t(action.value % 3 == 0 ? action.value % 7 : kClockT, now_t);
            break;
        default:
            usart.write(kControl, Command::kInternalReset, now_t);
            usart.write(kControl, action.value | 2, now_t);
            break;
    }
}

RC_GTEST_PROP(I8251aProperty, OneStrideOrManyAndCopiesLeaveTheSameState, ()) {
    const auto actions = *any_actions();
    const auto step_t = *rc::gen::inRange<uint64_t>(1, 400);
    I8251a strides = ready_usart();
    I8251a steps = strides;
    uint64_t now_t = 1000;
    for (const Action& action : actions) {
        act(strides, action, now_t);
        act(steps, action, now_t);
        now_t += action.wait_t;
        strides.advance(now_t);
        while (steps.last_t < now_t) {
            steps.advance(std::min(now_t, steps.last_t + step_t));
        }
        RC_ASSERT(strides == steps);
        const I8251a copy = steps;
        steps = copy;
    }
}

RC_GTEST_PROP(I8251aProperty, NoFlagChangesBetweenEvents, ()) {
    const auto actions = *any_actions();
    I8251a usart = ready_usart();
    uint64_t now_t = 1000;
    for (const Action& action : actions) {
        act(usart, action, now_t);
        const uint64_t end_t = now_t + std::min<uint64_t>(action.wait_t, 2500);
        while (now_t < end_t) {
            ++now_t;
            const uint8_t before = usart.status();
            const bool pin = usart.tx_ready_pin();
            const size_t sent = usart.transmitted.size();
            const uint64_t event_t = usart.next_event_t();
            usart.advance(now_t);
            const bool changed = usart.status() != before || usart.tx_ready_pin() != pin ||
                                 usart.transmitted.size() != sent;
            RC_ASSERT(!changed || now_t == event_t);
            RC_ASSERT(event_t >= now_t);
        }
    }
}

RC_GTEST_PROP(I8251aProperty, WhatOneSendsAnotherReceives, ()) {
    const auto bytes = *rc::gen::container<std::vector<uint8_t>>(rc::gen::arbitrary<uint8_t>());
    const auto format_bits = *rc::gen::inRange<unsigned>(0, 4);
    const auto parity_bits = *rc::gen::element(0x00U, 0x10U, 0x30U);
    const auto stop = *rc::gen::inRange<unsigned>(1, 4);
    const auto mode = static_cast<uint8_t>(stop << 6 | parity_bits | format_bits << 2 | 2);
    I8251a sender = ready_usart(mode);
    I8251a receiver = ready_usart(mode);
    std::vector<uint8_t> got;
    const auto mask = static_cast<uint8_t>((1U << (5 + format_bits)) - 1);
    for (const uint8_t byte : bytes) {
        while (!sender.tx_ready_pin()) {
            sender.advance(sender.next_event_t());
        }
        sender.write(kData, byte, sender.last_t);
    }
    sender.advance(sender.last_t + 10'000);
    RC_ASSERT(sender.transmitted.size() == bytes.size());
    for (const auto& sent : sender.transmitted) {
        const Format& format = sender.format();
        const uint64_t half_bits = 2U * (1U + format.data_bits) +
                                   (format.parity == Parity::none ? 0U : 2U) +
                                   format.stop_half_bits;
        receiver.line_in(sent.byte, sent.start_t, (sent.end_t - sent.start_t) * 512 / half_bits,
                         format);
    }
    while (receiver.next_event_t() != kNever) {
        receiver.advance(receiver.next_event_t());
        if (receiver.rx_ready_pin()) {
            got.push_back(receiver.read(kData, receiver.last_t));
        }
    }
    RC_ASSERT(got.size() == bytes.size());
    for (size_t index = 0; index < got.size(); ++index) {
        RC_ASSERT(got[index] == (bytes[index] & mask));
    }
    RC_ASSERT((receiver.status() & Status::kErrors) == 0);
    RC_ASSERT(sender.overwritten_count == 0U);
}

}  // namespace
