// board_vcd.cpp - see board_vcd.hpp.
#include "host_sim/board/board_vcd.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace host_sim {

namespace {

constexpr std::array<const char*, kPinCount> kPinNames = {"trap",  "rst75", "rst65",
                                                          "rst55", "intr",  "sid"};

uint64_t variable_value(const BoardState& state, const VcdVariable& variable) {
    uint64_t value = 0;
    for (unsigned i = variable.size; i-- > 0;) {
        value = value << 8 | state.memory.bytes[static_cast<uint16_t>(variable.address + i)];
    }
    return value;
}

}  // namespace

BoardVcd::BoardVcd(const std::filesystem::path& path, const BoardState& state,
                   const std::vector<VcdVariable>& variables)
    : writer_(path, hal::rb85::kClockHz), end_t_(state.cpu.t) {
    add_processor(state);
    add_pins(state);
    add_chips(state);
    for (const VcdVariable& variable : variables) {
        if (variable.size < 1 || variable.size > 4) {
            throw std::invalid_argument(variable.name + ": a signal has 1 to 4 bytes");
        }
        add("program", variable.name, variable.size * 8U, state,
            [variable](const BoardState& s) { return variable_value(s, variable); });
    }
}

void BoardVcd::add(const char* scope, const std::string& name, unsigned width,
                   const BoardState& state, std::function<uint64_t(const BoardState&)> value) {
    const auto signal = writer_.add_signal(scope, name, width, value(state));
    levels_.push_back({signal, std::move(value)});
}

void BoardVcd::add_processor(const BoardState& state) {
    add("cpu", "pc", 16, state, [](const BoardState& s) { return s.cpu.pc; });
    add("cpu", "sp", 16, state, [](const BoardState& s) { return s.cpu.sp; });
    add("cpu", "a", 8, state, [](const BoardState& s) { return s.cpu.a; });
    add("cpu", "f", 8, state, [](const BoardState& s) { return s.cpu.f; });
    add("cpu", "bc", 16, state, [](const BoardState& s) { return s.cpu.bc(); });
    add("cpu", "de", 16, state, [](const BoardState& s) { return s.cpu.de(); });
    add("cpu", "hl", 16, state, [](const BoardState& s) { return s.cpu.hl(); });
    add("cpu", "interrupt_enable", 1, state,
        [](const BoardState& s) { return uint64_t{s.cpu.interrupt_enable}; });
    add("cpu", "halted", 1, state, [](const BoardState& s) { return uint64_t{s.cpu.halted}; });
    add("cpu", "sod", 1, state, [](const BoardState& s) { return uint64_t{s.cpu.sod}; });
}

void BoardVcd::add_pins(const BoardState& state) {
    for (unsigned pin = 0; pin < kPinCount; ++pin) {
        const PinState& now = state.cpu.pins[pin];
        pins_[pin] = writer_.add_signal("cpu.pins", kPinNames[pin], 1, uint64_t{now.level});
        pin_seen_t_[pin] = now.changed_t;
    }
    port_ = writer_.add_signal("ports", "address", 8);
    port_data_ = writer_.add_signal("ports", "data", 8);
    port_read_ = writer_.add_signal("ports", "read", 1, 0);
    port_write_ = writer_.add_signal("ports", "write", 1, 0);
}

void BoardVcd::add_chips(const BoardState& state) {
    using Port = chips::I82c55a::Port;
    for (const auto& [port, name] : {std::pair{Port::a, "a"}, {Port::b, "b"}, {Port::c, "c"}}) {
        add("ppi_a", name, 8, state,
            [port](const BoardState& s) { return s.ppis[0].port_level(port); });
        add("ppi_b", name, 8, state,
            [port](const BoardState& s) { return s.ppis[1].port_level(port); });
    }
    for (unsigned motor = 0; motor < chips::MotorLatch::kMotorCount; ++motor) {
        add("motors", "duty" + std::to_string(motor), 16, state,
            [motor](const BoardState& s) { return static_cast<uint16_t>(s.motors.duty(motor)); });
    }
    add("adc", "busy", 1, state,
        [](const BoardState& s) { return uint64_t{s.analog.busy(s.cpu.t)}; });
    add("adc", "channel", 4, state, [](const BoardState& s) { return s.analog.mux.channel; });
    add("usart", "tx_ready", 1, state,
        [](const BoardState& s) { return uint64_t{s.usart.tx_ready_pin()}; });
    add("usart", "rx_ready", 1, state,
        [](const BoardState& s) { return uint64_t{s.usart.rx_ready_pin()}; });
    add("eeprom", "busy", 1, state, [](const BoardState& s) { return uint64_t{s.eeprom.active}; });
    add("watchdog", "pulse", 1, state,
        [](const BoardState& s) { return uint64_t{s.watchdog.pulse()}; });
}

void BoardVcd::observe(const StepRecord& step, const BoardState& state) {
    observe_pins(state.cpu);
    observe_ports(step);
    for (const Level& level : levels_) {
        pending_.push_back({step.t_end, level.signal, level.value(state)});
    }
    end_t_ = step.t_end;
    // Pins that change inside of this step are reported by the next one.
    write_until(step.t_begin);
}

// Between two looks a pin may have changed twice, as OUT of a timer in mode 2 does.
void BoardVcd::observe_pins(const CpuState& cpu) {
    for (unsigned pin = 0; pin < kPinCount; ++pin) {
        const PinState& now = cpu.pins[pin];
        if (now.changed_t == pin_seen_t_[pin]) continue;
        if (now.previous_changed_t > pin_seen_t_[pin]) {
            pending_.push_back({now.previous_changed_t, pins_[pin], uint64_t{now.previous}});
        }
        pending_.push_back({now.changed_t, pins_[pin], uint64_t{now.level}});
        pin_seen_t_[pin] = now.changed_t;
    }
}

void BoardVcd::observe_ports(const StepRecord& step) {
    for (unsigned i = 0; i < step.access_count; ++i) {
        const BusAccess& access = step.accesses[i];
        const bool in = access.kind == BusAccess::Kind::in;
        if (!in && access.kind != BusAccess::Kind::out) continue;
        constexpr uint64_t kCycleT = 3;
        const auto strobe = in ? port_read_ : port_write_;
        pending_.push_back({access.t - kCycleT, port_, access.address});
        pending_.push_back({access.t - kCycleT, strobe, 1});
        pending_.push_back({access.t - kCycleT, port_data_, access.value});
        pending_.push_back({access.t, strobe, 0});
    }
}

void BoardVcd::write_until(uint64_t t) {
    std::stable_sort(pending_.begin(), pending_.end(),
                     [](const Change& left, const Change& right) { return left.t < right.t; });
    auto next = pending_.begin();
    for (; next != pending_.end() && next->t <= t; ++next) {
        writer_.change(next->signal, next->value, next->t);
    }
    pending_.erase(pending_.begin(), next);
}

void BoardVcd::close() {
    write_until(end_t_);
    writer_.close(end_t_);
}

}  // namespace host_sim
