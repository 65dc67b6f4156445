// board_target_boot.cpp - the image from power-up to its first step: symbols, boot, calibration and
// identity over the link, restarts.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "firmware/executive/controller_state.hpp"
#include "hal/board/rb85.hpp"
#include "host_sim/bind/board_target.hpp"

namespace host_sim {

namespace rb85 = hal::rb85;

namespace {

constexpr uint64_t kTickT = rb85::kTickCount;
constexpr uint64_t kBootMaxT = 10ULL * rb85::kClockHz;
constexpr uint64_t kAnswerMaxT = 20 * kStepT;
constexpr uint64_t kWatchdogMaxT = 2ULL * rb85::kClockHz;
/// So coarse is the search for the end of the boot.
constexpr uint64_t kBootSliceT = 50'000;
constexpr uint64_t kSliceT = 4096;
constexpr std::string_view kAcquire = "rover_acquire";

/// "name", or a C++ name whose last part it is: "rover::(anonymous namespace)::name()".
bool is_named(std::string_view symbol, std::string_view name) {
    const std::size_t at = symbol.rfind(name);
    if (at == std::string_view::npos || (at != 0 && symbol[at - 1] != ':')) return false;
    const std::string_view rest = symbol.substr(at + name.size());
    return rest.empty() || rest.starts_with('(');
}

uint16_t address_of(const Symbols& symbols, std::string_view name, bool function,
                    const std::string& file) {
    for (const Symbol& symbol : symbols.all()) {
        const bool kind = function ? symbol.is_function() || symbol.kind == SymbolKind::label
                                   : !symbol.is_function();
        if (kind && is_named(symbol.name, name)) return symbol.address;
    }
    throw ImageError(file, 0, fmt::format("its symbols have no {}", name),
                     "give an image of this rover with its .sym file beside it");
}

std::filesystem::path symbols_beside(std::filesystem::path hex) {
    hex.replace_extension(".sym");
    return hex;
}

BoardOptions options() {
    BoardOptions made;
    made.stop_at_violation = true;
    made.stop_at_halt = true;
    return made;
}

}  // namespace

BoardTarget::BoardTarget(const Image& image, Symbols symbols, SlowStep slow_step)
    : slow_step_(slow_step),
      name_(image.file.empty() ? "the image" : image.file),
      symbols_(std::move(symbols)),
      board_(options()) {
    check_range(image, {rb85::kEepromFirst, rb85::kEepromLast}, "the EEPROM");
    tick_count_at_ = address_of(symbols_, "rover_tick_count", false, name_);
    step_count_at_ = address_of(symbols_, "rover_step_count", false, name_);
    acquire_at_ = address_of(symbols_, kAcquire, true, name_);
    const std::span<const uint8_t> bytes(image.bytes);
    board_.program(bytes.first(rb85::kEepromLast + 1U));
}

BoardTarget::BoardTarget(const std::filesystem::path& hex, SlowStep slow_step)
    : BoardTarget(load_hex(hex), load_symbols(symbols_beside(hex)), slow_step) {}

void BoardTarget::begin(const hal::Calibration& calibration) {
    log_step_ = 0;
    awaited_.clear();
    other_frames_.clear();
    counts_ = {};
    reader_ = {};
    pins_ = {};
    if (switched_on_) {
        board_.state = *switched_on_;
    } else {
        switch_on();
        switched_on_ = board_.state;
    }
    load_calibration(calibration);
    restart_cold();
    begin_steps();
}

/// Power-up with every sensor unplugged, and the question who it is.
void BoardTarget::switch_on() {
    unplug_sensors(board_);
    pins_.set_levels(board_, [] {
        hal::RawInputs absent;
        for (uint16_t& channel : absent.adc_q4_count) channel = hal::kAdcAbsent;
        return absent;
    }());
    run_to_first_step();
    const DownlinkFrame answer = ask(UplinkType::identity, {}, DownlinkFrame::kIdentity);
    const auto payload = answer.payload();
    if (payload.size() != 20 || payload[0] != 1) {
        fail("its identity frame is not of format 1", "use the rover85 of the same version");
    }
    identity_ = fmt::format("rover85 {}.{}.{} sources {:04x}{:04x} board", payload[1], payload[2],
                            payload[3], answer.word(6), answer.word(4));
}

/// The record is stored if it can be used, as the native controller uses it.
void BoardTarget::load_calibration(const hal::Calibration& calibration) {
    constexpr uint8_t kDone = 0, kRefused = 3;
    const DownlinkFrame answer =
        ask(UplinkType::calibration, calibration_payload(calibration), DownlinkFrame::kAcknowledge);
    const uint8_t wanted = rover::is_valid(calibration) ? kDone : kRefused;
    if (answer.payload().size() != 2 || answer.payload()[1] != wanted) {
        fail(fmt::format("the calibration record was answered by {} instead of {}",
                         answer.payload().empty() ? 0 : answer.payload().back(), wanted));
    }
}

/// Sends a frame and waits for its answer.
DownlinkFrame BoardTarget::ask(UplinkType type, const std::vector<uint8_t>& payload,
                               uint8_t answer) {
    const std::size_t before = other_frames_.size();
    send(uplink_frame(type, payload));
    const uint64_t limit_t = board_.state.cpu.t + kAnswerMaxT;
    while (board_.state.cpu.t < limit_t) {
        run(board_.state.cpu.t + kSliceT);
        collect(nullptr);
        for (std::size_t i = before; i < other_frames_.size(); ++i) {
            const DownlinkFrame& frame = other_frames_[i];
            if (frame.kind() != answer) continue;
            if (answer != DownlinkFrame::kAcknowledge ||
                frame.payload()[0] == static_cast<uint8_t>(type)) {
                return frame;
            }
        }
    }
    fail(fmt::format("no answer to the link frame of type {:02X}H within {:.1f} s",
                     static_cast<unsigned>(type),
                     static_cast<double>(kAnswerMaxT) / rb85::kClockHz));
}

/// From reset: the boot ends when it lets the tick through, shortly before the first step. The
/// slice in which it does is run once more, an instruction at a time. An observer sees all
/// instructions once, so with one nothing is taken back.
void BoardTarget::run_to_first_step() {
    const uint64_t limit_t = board_.state.cpu.t + kBootMaxT;
    if (observer_) {
        run_to_acquire(limit_t);
        return;
    }
    for (;;) {
        const BoardState before = board_.state;
        run(board_.state.cpu.t + kBootSliceT);
        if ((board_.state.cpu.masks & mask::kRst75) == 0) {
            board_.state = before;
            break;
        }
        if (board_.state.cpu.t >= limit_t) fail("the image does not boot");
    }
    run_to_acquire(board_.state.cpu.t + kBootSliceT + kTickT);
}

/// The image stands at its first step. Its tick is the one that it counts now.
void BoardTarget::begin_steps() {
    step_ = 0;
    first_tick_ = word(tick_count_at_);
    tick_zero_t_ = next_tick_t(board_) - kTickT;
}

void BoardTarget::restart(Restart kind, std::vector<LogStep>& steps) {
    if (counts_.steps == 0) return;  // it has just started cold
    await_frames(steps, true);
    if (kind == Restart::cold) {
        restart_cold();
    } else {
        board_.reset();
        reader_.reset();
        run_to_first_step();
    }
    begin_steps();
}

/// Over the link: the board runs one more step, which is nobody's, drops its checkpoints and lets
/// the watchdog reset it.
void BoardTarget::restart_cold() {
    constexpr uint8_t kCold = 1;
    const uint64_t resets = board_.state.reset_count;
    (void)ask(UplinkType::restart, {kCold}, DownlinkFrame::kAcknowledge);
    const uint64_t limit_t = board_.state.cpu.t + kWatchdogMaxT;
    awaiting_reset_ = true;
    while (board_.state.reset_count == resets || board_.state.watchdog.pulse()) {
        if (board_.state.cpu.t >= limit_t) fail("no restart after the link asked for one");
        run(board_.state.cpu.t + kSliceT);
    }
    awaiting_reset_ = false;
    collect(nullptr);
    reader_.reset();
    run_to_first_step();
}

}  // namespace host_sim
