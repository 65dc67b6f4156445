// machine.cpp - see machine.hpp.
#include "tools/report/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/report/escape.hpp"

namespace report {
namespace {

using Json = nlohmann::ordered_json;

/// Without decimals that say nothing.
std::string value_text(double value) {
    const bool whole = value >= 100 || value == std::floor(value);
    return whole ? fmt::format("{:.0f}", value) : fmt::format("{:.2f}", value);
}

std::string bar(const MachineBar& bar) {
    const double whole = std::max({bar.value, bar.limit, 1e-9}) * 1.05;
    const bool over = bar.value > bar.limit;
    return fmt::format(
        "<div class=\"machine-bar\"><span>{0}</span><span class=\"machine-track\">"
        "<span class=\"machine-fill{1}\" style=\"width:{2:.1f}%\"></span>"
        "<span class=\"machine-limit\" style=\"left:{3:.1f}%\"></span></span>"
        "<span>{4} of {5} {6}</span></div>\n",
        html(bar.name), over ? " over" : "", 100.0 * bar.value / whole, 100.0 * bar.limit / whole,
        value_text(bar.value), value_text(bar.limit), html(bar.unit));
}

}  // namespace

std::string machine_section(const Machine& machine) {
    std::string out = fmt::format(
        "<section id=\"machine\" aria-labelledby=\"machine-h\">\n"
        "<h2 id=\"machine-h\">The machine</h2>\n"
        "<p>Flown by the image {} on the simulated board, T-state by T-state. The mark on a bar is "
        "what there is room for.</p>\n",
        html(machine.image));
    for (const MachineBar& one : machine.bars) out += bar(one);
    return out + "</section>\n";
}

std::string machine_json(const Machine& machine) {
    Json bars = Json::array();
    for (const MachineBar& one : machine.bars) {
        bars.push_back(
            {{"name", one.name}, {"value", one.value}, {"limit", one.limit}, {"unit", one.unit}});
    }
    const Json document = {{"format", "rover85 machine 1"},
                           {"image", machine.image},
                           {"bars", std::move(bars)},
                           {"main_line_t", machine.main_line_t},
                           {"interrupts_t", machine.interrupts_t}};
    return document.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Machine parse_machine(std::string_view text, std::string_view file) {
    try {
        const auto document = nlohmann::json::parse(text);
        if (document.at("format") != "rover85 machine 1") throw std::runtime_error("its format");
        Machine machine;
        machine.image = document.at("image").get<std::string>();
        machine.main_line_t = document.at("main_line_t").get<std::vector<std::uint32_t>>();
        machine.interrupts_t = document.at("interrupts_t").get<std::vector<std::uint32_t>>();
        for (const auto& one : document.at("bars")) {
            machine.bars.push_back({one.at("name").get<std::string>(),
                                    one.at("value").get<double>(), one.at("limit").get<double>(),
                                    one.at("unit").get<std::string>()});
        }
        return machine;
    } catch (const std::exception& error) {
        throw std::runtime_error(
            fmt::format("{}: is no record of a drive on the board ({}); drive again, or delete it",
                        file, error.what()));
    }
}

}  // namespace report
