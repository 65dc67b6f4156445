// documents.cpp - see documents.hpp.
#include "tools/budget/documents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "hal/board/rb85.hpp"
#include "tools/report/escape.hpp"

namespace rover_budget {
namespace {

using Json = nlohmann::ordered_json;
const auto escape_html = report::html;

Json module_json(const Review& review, std::size_t index) {
    const Figures& figures = review.figures;
    const Module& module = figures.modules[index];
    const ModuleBytes& bytes = figures.placement.bytes[index];
    const StepTime& time = figures.profile.modules[index];
    const auto reviewed = review.reviewed.find("module." + module.name + ".t_states_worst");
    Json budget = nullptr;
    if (reviewed != review.reviewed.end()) budget = reviewed->second;
    return {{"name", module.name},
            {"kind", kind_name(module.kind)},
            {"rom_bytes", bytes.rom},
            {"ram_bytes", bytes.ram},
            {"stack_bytes", bytes.stack},
            {"t_states_mean", mean_t(figures, time)},
            {"t_states_worst", time.worst_t},
            {"steps", time.steps},
            {"worst_log", time.worst.log},
            {"worst_step", time.worst.step},
            {"budget_t_states", budget}};
}

Json interrupts_json(const ProfileFigures& profile) {
    Json inputs = Json::array();
    for (std::size_t i = 0; i < kInterruptInputCount; ++i) {
        const InterruptTime& input = profile.inputs[i];
        if (input.accepted == 0) continue;
        inputs.push_back({{"name", input_name(static_cast<InterruptInput>(i))},
                          {"accepted", input.accepted},
                          {"t_states_total", input.total_t},
                          {"t_states_worst", input.worst_t},
                          {"latency_worst", input.worst_latency_t}});
    }
    return inputs;
}

Json limits_json(const Review& review) {
    Json limits = Json::array();
    for (const Limit& limit : review.limits) {
        Json value = nullptr;
        if (const auto now = limit.value(review.numbers)) value = *now;
        limits.push_back({{"what", limit.what},
                          {"number", limit.number},
                          {"most", limit.most},
                          {"value", value},
                          {"holds", limit.holds(review.numbers)}});
    }
    return limits;
}

constexpr const char* kStyle = R"(
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 66rem; padding: 0 1rem;
       color: #1c2126; background: #fff; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin-top: 2rem; }
table { border-collapse: collapse; } td, th { padding: .15rem .7rem; text-align: right; }
td:first-child, th:first-child { text-align: left; } tr:nth-child(even) { background: #f3f5f7; }
.bar { display: grid; grid-template-columns: 16rem 1fr 12rem; gap: .6rem; margin: .2rem 0; }
.track { background: #e6eaee; height: 1.1rem; position: relative; }
.fill { background: #2f6f9f; height: 100%; } .over { background: #b3402a; }
.mark { position: absolute; top: -2px; bottom: -2px; width: 2px; background: #1c2126; }
@media (prefers-color-scheme: dark) { body { color: #dfe4e8; background: #15191d; }
 tr:nth-child(even) { background: #1d2328; } .track { background: #2a3138; }
 .mark { background: #dfe4e8; } }
)";

/// One bar; the mark is the limit, if there is one.
std::string bar(const std::string& name, uint64_t value, uint64_t whole, uint64_t limit,
                const std::string& text) {
    const auto share = [whole](uint64_t part) {
        const auto all = static_cast<double>(std::max<uint64_t>(whole, 1));
        return std::min(100.0, 100.0 * static_cast<double>(part) / all);
    };
    const char* over = limit != 0 && value > limit ? " over" : "";
    const std::string mark =
        limit == 0 ? ""
                   : fmt::format("<div class=\"mark\" style=\"left:{:.2f}%\"></div>", share(limit));
    return fmt::format(
        "<div class=\"bar\"><span>{}</span><div class=\"track\"><div class=\"fill{}\" "
        "style=\"width:{:.2f}%\"></div>{}</div><span>{}</span></div>\n",
        escape_html(name), over, share(value), mark, escape_html(text));
}

std::string limit_bars(const Review& review) {
    std::string html = "<h2>Against the limits</h2>\n";
    for (const Limit& limit : review.limits) {
        const auto value = limit.value(review.numbers);
        const uint64_t whole = std::max(limit.most, value.value_or(0)) * 21 / 20;
        html +=
            bar(limit.what, value.value_or(0), whole, limit.most,
                value ? fmt::format("{} of {}", *value, limit.most) : std::string("not measured"));
    }
    return html;
}

std::string module_bars(const Figures& figures) {
    uint64_t worst = 0;
    uint64_t rom = 0;
    const auto timed = [&](std::size_t i) {
        const ModuleKind kind = figures.modules[i].kind;
        return kind == ModuleKind::step || kind == ModuleKind::interrupt;
    };
    for (std::size_t i = 0; i < figures.modules.size(); ++i) {
        if (timed(i)) worst = std::max(worst, figures.profile.modules[i].worst_t);
        rom = std::max<uint64_t>(rom, figures.placement.bytes[i].rom);
    }
    std::string time = "<h2>Worst T-states a step</h2>\n";
    std::string bytes = "<h2>ROM</h2>\n";
    for (std::size_t i = 0; i < figures.modules.size(); ++i) {
        const StepTime& taken = figures.profile.modules[i];
        const uint32_t size = figures.placement.bytes[i].rom;
        if (timed(i) && taken.worst_t != 0) {
            time += bar(figures.modules[i].name, taken.worst_t, worst, 0,
                        fmt::format("{} T", taken.worst_t));
        }
        if (size != 0) bytes += bar(figures.modules[i].name, size, rom, 0, fmt::format("{}", size));
    }
    return time + bytes;
}

std::string table_html(const Table& table) {
    std::string html = "<h2>" + escape_html(table.title) + "</h2>\n<table><tr>";
    for (const std::string& cell : table.head) html += "<th>" + escape_html(cell) + "</th>";
    html += "</tr>\n";
    for (const auto& row : table.rows) {
        html += "<tr>";
        for (const std::string& cell : row) html += "<td>" + escape_html(cell) + "</td>";
        html += "</tr>\n";
    }
    return html + "</table>\n";
}

}  // namespace

std::string json_text(const Review& review) {
    const Figures& figures = review.figures;
    Json logs = Json::array();
    for (const LogSize& log : figures.logs)
        logs.push_back({{"name", log.name}, {"steps", log.steps}});
    Json modules = Json::array();
    for (std::size_t i = 0; i < figures.modules.size(); ++i)
        modules.push_back(module_json(review, i));
    const StepTime& main_line = figures.profile.main_line;
    const Json document = {{"format", "rover85 budget 1"},
                           {"image", figures.identity},
                           {"clock_hz", hal::rb85::kClockHz},
                           {"rom_bytes", figures.rom_bytes},
                           {"ram_bytes", figures.ram_bytes},
                           {"stack_bytes", figures.stack_bytes},
                           {"logs", std::move(logs)},
                           {"steps", figures.profile.steps},
                           {"step",
                            {{"t_states_mean", mean_t(figures, main_line)},
                             {"t_states_worst", main_line.worst_t},
                             {"worst_log", main_line.worst.log},
                             {"worst_step", main_line.worst.step}}},
                           {"modules", std::move(modules)},
                           {"interrupts", interrupts_json(figures.profile)},
                           {"limits", limits_json(review)},
                           {"numbers", review.numbers}};
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string html_text(const Review& review) {
    std::string html =
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
        "<meta name=\"viewport\" content=\"width=device-width\">\n<title>rover85 budget</title>\n"
        "<style>" +
        std::string(kStyle) + "</style></head><body>\n<h1>Budget of the image</h1>\n<p>" +
        escape_html(review.figures.identity) +
        fmt::format("; {} steps</p>\n", review.figures.profile.steps);
    html += limit_bars(review) + module_bars(review.figures);
    for (const Table& table : tables_of(review)) html += table_html(table);
    return html + "</body></html>\n";
}

}  // namespace rover_budget
