// call_profile_report.cpp - a profile as a table and as JSON.
#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "host_sim/trace/call_profile.hpp"

namespace host_sim {
namespace {

double percent(uint64_t part, uint64_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::string profile_text(const ProfileReport& report) {
    std::string text;
    const auto put = std::back_inserter(text);
    fmt::format_to(put, "{} T-states: {:.1f} % in interrupts, {:.1f} % in HALT\n\n", report.total_t,
                   percent(report.interrupt_t, report.total_t),
                   percent(report.halt_t, report.total_t));
    fmt::format_to(put, "{:>14} {:>6} {:>14} {:>10} {:>12} {:>12} {:>14}  {}\n", "exclusive T", "%",
                   "inclusive T", "calls", "mean T", "worst T", "in interrupts", "function");
    for (const FunctionProfile& function : report.functions) {
        fmt::format_to(put, "{:>14} {:>6.1f} {:>14} {:>10} {:>12.1f} {:>12} {:>14}  {}\n",
                       function.exclusive_t, percent(function.exclusive_t, report.total_t),
                       function.inclusive_t, function.calls, function.mean_t(), function.worst_t,
                       function.exclusive_interrupt_t, function.name);
    }
    if (report.interrupts.empty()) return text;
    fmt::format_to(put, "\n{:>14} {:>6} {:>14} {:>12}  {}\n", "T", "%", "accepted", "worst T",
                   "interrupt");
    for (const InterruptProfile& input : report.interrupts) {
        fmt::format_to(put, "{:>14} {:>6.1f} {:>14} {:>12}  {}\n", input.total_t,
                       percent(input.total_t, report.total_t), input.accepted, input.worst_t,
                       input.name);
    }
    return text;
}

std::string profile_json(const ProfileReport& report) {
    nlohmann::ordered_json functions = nlohmann::ordered_json::array();
    for (const FunctionProfile& function : report.functions) {
        functions.push_back({{"name", function.name},
                             {"address", function.address},
                             {"calls", function.calls},
                             {"exclusive_t", function.exclusive_t},
                             {"exclusive_interrupt_t", function.exclusive_interrupt_t},
                             {"inclusive_t", function.inclusive_t},
                             {"completed", function.completed},
                             {"mean_t", function.mean_t()},
                             {"worst_t", function.worst_t}});
    }
    nlohmann::ordered_json interrupts = nlohmann::ordered_json::array();
    for (const InterruptProfile& input : report.interrupts) {
        interrupts.push_back({{"name", input.name},
                              {"accepted", input.accepted},
                              {"total_t", input.total_t},
                              {"completed", input.completed},
                              {"worst_t", input.worst_t}});
    }
    const nlohmann::ordered_json document = {
        {"format", "rover85 profile 1"},     {"total_t", report.total_t},
        {"halt_t", report.halt_t},           {"interrupt_t", report.interrupt_t},
        {"functions", std::move(functions)}, {"interrupts", std::move(interrupts)}};
    // A name that is not UTF-8 is shown with replacement characters instead of refused.
    return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace host_sim
