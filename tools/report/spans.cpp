#include "tools/report/spans.hpp"

#include <algorithm>
#include <cstdint>

#include "tools/report/names.hpp"

namespace report {
namespace {

/// A lane before it is known whether it is ever up.
struct Candidate {
    LaneKind kind;
    std::string text;
};

struct EventLane {
    LaneKind kind;
    const char* text;
    rover::Event bit;
};
constexpr EventLane kEventLanes[] = {
    {LaneKind::slip_alarm, "Slip alarm", rover::kEventSlipAlarm},
    {LaneKind::sinkage_alarm, "Sinkage alarm", rover::kEventSinkageAlarm},
    {LaneKind::lost_lock, "Lost lock", rover::kEventLostLock},
    {LaneKind::tick_gap, "Ticks missing", rover::kEventTickGap},
    {LaneKind::overspeed, "Faster than 0.15 m/s", rover::kEventOverspeed},
};

std::vector<Candidate> candidates() {
    std::vector<Candidate> all;
    for (const EventLane& lane : kEventLanes) all.push_back({lane.kind, lane.text});
    for (const FaultName& fault : kFaultNames) {
        all.push_back({LaneKind::fault, std::string("Fault: ") + fault.text});
    }
    for (const Sensor& sensor : sensors()) {
        all.push_back({LaneKind::absent, "No answer: " + sensor.text});
    }
    return all;
}

/// Bit i: candidate i is up in this step. In the order of candidates().
std::uint32_t mask_of(const host_sim::LogStep& step, const std::vector<Sensor>& all_sensors) {
    const unsigned events = step.estimates ? step.estimates->events : 0u;
    const unsigned faults = step.estimates ? step.estimates->faults : 0u;
    std::uint32_t mask = 0;
    unsigned bit = 0;
    for (const EventLane& lane : kEventLanes) {
        mask |= ((events & lane.bit) != 0 ? 1u : 0u) << bit++;
    }
    for (const FaultName& fault : kFaultNames) {
        mask |= ((faults & fault.bit) != 0 ? 1u : 0u) << bit++;
    }
    for (const Sensor& sensor : all_sensors) {
        mask |= (sensor.present(step.inputs, sensor.index) ? 0u : 1u) << bit++;
    }
    return mask;
}

}  // namespace

std::vector<Lane> lanes_of(const host_sim::Log& log) {
    const std::vector<Sensor>& all_sensors = sensors();
    std::vector<std::uint32_t> masks;
    masks.reserve(log.steps.size());
    std::uint32_t any = 0;
    std::uint32_t always = ~0u;
    for (const host_sim::LogStep& step : log.steps) {
        masks.push_back(mask_of(step, all_sensors));
        any |= masks.back();
        always &= masks.back();
    }
    std::vector<Lane> lanes;
    unsigned bit = 0;
    for (Candidate& candidate : candidates()) {
        const std::uint32_t mask = 1u << bit++;
        const bool can_be_missing =
            candidate.kind == LaneKind::absent || candidate.kind == LaneKind::fault;
        if ((any & mask) == 0 || (can_be_missing && (always & mask) != 0)) continue;
        Lane lane{candidate.kind, std::move(candidate.text), {}};
        lane.up.reserve(masks.size());
        for (const std::uint32_t up : masks) lane.up.push_back((up & mask) != 0 ? 1 : 0);
        lanes.push_back(std::move(lane));
    }
    std::stable_sort(lanes.begin(), lanes.end(),
                     [](const Lane& a, const Lane& b) { return a.kind < b.kind; });
    return lanes;
}

std::vector<Span> spans_of(const std::vector<Lane>& lanes, std::size_t count_max,
                           std::size_t& left_out) {
    std::vector<Span> spans;
    for (const Lane& lane : lanes) {
        const std::size_t count = lane.up.size();
        for (std::size_t row = 0; row < count; ++row) {
            if (lane.up[row] == 0) continue;
            const std::size_t begin = row;
            while (row < count && lane.up[row] != 0) ++row;
            spans.push_back({lane.kind, lane.text, begin, row, row == count});
        }
    }
    left_out = spans.size() > count_max ? spans.size() - count_max : 0;
    if (left_out != 0) {
        std::stable_sort(spans.begin(), spans.end(),
                         [](const Span& a, const Span& b) { return a.kind < b.kind; });
        spans.erase(spans.end() - static_cast<std::ptrdiff_t>(left_out), spans.end());
    }
    std::stable_sort(spans.begin(), spans.end(),
                     [](const Span& a, const Span& b) { return a.begin < b.begin; });
    return spans;
}

}  // namespace report
