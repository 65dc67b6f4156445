// tables.cpp - see tables.hpp.
#include "tools/bounds/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace rover_bounds {
namespace {

constexpr std::size_t kNameWidth = 60;
constexpr std::size_t kSharesShown = 12;

std::string ratio(const BoundRow& row) {
    if (!row.bound || row.observed == 0) return "";
    return fmt::format("{:.2f}",
                       static_cast<double>(*row.bound) / static_cast<double>(row.observed));
}

std::string number(const std::optional<uint64_t>& value) {
    return value ? std::to_string(*value) : "endless";
}

void add_rows(std::string& out, const char* title, const std::vector<BoundRow>& rows) {
    auto to = std::back_inserter(out);
    fmt::format_to(to, "{:<{}} {:>9} {:>9} {:>6}\n", title, kNameWidth, "bound", "observed",
                   "ratio");
    for (const BoundRow& row : rows) {
        const std::string seen = row.observed == 0 ? "-" : std::to_string(row.observed);
        fmt::format_to(to, "{:<{}} {:>9} {:>9} {:>6}\n", row.name.substr(0, kNameWidth), kNameWidth,
                       number(row.bound), seen, ratio(row));
    }
    out += "\n";
}

void add_step(std::string& out, const FlowProgram& program, const Bounds& bounds) {
    std::vector<std::pair<uint16_t, PathShare>> shares(bounds.step.by.begin(),
                                                       bounds.step.by.end());
    std::ranges::sort(shares,
                      [](const auto& a, const auto& b) { return a.second.own_t > b.second.own_t; });
    shares.resize(std::min(shares.size(), kSharesShown));
    auto to = std::back_inserter(out);
    fmt::format_to(to, "{:<{}} {:>9} {:>9}\n", "Longest step: where its T-states are", kNameWidth,
                   "calls", "own T");
    for (const auto& [entry, share] : shares) {
        const bool is_step = entry == program.step().entry;
        const std::string& name = is_step ? program.step().name : program.graph().at(entry).name;
        fmt::format_to(to, "{:<{}} {:>9.0f} {:>9.0f}\n", name.substr(0, kNameWidth), kNameWidth,
                       share.calls, share.own_t);
    }
    out += "\n";
}

void add_stack(std::string& out, const Bounds& bounds, const Observed& observed) {
    auto to = std::back_inserter(out);
    fmt::format_to(to, "{:<{}} {:>9} {:>9}\n", "Stack, bytes", kNameWidth, "disabled", "enabled");
    for (const StackBound::Part& part : bounds.stack.parts) {
        fmt::format_to(to, "{:<{}} {:>9} {:>9}\n", part.name, kNameWidth, part.disabled,
                       part.enabled);
    }
    fmt::format_to(to, "{:<{}} {:>9} {:>9}\n\n", "together: bound, observed", kNameWidth,
                   bounds.stack.with_interrupts, observed.stack_bytes);
    fmt::format_to(to, "{:<{}} {:>9}\n", "Interrupts disabled at most, T-states", kNameWidth, "T");
    for (const DisabledStretch& stretch : bounds.disabled) {
        fmt::format_to(to, "{:<{}} {:>9}\n", stretch.place.substr(0, kNameWidth), kNameWidth,
                       stretch.t);
    }
    out += "\n";
}

void add_deadlines(std::string& out, const Bounds& bounds) {
    constexpr double kPercent = 100;
    auto to = std::back_inserter(out);
    fmt::format_to(to, "{:<22} {:>9} {:>9} {:>9} {:>9}  {}\n", "Deadlines, T-states", "own",
                   "response", "deadline", "margin", "holds");
    for (const Deadline& one : bounds.deadlines) {
        std::string response = "beyond", margin = "-";
        if (one.response_t) {
            response = std::to_string(*one.response_t);
            margin =
                fmt::format("{:.0f} %", kPercent - kPercent * static_cast<double>(*one.response_t) /
                                                       static_cast<double>(one.deadline_t));
        }
        fmt::format_to(to, "{:<22} {:>9} {:>9} {:>9} {:>9}  {}\n", one.what, one.own_t, response,
                       one.deadline_t, margin, one.holds() ? "yes" : "NO");
    }
}

nlohmann::ordered_json rows_json(const std::vector<BoundRow>& rows) {
    auto array = nlohmann::ordered_json::array();
    for (const BoundRow& row : rows) {
        nlohmann::ordered_json one = {{"name", row.name}};
        one["bound_t"] = row.bound ? nlohmann::ordered_json(*row.bound) : nullptr;
        one["observed_t"] = row.observed;
        array.push_back(std::move(one));
    }
    return array;
}

}  // namespace

std::vector<BoundRow> function_rows(const FlowProgram& program, const Bounds& bounds,
                                    const Observed& observed) {
    std::vector<BoundRow> rows;
    for (const auto& [entry, t] : bounds.function_t) {
        const auto seen = observed.function_t.find(entry);
        const uint64_t most = seen == observed.function_t.end() ? 0 : seen->second;
        rows.push_back({program.graph().at(entry).name, t, most});
    }
    return rows;
}

std::vector<BoundRow> task_rows(const Bounds& bounds, const Observed& observed) {
    std::vector<BoundRow> rows = {{"step, main line", bounds.step.t, observed.step_t}};
    for (const auto& [name, t] : bounds.handler_t) {
        const auto seen = observed.handler_t.find(name);
        rows.push_back({name, t, seen == observed.handler_t.end() ? 0 : seen->second});
    }
    return rows;
}

std::string console_text(const FlowProgram& program, const Bounds& bounds,
                         const Observed& observed) {
    std::string out;
    add_rows(out, "Functions, T-states of a call", function_rows(program, bounds, observed));
    add_step(out, program, bounds);
    add_stack(out, bounds, observed);
    add_rows(out, "T-states", task_rows(bounds, observed));
    add_deadlines(out, bounds);
    return out;
}

std::string json_text(const FlowProgram& program, const Bounds& bounds, const Observed& observed) {
    nlohmann::ordered_json deadlines = nlohmann::ordered_json::array();
    for (const Deadline& one : bounds.deadlines) {
        nlohmann::ordered_json row = {{"what", one.what}, {"own_t", one.own_t}};
        row["response_t"] = one.response_t ? nlohmann::ordered_json(*one.response_t) : nullptr;
        row["deadline_t"] = one.deadline_t;
        row["holds"] = one.holds();
        deadlines.push_back(std::move(row));
    }
    const nlohmann::ordered_json document = {
        {"format", "rover85 bounds 1"},
        {"steps_observed", observed.steps},
        {"tasks", rows_json(task_rows(bounds, observed))},
        {"functions", rows_json(function_rows(program, bounds, observed))},
        {"deadlines", std::move(deadlines)},
        {"stack",
         {{"bound_bytes", bounds.stack.with_interrupts}, {"observed_bytes", observed.stack_bytes}}},
        {"numbers", numbers_of(bounds)}};
    return document.dump(2) + "\n";
}

}  // namespace rover_bounds
