// board.cpp - see board.hpp.
#include "host_sim/board/board.hpp"

#include <algorithm>
#include <utility>

#include "host_sim/cpu/recording_bus.hpp"

namespace host_sim {

namespace rb85 = hal::rb85;

namespace {

// The one-shot of the watchdog stretches the button's pulse as well.
constexpr uint64_t kResetPulseT =
    chips::SodWatchdog::kPulseNs * (rb85::kClockHz / 1000) / 1'000'000;
static_assert(chips::SodWatchdog::kPulseNs >
                  chips::At28c256::kLoadTimeNs + chips::At28c256::kWriteCycleNs,
              "the program is fetched when the EEPROM can be read again");
constexpr uint8_t kErased = 0xFF;

void open_bus(BoardState& state, unsigned first, unsigned end) {
    std::fill(state.memory.bytes.begin() + first, state.memory.bytes.begin() + end,
              chips::kOpenBus);
}

}  // namespace

BoardState::BoardState(const MemoryMap& memory_map) : map(memory_map) {
    memory.bytes.fill(0);
    std::fill_n(memory.bytes.begin(), map.eeprom_last + 1U, kErased);
    open_bus(*this, map.eeprom_last + 1U, map.ram_first);
    open_bus(*this, map.ram_last + 1U, 0x10000);
    for (unsigned page = 0; page < kPageCount; ++page) {
        const unsigned first = page * kPageSize;
        memory.page_writable[page] =
            first >= map.ram_first && first + kPageSize - 1 <= map.ram_last;
    }
    eeprom.write_protected = true;
    // The comparator that tells the cause of TRAP drives its line: no undervoltage.
    ppis[0].set_port_input(chips::I82c55a::Port::b, 0, hal::rb85::kTrapCauseBit, 0);
    for (unsigned counter = 0; counter < chips::I82c54::kCounterCount; ++counter) {
        timers[0].set_periodic_clock(counter, 1);
        timers[0].watch_output(counter, counter == rb85::kTickCounter);
        for (chips::I82c54* timer : {&timers[1], &timers[2]}) {
            timer->set_external_clock(counter);
            timer->watch_output(counter, false);
        }
    }
}

Board::Board(const BoardOptions& options) : state(options.memory_map), options_(options) {
    bus_.reset(state.cpu.t);
}

void Board::program(std::span<const uint8_t> bytes, uint16_t address) {
    state.eeprom.load(bytes, address);
    std::copy_n(state.eeprom.data(), state.map.eeprom_last + 1U, state.memory.bytes.begin());
    state.event_t = 0;
}

bool Board::reset_if_pending() {
    if (!state.reset_pending) return false;
    reset();
    return true;
}

void Board::reset() {
    bus_.advance(state.cpu.t);
    bus_.reset(state.cpu.t);
    if (state.watchdog.pulse()) return;  // which holds the processor as long as it lasts
    state.cpu.t += kResetPulseT;
    bus_.advance(state.cpu.t);
    host_sim::reset(state.cpu);  // what came meanwhile was not latched
    bus_.find_lines(state.cpu.t);
}

void Board::power_cycle() {
    BoardState fresh(state.map);
    const uint64_t t = state.cpu.t;
    state.eeprom.power_off(t);
    state.eeprom.power_on(t);
    fresh.eeprom = state.eeprom;
    const auto ram = [&](FlatMemory& memory) { return memory.bytes.begin() + state.map.ram_first; };
    std::copy(ram(state.memory), state.memory.bytes.begin() + state.map.ram_last + 1,
              ram(fresh.memory));
    std::copy_n(fresh.eeprom.data(), state.map.eeprom_last + 1U, fresh.memory.bytes.begin());
    fresh.cpu.t = t;
    fresh.range = state.range;
    fresh.presence = state.presence;
    fresh.stimuli = state.stimuli;
    state = fresh;
    bus_.reset(t);
}

// -- Runs
// --------------------------------------------------------------------------------------------

RunEnd Board::run(uint64_t until_t) {
    return run_loop<true>(until_t);
}
RunEnd Board::run_reference(uint64_t until_t) {
    return run_loop<false>(until_t);
}

template <bool kFast>
RunEnd Board::run_loop(uint64_t until_t) {
    until_t_ = until_t;
    undefined_ = false;
    violations_before_ = state.violation_count;
    while (state.cpu.t < until_t) {
        bus_.advance(state.cpu.t);
        if (reset_if_pending()) continue;
        if (state.watchdog.pulse()) {  // held in reset
            state.cpu.t = std::min(until_t, state.event_t);
            continue;
        }
        const Interrupt interrupt = pending_interrupt(state.cpu);
        if (interrupt != Interrupt::none) {
            bus_.set_instruction_pc(state.cpu.pc);
            Reference<BoardBus>(state.cpu, bus_).accept(interrupt);
        } else if (state.cpu.halted) {
            if (stops_here()) return RunEnd::halted;
            state.cpu.t = wake_t(until_t);
        } else {
            run_some<kFast>(until_t);
        }
        if (undefined_) return RunEnd::undefined_instruction;
        if (options_.stop_at_violation && state.violation_count != violations_before_) {
            return RunEnd::violation;
        }
    }
    return RunEnd::time_limit;
}

template <bool kFast>
void Board::run_some(uint64_t until_t) {
    if (!pins_settled(state.cpu) || state.eeprom.active) {
        execute_exactly();
        return;
    }
    if constexpr (kFast) {
        run_fast(state.cpu, state.memory, *this, options_.instruction_set);
    } else {
        while (state.cpu.t < std::min(until_t, state.event_t) && execute_exactly()) {
        }
    }
}

uint64_t Board::run_until_t() const {
    return std::min(until_t_, state.event_t);
}

// The answer lets the fast interpreter go on only where nothing but its own instructions can change
// what happens next.
bool Board::execute_exactly() {
    bus_.set_instruction_pc(state.cpu.pc);
    const uint64_t violations = state.violation_count;
    undefined_ = !Reference<BoardBus>(state.cpu, bus_, options_.instruction_set).execute();
    return !undefined_ && !state.cpu.halted && pins_settled(state.cpu) && !state.eeprom.active &&
           !state.reset_pending && pending_interrupt(state.cpu) == Interrupt::none &&
           !(options_.stop_at_violation && state.violation_count != violations);
}

bool Board::stops_here() const {
    return options_.stop_at_halt && state.cpu.halted && !state.cpu.interrupt_enable;
}

// HALT samples the pins in every T-state: a fresh change is watched T by T, else the next event is
// the next thing that can happen.
uint64_t Board::wake_t(uint64_t until_t) const {
    if (!pins_settled(state.cpu)) return state.cpu.t + 1;
    return std::min(until_t, state.event_t);
}

RunEnd Board::step(StepRecord& record, uint64_t until_t) {
    bus_.advance(state.cpu.t);
    const uint64_t begin_t = state.cpu.t;
    if (reset_if_pending() && state.cpu.t != begin_t) {  // held as long as the button's pulse
        record = {StepRecord::Kind::halt,
                  state.cpu.pc,
                  state.cpu.sp,
                  state.cpu.pc,
                  state.cpu.sp,
                  begin_t,
                  state.cpu.t,
                  0,
                  {}};
        return RunEnd::time_limit;
    }
    const bool held = state.watchdog.pulse();
    const Interrupt interrupt = held ? Interrupt::none : pending_interrupt(state.cpu);
    const uint64_t violations = state.violation_count;
    bus_.set_instruction_pc(state.cpu.pc);
    if (held || (state.cpu.halted && interrupt == Interrupt::none)) {
        if (stops_here()) return RunEnd::halted;
        record = {StepRecord::Kind::halt,
                  state.cpu.pc,
                  state.cpu.sp,
                  state.cpu.pc,
                  state.cpu.sp,
                  state.cpu.t,
                  0,
                  0,
                  {}};
        state.cpu.t = wake_t(until_t);
        record.t_end = state.cpu.t;
        return RunEnd::time_limit;
    }
    if (!step_recorded(state.cpu, bus_, options_.instruction_set, interrupt, record)) {
        return RunEnd::undefined_instruction;
    }
    if (options_.stop_at_violation && state.violation_count != violations) {
        return RunEnd::violation;
    }
    return RunEnd::time_limit;
}

// -- Outside
// -------------------------------------------------------------------------------------------

void Board::schedule(const Stimulus& stimulus) {
    if (stimulus.t <= state.cpu.t) {
        Stimulus now = stimulus;
        now.t = state.cpu.t;
        bus_.advance(now.t);
        bus_.apply(now);
        return;
    }
    const auto later =
        std::upper_bound(state.stimuli.begin(), state.stimuli.end(), stimulus.t,
                         [](uint64_t t, const Stimulus& queued) { return t < queued.t; });
    state.stimuli.insert(later, stimulus);
    state.event_t = std::min(state.event_t, stimulus.t);
}

void Board::set_range_scan(uint8_t present, const chips::RangeModule::Heights& heights_q1_mm) {
    state.range.advance(state.cpu.t);
    state.range.set_scan(present, heights_q1_mm);
}

void Board::replay_range_scan(uint8_t counter, uint8_t present,
                              const chips::RangeModule::Heights& heights_q1_mm) {
    state.range.advance(state.cpu.t);
    state.range.set_scan(counter, present, heights_q1_mm);
}

void Board::set_range_connected(bool connected) {
    state.range.set_connected(connected, state.cpu.t);
}

void Board::replay_sensor(uint8_t channel, uint16_t sum_q4) {
    if (sum_q4 > hal::kAdcMaxQ4Count) {
        state.analog.set_silent(channel, state.cpu.t);
    } else {
        state.analog.set_sensor_sum(channel, sum_q4, state.cpu.t);
    }
}

void Board::turn_wheel(uint8_t wheel, int32_t pulses) {
    if (pulses == 0) return;
    const uint64_t t = state.cpu.t;
    schedule({t, Stimulus::Kind::tach_forward, wheel, pulses > 0 ? 1 : 0});
    chips::I82c54& timer = state.timers[1 + wheel / chips::I82c54::kCounterCount];
    timer.clock_pulses(wheel % chips::I82c54::kCounterCount,
                       static_cast<uint64_t>(pulses > 0 ? pulses : -pulses), t);
}

std::vector<chips::I8251a::TransmittedByte> Board::take_transmitted() {
    return std::exchange(state.usart.transmitted, {});
}

}  // namespace host_sim
