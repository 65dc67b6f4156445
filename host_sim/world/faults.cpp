// faults.cpp - fault plans: reading them, and what each kind does to each channel.
#include "host_sim/world/faults.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "host_sim/world/text_file.hpp"
#include "host_sim/world/toml_input.hpp"

namespace host_sim {

namespace {

using Group = FaultChannel::Group;

constexpr std::array<std::string_view, hal::kAngleChannelCount> kAngleNames = {
    "bogie_left", "bogie_right", "differential", "pitch", "roll"};
constexpr std::array<std::string_view, hal::kWheelCount> kTachNames = {
    "tach_front_left",   "tach_front_right", "tach_middle_left",
    "tach_middle_right", "tach_rear_left",   "tach_rear_right"};
constexpr std::array<std::string_view, 4> kKindNames = {"stuck", "dropped", "offset", "absent"};
constexpr double kLongestS = 1e7;
constexpr double kLargestValue = 65535;

std::optional<FaultChannel> find_channel(std::string_view name) {
    for (std::size_t i = 0; i < kAngleNames.size(); ++i) {
        if (name == kAngleNames[i]) return FaultChannel{Group::angle, static_cast<std::uint8_t>(i)};
    }
    for (std::size_t i = 0; i < kTachNames.size(); ++i) {
        if (name == kTachNames[i]) {
            return FaultChannel{Group::tachometer, static_cast<std::uint8_t>(i)};
        }
    }
    if (name == "tach") return FaultChannel{Group::tachometer, kEveryWheel};
    if (name == "range") return FaultChannel{Group::range_module, 0};
    if (name.size() == 7 && name.starts_with("range_") && name[6] >= '0' && name[6] <= '7') {
        return FaultChannel{Group::range_sample, static_cast<std::uint8_t>(name[6] - '0')};
    }
    return std::nullopt;
}

std::optional<FaultKind> find_kind(std::string_view name) {
    for (std::size_t i = 0; i < kKindNames.size(); ++i) {
        if (name == kKindNames[i]) return static_cast<FaultKind>(i);
    }
    return std::nullopt;
}

constexpr const char* kChannelHelp =
    "is no channel; one of bogie_left bogie_right differential pitch roll tach tach_front_left ... "
    "tach_rear_right range range_0 ... range_7";
constexpr const char* kKindHelp = "is no kind of fault; one of stuck dropped offset absent";

// What is wrong with a fault's times and value; empty if nothing is.
std::string check_fault(const Fault& fault, bool has_value) {
    if (!(fault.from_s >= 0) || fault.from_s > kLongestS) return "begins at no possible time";
    if (!(fault.to_s > fault.from_s)) return "ends before it begins";
    if (fault.kind == FaultKind::offset && !has_value) return "an offset needs a value";
    if (fault.kind == FaultKind::dropped && (fault.value < 0 || fault.value > 1)) {
        return "the value of dropped is a chance from 0 to 1";
    }
    if (has_value && (fault.kind == FaultKind::stuck || fault.kind == FaultKind::absent)) {
        return "stuck and absent take no value";
    }
    if (!(std::abs(fault.value) <= kLargestValue)) return "the value is beyond 65535";
    return {};
}

InputError bad_entry(std::string_view entry, std::string_view what) {
    std::string message = "fault '";
    message.append(entry).append("': ").append(what);
    message.append(
        "; write channel:kind[=value]@from-[to] in seconds, such as "
        "bogie_left:stuck@120-180");
    return InputError(message);
}

// Takes a number off the front of `text`.
bool take_number(std::string_view& text, double& value) {
    const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
    if (result.ec != std::errc{} || !std::isfinite(value)) return false;
    text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
    return true;
}

std::string quoted(std::string_view name, std::string_view what) {
    std::string message(1, '\'');
    message.append(name).append("' ").append(what);
    return message;
}

Fault parse_entry(std::string_view entry) {
    const std::size_t colon = entry.find(':');
    const std::size_t at = entry.find('@');
    if (colon == std::string_view::npos || at == std::string_view::npos || at < colon) {
        throw bad_entry(entry, "has no ':' followed by '@'");
    }
    Fault fault;
    const auto channel = find_channel(entry.substr(0, colon));
    if (!channel) throw bad_entry(entry, quoted(entry.substr(0, colon), kChannelHelp));
    fault.channel = *channel;
    std::string_view kind_text = entry.substr(colon + 1, at - colon - 1);
    const std::size_t equals = kind_text.find('=');
    const bool has_value = equals != std::string_view::npos;
    const auto kind = find_kind(kind_text.substr(0, equals));
    if (!kind) throw bad_entry(entry, quoted(kind_text.substr(0, equals), kKindHelp));
    fault.kind = *kind;
    fault.value = fault.kind == FaultKind::dropped ? 0.5 : 0.0;
    if (has_value && !parse_number(kind_text.substr(equals + 1), fault.value)) {
        throw bad_entry(entry, "the value is not a number");
    }
    std::string_view span = entry.substr(at + 1);
    if (!take_number(span, fault.from_s) || span.empty() || span.front() != '-') {
        throw bad_entry(entry, "'@' is not followed by a time and '-'");
    }
    span.remove_prefix(1);
    if (!span.empty() && !parse_number(span, fault.to_s)) {
        throw bad_entry(entry, "the end is not a time");
    }
    const std::string wrong = check_fault(fault, has_value);
    if (!wrong.empty()) throw bad_entry(entry, wrong);
    return fault;
}

std::int16_t add_sat_q1(std::int16_t value_q1_mm, double add_mm) {
    const double sum = std::clamp(value_q1_mm + std::round(2.0 * add_mm), -32768.0, 32767.0);
    return static_cast<std::int16_t>(sum);
}

void copy_range(const hal::RawInputs& from, hal::RawInputs& to) {
    to.range_scan_count = from.range_scan_count;
    to.range_present = from.range_present;
    std::copy(std::begin(from.range_q1_mm), std::end(from.range_q1_mm), std::begin(to.range_q1_mm));
}

}  // namespace

FaultPlan parse_faults(std::string_view text) {
    FaultPlan plan;
    text = trimmed(text);
    while (!text.empty()) {
        const std::size_t comma = text.find(',');
        plan.push_back(parse_entry(trimmed(text.substr(0, comma))));
        if (comma == std::string_view::npos) break;
        text = text.substr(comma + 1);
        if (trimmed(text).empty()) throw bad_entry("", "nothing follows the last comma");
    }
    return plan;
}

FaultPlan parse_faults_toml(std::string_view toml_text, const std::string& file_name) {
    const toml::table parsed = parse_toml(toml_text, file_name);
    TomlTable(parsed, file_name, "").allow_only({"fault"});
    FaultPlan plan;
    const toml::node* list = parsed.get("fault");
    if (list == nullptr) return plan;
    if (!list->is_array_of_tables()) {
        throw input_error(file_name, list->source().begin.line, "'fault' must be [[fault]] tables");
    }
    for (const toml::node& element : *list->as_array()) {
        const TomlTable entry(*element.as_table(), file_name, "fault");
        entry.allow_only({"channel", "kind", "from_s", "to_s", "value"});
        Fault fault;
        const auto channel = find_channel(entry.text("channel"));
        if (!channel) throw entry.wrong("channel", kChannelHelp);
        fault.channel = *channel;
        const auto kind = find_kind(entry.text("kind"));
        if (!kind) throw entry.wrong("kind", kKindHelp);
        fault.kind = *kind;
        fault.from_s = entry.number("from_s", 0, kLongestS);
        fault.to_s = entry.optional_number("to_s", 0, kLongestS).value_or(fault.to_s);
        const auto value = entry.optional_number("value", -kLargestValue, kLargestValue);
        fault.value = value.value_or(fault.kind == FaultKind::dropped ? 0.5 : 0.0);
        const std::string wrong = check_fault(fault, value.has_value());
        if (!wrong.empty()) throw entry.wrong("kind", wrong);
        plan.push_back(fault);
    }
    return plan;
}

FaultInjector::FaultInjector(FaultPlan plan, const Vehicle& vehicle, std::uint64_t seed) {
    for (std::size_t i = 0; i < plan.size(); ++i) {
        plan_.push_back({plan[i], stream(seed, "fault " + std::to_string(i)), false, {}, {}, {}});
    }
    for (std::size_t i = 0; i < q4_count_per_degree_.size(); ++i) {
        const bool inclinometer = i >= static_cast<std::size_t>(hal::AngleChannel::pitch);
        const double range_deg =
            inclinometer ? vehicle.inclinometer_range_deg : vehicle.potentiometer_range_deg;
        q4_count_per_degree_[i] = 65536.0 / (2.0 * range_deg);
    }
}

void FaultInjector::apply(double time_s, hal::RawInputs& inputs) {
    for (Active& active : plan_) {
        const bool on = time_s >= active.fault.from_s && time_s < active.fault.to_s;
        if (!active.started) {
            active.last = inputs;
            std::copy(std::begin(inputs.tach_count), std::end(inputs.tach_count),
                      active.seen.begin());
            active.started = true;
        }
        if (active.fault.channel.group == Group::tachometer) {
            apply_tachometer(active, on, inputs);
        } else if (on && active.fault.channel.group == Group::angle) {
            apply_angle(active, inputs);
        } else if (on) {
            apply_range(active, inputs);
        }
        if (!on) active.last = inputs;
    }
}

void FaultInjector::apply_angle(Active& active, hal::RawInputs& inputs) const {
    const std::size_t index = active.fault.channel.index;
    std::uint16_t& count = inputs.adc_q4_count[index];
    switch (active.fault.kind) {
        case FaultKind::stuck:
            count = active.last.adc_q4_count[index];
            break;
        case FaultKind::dropped:
            if (active.random.uniform() < active.fault.value) count = hal::kAdcAbsent;
            break;
        case FaultKind::offset:
            if (count <= hal::kAdcMaxQ4Count) {
                const double moved =
                    count + std::round(active.fault.value * q4_count_per_degree_[index]);
                count = static_cast<std::uint16_t>(
                    std::clamp(moved, 0.0, static_cast<double>(hal::kAdcMaxQ4Count)));
            }
            break;
        case FaultKind::absent:
            count = hal::kAdcAbsent;
            break;
    }
}

void FaultInjector::apply_tachometer(Active& active, bool on, hal::RawInputs& inputs) {
    for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        if (active.fault.channel.index != kEveryWheel && active.fault.channel.index != wheel)
            continue;
        std::uint16_t& count = inputs.tach_count[wheel];
        const auto pulses =
            static_cast<std::int16_t>(static_cast<std::uint16_t>(count - active.seen[wheel]));
        active.seen[wheel] = count;
        if (on && active.fault.kind == FaultKind::dropped) {
            for (int i = 0; i < std::abs(pulses); ++i) {
                if (active.random.uniform() >= active.fault.value) continue;
                active.lost[wheel] =
                    static_cast<std::uint16_t>(active.lost[wheel] + (pulses > 0 ? 1 : -1));
            }
        }
        count = static_cast<std::uint16_t>(count - active.lost[wheel]);
        if (!on) continue;
        if (active.fault.kind == FaultKind::stuck) {
            count = active.last.tach_count[wheel];
        } else if (active.fault.kind == FaultKind::offset) {
            const auto added = static_cast<std::int32_t>(std::lround(active.fault.value));
            count = static_cast<std::uint16_t>(count + added);
        } else if (active.fault.kind == FaultKind::absent) {
            count = 0;
            inputs.tach_present = static_cast<std::uint8_t>(inputs.tach_present & ~(1u << wheel));
        }
    }
}

void FaultInjector::apply_range(Active& active, hal::RawInputs& inputs) {
    const bool module = active.fault.channel.group == Group::range_module;
    const std::size_t index = active.fault.channel.index;
    const unsigned bit = module ? 0xFFu : 1u << index;
    const auto unseen = static_cast<std::uint8_t>(inputs.range_present & ~bit);
    switch (active.fault.kind) {
        case FaultKind::stuck:
            if (module) {
                copy_range(active.last, inputs);
            } else {
                inputs.range_q1_mm[index] = active.last.range_q1_mm[index];
                inputs.range_present =
                    static_cast<std::uint8_t>(unseen | (active.last.range_present & bit));
            }
            break;
        case FaultKind::dropped: {
            const bool lost = active.random.uniform() < active.fault.value;
            if (!lost) {
                active.last = inputs;
            } else if (module) {
                copy_range(active.last, inputs);
            } else {
                inputs.range_present = unseen;
            }
            break;
        }
        case FaultKind::offset:
            for (std::size_t i = 0; i < hal::kRangeSampleCount; ++i) {
                if (!module && i != index) continue;
                inputs.range_q1_mm[i] = add_sat_q1(inputs.range_q1_mm[i], active.fault.value);
            }
            break;
        case FaultKind::absent:
            inputs.range_present = unseen;
            if (module) inputs.range_scan_count = active.last.range_scan_count;
            break;
    }
}

}  // namespace host_sim
