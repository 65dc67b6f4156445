#include "tools/report/spans.hpp"

#include <algorithm>

#include "tools/report/names.hpp"

namespace report {
namespace {

template <typename Test>
void add_lane(const host_sim::Log& log, LaneKind kind, std::string key, std::string text, Test test,
              std::vector<Lane>& lanes) {
    Lane lane{kind, std::move(key), std::move(text), {}};
    lane.up.reserve(log.steps.size());
    bool any = false;
    bool all = true;
    for (const host_sim::LogStep& step : log.steps) {
        const bool up = test(step);
        lane.up.push_back(up ? 1 : 0);
        any = any || up;
        all = all && up;
    }
    const bool says_missing = (kind == LaneKind::absent || kind == LaneKind::fault) && all;
    if (any && !says_missing) lanes.push_back(std::move(lane));
}

void add_event_lane(const host_sim::Log& log, LaneKind kind, const char* key, const char* text,
                    rover::Event bit, std::vector<Lane>& lanes) {
    add_lane(
        log, kind, key, text,
        [bit](const host_sim::LogStep& step) {
            return step.estimates && (step.estimates->events & bit) != 0;
        },
        lanes);
}

}  // namespace

std::vector<Lane> lanes_of(const host_sim::Log& log) {
    std::vector<Lane> lanes;
    add_event_lane(log, LaneKind::slip_alarm, "slip_alarm", "Slip alarm", rover::kEventSlipAlarm,
                   lanes);
    add_event_lane(log, LaneKind::sinkage_alarm, "sinkage_alarm", "Sinkage alarm",
                   rover::kEventSinkageAlarm, lanes);
    add_event_lane(log, LaneKind::lost_lock, "lost_lock", "Lost lock", rover::kEventLostLock,
                   lanes);
    for (const FaultName& fault : kFaultNames) {
        add_lane(
            log, LaneKind::fault, fault.key, std::string("Fault: ") + fault.text,
            [bit = fault.bit](const host_sim::LogStep& step) {
                return step.estimates && (step.estimates->faults & bit) != 0;
            },
            lanes);
    }
    for (const Sensor& sensor : sensors()) {
        add_lane(
            log, LaneKind::absent, "absent_" + sensor.key, "No answer: " + sensor.text,
            [&sensor](const host_sim::LogStep& step) {
                return !sensor.present(step.inputs, sensor.index);
            },
            lanes);
    }
    add_event_lane(log, LaneKind::tick_gap, "tick_gap", "Ticks missing", rover::kEventTickGap,
                   lanes);
    add_event_lane(log, LaneKind::overspeed, "overspeed", "Faster than one cycle a step",
                   rover::kEventOverspeed, lanes);
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
