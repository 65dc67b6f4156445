// chart_data.cpp - the data of the charts, decimated, as JSON for the page's script.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/report/charts.hpp"
#include "tools/report/decimate.hpp"
#include "tools/report/escape.hpp"
#include "tools/report/names.hpp"

namespace report {
namespace {

using host_sim::Log;
using host_sim::LogStep;

constexpr std::size_t kLaneBuckets = 2000;

/// A number of at most `digits` decimals, or null.
void put(std::string& out, double value, int digits) {
    if (std::isfinite(value)) {
        fmt::format_to(std::back_inserter(out), "{:.{}f}", value, digits);
    } else {
        out += "null";
    }
}

void put_column(std::string& out, const Column& column, const std::vector<std::size_t>& rows,
                int digits) {
    out += '[';
    for (std::size_t index = 0; index < rows.size(); ++index) {
        if (index != 0) out += ',';
        put(out, column[rows[index]], digits);
    }
    out += ']';
}

void put_chart(std::string& out, const Chart& chart, const Track& track, std::size_t rows_max) {
    std::vector<const Column*> columns;
    for (const Series& series : chart.series) {
        columns.push_back(&series.values);
        if (!series.values_by_place.empty()) columns.push_back(&series.values_by_place);
    }
    if (!chart.sigma.empty()) columns.push_back(&chart.sigma);
    const std::vector<std::size_t> rows = keep_rows(columns, track.time_s.size(), rows_max);
    fmt::format_to(std::back_inserter(out),
                   "{{\"id\":{},\"unit\":{},\"digits\":{},\"time\":", script_json(chart.id),
                   script_json(chart.unit), chart.digits);
    put_column(out, track.time_s, rows, 2);
    if (track.source != PlaceSource::none) {
        out += ",\"place\":";
        put_column(out, track.place_m, rows, 4);
    }
    if (!chart.sigma.empty()) {
        out += ",\"sigma\":";
        put_column(out, chart.sigma, rows, chart.digits);
    }
    out += ",\"series\":[";
    for (std::size_t index = 0; index < chart.series.size(); ++index) {
        const Series& series = chart.series[index];
        fmt::format_to(std::back_inserter(out),
                       "{}{{\"name\":{},\"style\":{},\"values\":", index == 0 ? "" : ",",
                       script_json(series.name), script_json(series.style));
        put_column(out, series.values, rows, chart.digits);
        if (!series.values_by_place.empty()) {
            out += ",\"by_place\":";
            put_column(out, series.values_by_place, rows, chart.digits);
        }
        out += '}';
    }
    out += "]}";
}

/// Writes steps [begin, end) as "time from, time to, place from, place to": up to the start of the
/// step after the last, so that neighbours touch.
void put_stretch(std::string& out, const Track& track, std::size_t begin, std::size_t end) {
    const std::size_t last = std::min(end, track.time_s.size() - 1);
    put(out, track.time_s[begin], 2);
    out += ',';
    put(out, track.time_s[last], 2);
    if (track.source == PlaceSource::none) return;
    out += ',';
    put(out, track.place_m[begin], 4);
    out += ',';
    put(out, track.place_m[last], 4);
}

/// A lane of the timeline; `colours[severity - 1]` names the colour of report.css.
void put_lane(std::string& out, const Track& track, const std::string& text,
              const std::vector<signed char>& severity, const char* const* colours) {
    fmt::format_to(std::back_inserter(out), "{{\"text\":{},\"spans\":[", script_json(text));
    bool first = true;
    for (const Run& run : worst_runs(severity, kLaneBuckets)) {
        if (run.value < 1) continue;
        fmt::format_to(std::back_inserter(out), "{}[\"{}\",", first ? "" : ",",
                       colours[run.value - 1]);
        put_stretch(out, track, run.begin, run.end);
        out += ']';
        first = false;
    }
    out += "]}";
}

/// Colour names by LaneKind.
constexpr const char* kKindColours[] = {"slip_alarm", "sinkage_alarm", "lost_lock", "fault",
                                        "absent",     "gap",           "gap"};

/// Modes by how much they deserve to be seen when several share a pixel; severity is index + 1.
constexpr rover::SlipMode kModesBySeverity[kModeCount] = {
    rover::SlipMode::tracking,  rover::SlipMode::odometry_only, rover::SlipMode::turning,
    rover::SlipMode::reversing, rover::SlipMode::reacquiring,   rover::SlipMode::moved};

void put_mode_lane(std::string& out, const Log& log, const Track& track) {
    signed char severity_of_mode[kModeCount];
    const char* keys[kModeCount];
    for (std::size_t rank = 0; rank < kModeCount; ++rank) {
        const auto mode = static_cast<std::size_t>(kModesBySeverity[rank]);
        severity_of_mode[mode] = static_cast<signed char>(rank + 1);
        keys[rank] = kModeKeys[mode];
    }
    std::vector<signed char> severity;
    severity.reserve(log.steps.size());
    for (const LogStep& step : log.steps) {
        const auto mode =
            step.estimates ? static_cast<std::size_t>(step.estimates->mode) : kModeCount;
        severity.push_back(mode < kModeCount ? severity_of_mode[mode] : 0);
    }
    put_lane(out, track, "Estimator mode", severity, keys);
}

}  // namespace

std::string chart_data(const Log& log, const Track& track, const std::vector<Chart>& charts,
                       const std::vector<Lane>& lanes, const std::vector<Span>& spans,
                       const ReportOptions& options) {
    std::string out;
    out.reserve(std::size_t{1} << 21);
    const char* place = track.source == PlaceSource::none       ? ""
                        : track.reverses                        ? "Distance driven"
                        : track.source == PlaceSource::wheels   ? "Wheel travel"
                        : track.source == PlaceSource::firmware ? "Position by the firmware"
                                                                : "Position along the track";
    fmt::format_to(std::back_inserter(out), "{{\"place\":{},\"charts\":[", script_json(place));
    for (std::size_t index = 0; index < charts.size(); ++index) {
        if (index != 0) out += ',';
        put_chart(out, charts[index], track, options.rows_per_chart_max);
    }
    out += "],\"lanes\":[";
    const bool has_estimates =
        std::any_of(log.steps.begin(), log.steps.end(),
                    [](const LogStep& s) { return s.estimates.has_value(); });
    if (has_estimates) put_mode_lane(out, log, track);
    for (std::size_t index = 0; index < lanes.size(); ++index) {
        if (has_estimates || index != 0) out += ',';
        put_lane(out, track, lanes[index].text, lanes[index].up,
                 &kKindColours[static_cast<int>(lanes[index].kind)]);
    }
    out += "],\"events\":[";
    for (std::size_t index = 0; index < spans.size(); ++index) {
        fmt::format_to(std::back_inserter(out), "{}[{},", index == 0 ? "" : ",",
                       static_cast<int>(spans[index].kind));
        put_stretch(out, track, spans[index].begin, spans[index].end);
        out += ']';
    }
    out += "]}";
    return out;
}

}  // namespace report
