#include "tools/report/sections.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/report/escape.hpp"
#include "tools/report/names.hpp"

namespace report {
namespace {

std::string section(const char* id, const char* heading, const std::string& body) {
    return fmt::format(
        "<section id=\"{0}\" aria-labelledby=\"{0}-h\">\n<h2 id=\"{0}-h\">{1}</h2>\n"
        "{2}</section>\n",
        id, heading, body);
}

/// A table that scrolls sideways inside its own box rather than widening the page.
std::string table(const std::string& caption, const std::string& head, const std::string& rows) {
    return fmt::format(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\">"
        "<table><caption>{0}</caption><thead><tr>{1}</tr></thead>\n"
        "<tbody>\n{2}</tbody></table></div>\n",
        caption, head, rows);
}

std::string percent_of_share(double share) {
    if (share <= 0) return "never";
    if (share >= 1) return "always";
    if (share > 0.9995) return "over 99.9 %";
    return share < 0.001 ? "under 0.1 %" : fmt::format("{:.1f} %", 100.0 * share);
}

std::string card(const std::string& value, const char* name, const std::string& note) {
    return fmt::format("<div class=\"card\"><dt>{}</dt><dd>{}</dd><p>{}</p></div>\n", name, value,
                       note);
}

std::string signed_text(double value, const std::string& size) {
    return (value < 0 ? "\u2212" : "") + size;
}

std::string alarm_card(const char* name, const AlarmFigures& alarm) {
    std::string note = "never up";
    if (alarm.count != 0) {
        note = "first at " + (alarm.first_place_m ? text_of_distance(*alarm.first_place_m)
                                                  : text_of_duration(*alarm.first_time_s));
    }
    return card(std::to_string(alarm.count), name, note);
}

bool ever_available(const Summary& summary, const char* key) {
    const auto found = summary.available_share.find(key);
    return found != summary.available_share.end() && found->second > 0;
}

std::string position_cards(const Summary& summary) {
    std::string out;
    if (summary.true_distance_m) {
        out +=
            card(signed_text(*summary.true_distance_m, text_of_distance(*summary.true_distance_m)),
                 "True distance", "in " + text_of_duration(summary.duration_s));
    } else if (summary.firmware_distance_m && ever_available(summary, "slip")) {
        out += card(signed_text(*summary.firmware_distance_m,
                                text_of_distance(*summary.firmware_distance_m)),
                    "Driven", "by the firmware\u2019s position");
    }
    if (summary.wheel_distance_m) {
        const std::string note = summary.slip_overall_percent
                                     ? signed_text(*summary.slip_overall_percent,
                                                   text_of_percent(*summary.slip_overall_percent)) +
                                           " overall slip"
                                     : "mean over the wheels";
        out += card(
            signed_text(*summary.wheel_distance_m, text_of_distance(*summary.wheel_distance_m)),
            "Wheels turned", note);
    }
    if (summary.firmware_error_percent && ever_available(summary, "slip")) {
        out += card(text_of_percent(*summary.firmware_error_percent), "Position error",
                    text_of_percent(*summary.wheel_error_percent) + " by plain wheel odometry");
    } else if (summary.wheel_error_percent) {
        out += card(text_of_percent(*summary.wheel_error_percent), "Odometry error",
                    "slip not corrected");
    }
    return out;
}

}  // namespace

std::string summary_section(const Summary& summary) {
    const std::vector<std::string> said = sentences(summary);
    std::string body = "<p class=\"lead\">" + html(said.front()) + "</p>\n";
    if (said.size() > 1) {
        body += "<ul class=\"findings\">\n";
        for (std::size_t index = 1; index < said.size(); ++index) {
            body += "<li>" + html(said[index]) + "</li>\n";
        }
        body += "</ul>\n";
    }
    return section("summary", "In short", body);
}

std::string cards_section(const Summary& summary) {
    std::string cards = position_cards(summary);
    const QuantityFigures& sinkage = summary.sinkage_mm;
    if (sinkage.estimated_greatest) {
        cards += card(fmt::format("{:.0f} mm", *sinkage.estimated_greatest), "Deepest sinkage",
                      sinkage.true_greatest
                          ? fmt::format("estimated; {:.0f} mm true", *sinkage.true_greatest)
                          : "estimated");
    } else if (sinkage.true_greatest) {
        cards += card(fmt::format("{:.0f} mm", *sinkage.true_greatest), "Deepest sinkage", "true");
    }
    if (ever_available(summary, "slip")) cards += alarm_card("Slip alarms", summary.slip_alarm);
    if (ever_available(summary, "sinkage")) {
        cards += alarm_card("Sinkage alarms", summary.sinkage_alarm);
    }
    if (!summary.true_distance_m) {
        const char* plural = summary.step_count == 1 ? "" : "s";
        cards += card(text_of_duration(summary.duration_s), "Duration",
                      fmt::format("{} step{}", text_of_count(summary.step_count), plural));
    }
    return "<dl class=\"cards\" aria-label=\"Key figures\">\n" + cards + "</dl>\n";
}

std::string not_available_section(const Summary& summary) {
    if (summary.not_available.empty()) return {};
    std::string items;
    for (const EstimateName& name : kEstimateNames) {
        const auto share = summary.available_share.find(name.key);
        if (share == summary.available_share.end() || share->second > 0) continue;
        items += fmt::format("<li><strong>{}</strong>: needs {}</li>\n", name.text, name.needs);
    }
    return "<aside class=\"callout\" aria-labelledby=\"absent-h\">\n<h2 id=\"absent-h\">Not "
           "available on this vehicle</h2>\n<p>The firmware never had the sensors for these "
           "estimates in this log, so the page shows none of them.</p>\n<ul>\n" +
           items + "</ul>\n</aside>\n";
}

std::string timeline_section(const std::vector<Lane>& lanes, const Summary& summary) {
    if (lanes.empty() && !summary.has_estimates) return {};
    std::string alt = "Timeline of the estimator mode";
    for (const Lane& lane : lanes) alt += ", " + lane.text;
    std::string keys;
    for (std::size_t mode = 0; mode < kModeCount; ++mode) {
        const auto share = summary.mode_share.find(kModeKeys[mode]);
        if (share == summary.mode_share.end() || share->second <= 0) continue;
        keys += fmt::format("<li><i class=\"swatch mode-{}\"></i>{} <b>{}</b></li>\n",
                            kModeKeys[mode], kModeNames[mode], percent_of_share(share->second));
    }
    const std::string body = fmt::format(
        "<figure><figcaption><h3>Modes, alarms and faults</h3></figcaption>\n"
        "{}<div class=\"chart lanes\" id=\"chart-lanes\" role=\"img\" "
        "aria-label=\"{}\"></div></figure>\n",
        keys.empty() ? ""
                     : "<ul class=\"keys\" aria-label=\"Share of each mode\">\n" + keys + "</ul>\n",
        html(alt));
    return section("timeline", "What happened when", body);
}

std::string charts_section(const std::vector<Chart>& charts) {
    if (charts.empty()) return {};
    std::string body;
    for (const Chart& chart : charts) {
        std::string names;
        for (const Series& series : chart.series) {
            names += (names.empty() ? "" : ", ") + series.name;
        }
        body += fmt::format(
            "<figure><figcaption><h3>{} <span class=\"unit\">({})</span></h3>"
            "<p>{}</p></figcaption>\n<div class=\"legend\" id=\"legend-{}\"></div>\n"
            "<div class=\"chart\" id=\"chart-{}\" role=\"img\" "
            "aria-label=\"Chart: {} in {}: {}\"></div></figure>\n",
            html(chart.title), html(chart.unit), html(chart.caption), chart.id, chart.id,
            html(chart.title), html(chart.unit), html(names));
    }
    return section("charts", "Charts", body);
}

std::string events_section(const std::vector<Span>& spans, std::size_t left_out, const Track& track,
                           const ReportOptions& options) {
    if (spans.empty()) {
        return section("events", "Events", "<p>No alarm, fault or gap in this log.</p>\n");
    }
    const bool has_place = track.source != PlaceSource::none;
    std::string rows;
    for (std::size_t index = 0; index < spans.size(); ++index) {
        const Span& span = spans[index];
        const std::size_t last = std::min(span.end, track.time_s.size() - 1);
        const double lasts_s = track.time_s[last] - track.time_s[span.begin];
        rows += fmt::format(
            "<tr><td><button type=\"button\" class=\"go\" data-event=\"{0}\" "
            "aria-label=\"Show event {1} in the charts\">{1}</button></td>"
            "<td class=\"num\">{2:.1f}</td>{3}<td><i class=\"swatch kind-{4}\"></i>{5}</td>"
            "<td class=\"num\">{6}</td></tr>\n",
            index, index + 1, track.time_s[span.begin],
            has_place ? fmt::format("<td class=\"num\">{:.2f}</td>", track.place_m[span.begin])
                      : "",
            static_cast<int>(span.kind), html(span.text),
            span.open ? "to the end" : fmt::format("{:.1f}", lasts_s));
    }
    std::string note;
    if (left_out != 0) {
        note = fmt::format(
            "<p>{} less important events are left out here{}.</p>\n", left_out,
            options.csv_file.empty() ? "" : "; " + html(options.csv_file) + " has every step");
    }
    const std::string head =
        std::string(
            "<th scope=\"col\">No.</th><th scope=\"col\" class=\"num\">"
            "Up at (s)</th>") +
        (has_place ? "<th scope=\"col\" class=\"num\">Position (m)</th>" : "") +
        "<th scope=\"col\">Event</th>"
        "<th scope=\"col\" class=\"num\">Lasts (s)</th>";
    return section(
        "events", "Events",
        table("Alarms, faults and gaps in the order in which they went up", head, rows) + note);
}

std::string sensors_section(const Summary& summary) {
    std::string rows;
    for (const Sensor& sensor : sensors()) {
        const auto share = summary.sensor_present_share.find(sensor.key);
        if (share == summary.sensor_present_share.end()) continue;
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"num\">{}</td></tr>\n",
                            sensor.text, percent_of_share(share->second));
    }
    if (rows.empty()) return {};
    std::string body = table("Sensors: part of the steps with an answer",
                             "<th scope=\"col\">Sensor</th><th scope=\"col\" class=\"num\">Answers"
                             "</th>",
                             rows);
    rows.clear();
    for (const EstimateName& name : kEstimateNames) {
        const auto share = summary.available_share.find(name.key);
        if (share == summary.available_share.end()) continue;
        rows += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"num\">{}</td></tr>\n",
                            name.text, percent_of_share(share->second));
    }
    if (!rows.empty()) {
        body += table("Estimates: part of the steps in which the firmware could give them",
                      "<th scope=\"col\">Estimate</th><th scope=\"col\" class=\"num\">Available"
                      "</th>",
                      rows);
    }
    return section("sensors", "Sensors and estimates", "<div class=\"pair\">" + body + "</div>\n");
}

std::string provenance_section(const host_sim::Log& log, const Summary& summary,
                               const ReportOptions& options) {
    std::string rows;
    const auto row = [&rows](const std::string& name, const std::string& value) {
        rows += "<tr><th scope=\"row\">" + html(name) + "</th><td>" + html(value) + "</td></tr>\n";
    };
    if (!summary.vehicle.empty()) row("Vehicle", summary.vehicle);
    row("Firmware", log.head.image_identity.empty() ? "none ran" : log.head.image_identity);
    if (!options.command_line.empty()) row("Command", options.command_line);
    if (log.unverified) row("Integrity", "no checksum line in the log: edits go unnoticed");
    for (const auto& [name, value] : log.head.notes) row(name, value);
    std::string body = table("Where this came from",
                             "<th scope=\"col\">Item</th><th scope=\"col\">Value</th>", rows);
    const hal::Calibration& calibration = log.head.calibration;
    rows.clear();
    static constexpr const char* kAngles[] = {"Left bogie", "Right bogie", "Differential", "Pitch",
                                              "Roll"};
    for (unsigned index = 0; index < hal::kAngleChannelCount; ++index) {
        const hal::AngleCalibration& angle = calibration.angle[index];
        row(kAngles[index],
            angle.gain_q16 == 0
                ? "not calibrated"
                : fmt::format("zero at {:.4g} counts, {:.4f}\u00b0 per count{}",
                              angle.zero_q4_count / 16.0, deg_of_brad(angle.gain_q16 / 4096.0),
                              angle.inverted ? ", inverted" : ""));
    }
    row("Wheel radius", fmt::format("{:.1f} mm", mm_of_q4(calibration.wheel_radius_q4_mm)));
    row("Tachometer",
        fmt::format("{} pulses a turn, {:.4f} mm a pulse", calibration.tach_counts_per_turn,
                    calibration.tach_q16_mm_per_count / 65536.0));
    row("Range offset", fmt::format("{:.1f} mm", calibration.range_offset_q1_mm / 2.0));
    body += "<details><summary>Calibration record</summary>\n" +
            table(fmt::format("Calibration record, version {}", calibration.version),
                  "<th scope=\"col\">Item</th><th scope=\"col\">Value</th>", rows) +
            "</details>\n";
    if (!log.head.vehicle.empty()) {
        body += "<details><summary>Vehicle description</summary>\n<pre tabindex=\"0\">" +
                html(log.head.vehicle) + "</pre></details>\n";
    }
    return section("provenance", "Provenance", body);
}

}  // namespace report
