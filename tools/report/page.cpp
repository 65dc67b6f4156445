// page.cpp - the page as a whole: head, sections, data and scripts in one text.
#include <fmt/format.h>

#include <cmath>

#include "tools/report/assets.hpp"
#include "tools/report/escape.hpp"
#include "tools/report/report.hpp"
#include "tools/report/sections.hpp"

namespace report {
namespace {

// Nothing may be fetched, submitted or framed; only what is written in the page itself runs.
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:; "
    "base-uri 'none'; form-action 'none'";

// A wheel on a line.
constexpr const char* kIcon =
    "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 16 16'%3E"
    "%3Ccircle cx='8' cy='7' r='5' fill='none' stroke='%230072b2' stroke-width='2.5'/%3E"
    "%3Cpath d='M0 14.5h16' stroke='%23d55e00' stroke-width='2'/%3E%3C/svg%3E";

constexpr const char* kDygraphsLicence =
    "<!-- Charts by dygraphs, copyright 2006-2023 Dan Vanderkam and contributors, MIT licence: "
    "Permission is hereby granted, free of charge, to any person obtaining a copy of this software "
    "and associated documentation files (the \"Software\"), to deal in the Software without "
    "restriction, including without limitation the rights to use, copy, modify, merge, publish, "
    "distribute, sublicense, and/or sell copies of the Software, and to permit persons to whom the "
    "Software is furnished to do so, subject to the following conditions: The above copyright "
    "notice "
    "and this permission notice shall be included in all copies or substantial portions of the "
    "Software. THE SOFTWARE IS PROVIDED \"AS IS\", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR "
    "IMPLIED, "
    "INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR "
    "PURPOSE "
    "AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY "
    "CLAIM, "
    "DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING "
    "FROM, "
    "OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE. -->\n";

std::string head(const ReportOptions& options) {
    std::string out = fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
        "<meta name=\"color-scheme\" content=\"light dark\">\n"
        "<title>{}</title>\n<link rel=\"icon\" href=\"{}\">\n",
        kPolicy, html(options.title), kIcon);
    out += kDygraphsLicence;
    out += "<style>";
    out += assets::dygraphs_css;
    out += assets::report_css;
    out += "</style>\n</head>\n";
    return out;
}

std::string header(const ReportOptions& options, const Summary& summary) {
    std::string line = summary.vehicle.empty() ? "" : html(summary.vehicle);
    if (!summary.image_identity.empty()) {
        line += (line.empty() ? "" : " \u00b7 ") + ("firmware " + html(summary.image_identity));
    }
    return fmt::format("<header>\n<p class=\"brand\">rover85</p>\n<h1>{}</h1>\n{}</header>\n",
                       html(options.title),
                       line.empty() ? "" : "<p class=\"subject\">" + line + "</p>\n");
}

constexpr const char* kToolbar =
    "<div class=\"toolbar\" id=\"toolbar\" hidden>\n"
    "<div role=\"group\" aria-label=\"Horizontal axis\" class=\"switch\">"
    "<button type=\"button\" id=\"by-place\">Position</button>"
    "<button type=\"button\" id=\"by-time\">Time</button></div>\n"
    "<button type=\"button\" id=\"reset\" disabled>Show all</button>\n"
    "<p class=\"hint\">Drag across a chart to zoom all of them; double-click to go back.</p>\n"
    "</div>\n"
    "<noscript><p>The charts need JavaScript; every number in words and tables is here without "
    "it.</p></noscript>\n";

std::string footer(const host_sim::Log& log, const ReportOptions& options) {
    std::string text = "This page is one file and needs no network.";
    if (log.steps.size() > options.rows_per_chart_max) {
        text += fmt::format(
            " Its charts are thinned from {} logged steps to at most about {} drawn "
            "ones each; the lowest and highest value of every stretch, and every "
            "alarm, are kept.",
            text_of_count(log.steps.size()), text_of_count(options.rows_per_chart_max));
        if (!options.csv_file.empty())
            text += fmt::format(" {} has every step.", html(options.csv_file));
    } else if (!log.steps.empty()) {
        text += " Its charts draw every logged step.";
    }
    return fmt::format("<footer><p>{}</p></footer>\n", text);
}

}  // namespace

std::string report_html(const host_sim::Log& log, const ReportOptions& options) {
    const Summary summary = summarize(log);
    const Track track = track_of(log);
    const std::vector<Chart> charts = charts_of(log, track, options);
    const std::vector<Lane> lanes = lanes_of(log);
    std::size_t left_out = 0;
    const std::vector<Span> spans = spans_of(lanes, options.events_max, left_out);

    std::string out;
    out.reserve(std::size_t{3} << 20);
    out += head(options);
    out += "<body>\n";
    out += header(options, summary);
    out += "<main>\n";
    out += summary_section(summary);
    out += cards_section(summary);
    out += not_available_section(summary);
    if (!charts.empty() || !lanes.empty()) out += kToolbar;
    out += timeline_section(lanes, summary);
    out += charts_section(charts);
    if (options.machine) out += machine_section(*options.machine);
    out += events_section(spans, left_out, track, options);
    out += sensors_section(summary);
    out += provenance_section(log, summary, options);
    out += "</main>\n";
    out += footer(log, options);
    out += "<script type=\"application/json\" id=\"report-data\">";
    out += chart_data(log, track, charts, lanes, spans, options);
    out += "</script>\n<script>";
    out += assets::dygraphs_js;
    out += "</script>\n<script>";
    out += assets::report_js;
    out += "</script>\n</body>\n</html>\n";
    return out;
}

}  // namespace report
