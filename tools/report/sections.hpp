// sections.hpp - the parts of the page, each as HTML text. Every string of a log passes html().
// Depends on   summary.hpp, charts.hpp, spans.hpp.
#pragma once

#include <string>
#include <vector>

#include "tools/report/charts.hpp"
#include "tools/report/spans.hpp"
#include "tools/report/summary.hpp"

namespace report {

std::string summary_section(const Summary& summary);
std::string cards_section(const Summary& summary);

/// What this vehicle's sensors do not allow; empty when nothing is missing.
std::string not_available_section(const Summary& summary);

std::string timeline_section(const std::vector<Lane>& lanes, const Summary& summary);
std::string charts_section(const std::vector<Chart>& charts);
std::string events_section(const std::vector<Span>& spans, std::size_t left_out, const Track& track,
                           const ReportOptions& options);
std::string sensors_section(const Summary& summary);
std::string provenance_section(const host_sim::Log& log, const Summary& summary,
                               const ReportOptions& options);

}  // namespace report
