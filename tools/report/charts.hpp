// charts.hpp - which charts a log allows, and their data for the page.
// Depends on   columns.hpp, spans.hpp, decimate.hpp.
// Rule         a series without a single known value is left out, and a chart without series too.
#pragma once

#include <string>
#include <vector>

#include "tools/report/columns.hpp"
#include "tools/report/report.hpp"
#include "tools/report/spans.hpp"

namespace report {

/// One line of a chart.
struct Series {
    std::string name;
    std::string style;  ///< a style of report.js: firmware, truth, wheels, ground, ...
    Column values;
    Column values_by_place;  ///< used when the axis is the place; empty: the same as `values`
};

struct Chart {
    std::string id;
    std::string title;
    std::string unit;
    std::string caption;  ///< one or two sentences under the title
    int digits;           ///< decimals of the values
    std::vector<Series> series;
    Column sigma;  ///< one-sigma half width around the first series; empty: none
};

std::vector<Chart> charts_of(const host_sim::Log& log, const Track& track,
                             const ReportOptions& options);

/// What the script of the page needs, as JSON that is safe inside a script element.
std::string chart_data(const host_sim::Log& log, const Track& track,
                       const std::vector<Chart>& charts, const std::vector<Lane>& lanes,
                       const std::vector<Span>& spans, const ReportOptions& options);

}  // namespace report
