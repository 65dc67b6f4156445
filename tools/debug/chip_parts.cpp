// chip_parts.cpp - see chip_parts.hpp.
#include "tools/debug/chip_parts.hpp"

#include <array>

namespace debug_console {

using host_sim::BoardState;
using host_sim::chips::Properties;

namespace {

template <class Chip>
Properties present(Chip chip, uint64_t now_t) {
    chip.advance(now_t);
    if constexpr (requires { chip.properties(now_t); }) {
        return chip.properties(now_t);
    } else {
        return chip.properties();
    }
}

/// `get` finds the chip in the state.
template <auto kGet>
constexpr ChipPart part(std::string_view name, std::string_view description) {
    return {
        name, description,
        [](const BoardState& state) { return present(kGet(state), state.cpu.t); },
        [](const BoardState& one, const BoardState& other) { return kGet(one) == kGet(other); }};
}

constexpr auto kUsart = [](const BoardState& state) -> const auto& { return state.usart; };
template <unsigned kIndex>
constexpr auto kTimer = [](const BoardState& state) -> const auto& { return state.timers[kIndex]; };
template <unsigned kIndex>
constexpr auto kPpi = [](const BoardState& state) -> const auto& { return state.ppis[kIndex]; };
constexpr auto kAnalog = [](const BoardState& state) -> const auto& { return state.analog; };
constexpr auto kMotors = [](const BoardState& state) -> const auto& { return state.motors; };
constexpr auto kPresence = [](const BoardState& state) -> const auto& { return state.presence; };
constexpr auto kEeprom = [](const BoardState& state) -> const auto& { return state.eeprom; };
constexpr auto kRange = [](const BoardState& state) -> const auto& { return state.range; };
constexpr auto kWatchdog = [](const BoardState& state) -> const auto& { return state.watchdog; };

constexpr std::array kParts = {
    part<kUsart>("usart", "8251A at 08H: telemetry and command link"),
    part<kTimer<0>>("timer-a", "82C54 at 10H: tick, baud rate, laser"),
    part<kTimer<1>>("timer-b", "82C54 at 14H: tachometers of wheels 0 to 2"),
    part<kTimer<2>>("timer-c", "82C54 at 18H: tachometers of wheels 3 to 5"),
    part<kPpi<0>>("ppi-a", "82C55A at 20H: analog front end, outputs"),
    part<kPpi<1>>("ppi-b", "82C55A at 24H: range module, detectors"),
    part<kAnalog>("analog", "AD574A at 28H, multiplexer, sample-and-hold"),
    part<kMotors>("motors", "motor latches at 30H"),
    part<kPresence>("presence", "74HC244 at 2CH: which tachometers are plugged in"),
    part<kEeprom>("eeprom", "28C256: program and tables"),
    part<kRange>("range", "range module behind ppi-b"),
    part<kWatchdog>("watchdog", "one-shot on SOD"),
};

}  // namespace

std::span<const ChipPart> chip_parts() {
    return kParts;
}

}  // namespace debug_console
