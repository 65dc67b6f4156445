// tables.cpp - see tables.hpp.
#include "tools/budget/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace rover_budget {
namespace {

std::string place_text(const StepTime& time) {
    return time.worst_t == 0 ? "" : fmt::format("{} step {}", time.worst.log, time.worst.step);
}

std::vector<std::string> time_row(const Figures& figures, const std::string& name,
                                  const StepTime& time) {
    const double mean = mean_t(figures, time);
    const auto worst = static_cast<double>(time.worst_t);
    return {name,
            fmt::format("{:.0f}", mean),
            fmt::format("{}", time.worst_t),
            ms_text(mean, kClockMhz),
            ms_text(worst, kClockMhz),
            ms_text(mean, kSlowClockMhz),
            ms_text(worst, kSlowClockMhz),
            place_text(time)};
}

const std::vector<std::string> kTimeHead = {"T-states",        "mean",         "worst",
                                            "mean ms",         "worst ms",     "mean ms, 2 MHz",
                                            "worst ms, 2 MHz", "worst seen in"};

Table step_table(const Figures& figures) {
    Table table{"A control step (clock 3.072 MHz; beside it 2.000 MHz)", kTimeHead, {}};
    table.rows.push_back(time_row(figures, "main line", figures.profile.main_line));
    table.rows.push_back(time_row(figures, "interrupts", figures.profile.interrupts));
    return table;
}

Table time_table(const Figures& figures) {
    Table table{"Modules: T-states a step", kTimeHead, {}};
    for (std::size_t i = 0; i < figures.modules.size(); ++i) {
        const ModuleKind kind = figures.modules[i].kind;
        const StepTime& time = figures.profile.modules[i];
        if (kind == ModuleKind::idle || kind == ModuleKind::library || time.total_t == 0) continue;
        table.rows.push_back(time_row(figures, figures.modules[i].name, time));
        if (kind == ModuleKind::boot) {  // once, not in every step
            for (const std::size_t mean : {1U, 3U, 5U}) table.rows.back()[mean] = "once";
        }
    }
    return table;
}

/// Modules whose work is spread over several steps in a row. No rows: there is none.
Table spread_table(const Figures& figures) {
    Table table{"Work spread over successive steps: T-states of all of them together",
                {"T-states", "in a step, worst", "together, worst", "ms", "ms, 2 MHz"},
                {}};
    for (std::size_t i = 0; i < figures.modules.size(); ++i) {
        if (!is_spread(figures, i)) continue;
        const StepTime& time = figures.profile.modules[i];
        const auto together = static_cast<double>(time.worst_run_t);
        table.rows.push_back({figures.modules[i].name, fmt::format("{}", time.worst_t),
                              fmt::format("{}", time.worst_run_t), ms_text(together, kClockMhz),
                              ms_text(together, kSlowClockMhz)});
    }
    return table;
}

Table byte_table(const Figures& figures) {
    Table table{"Modules: bytes", {"bytes", "ROM", "RAM", "stack"}, {}};
    uint32_t rom = 0;
    uint32_t ram = 0;
    for (std::size_t i = 0; i < figures.modules.size(); ++i) {
        const ModuleBytes& bytes = figures.placement.bytes[i];
        rom += bytes.rom;
        ram += bytes.ram;
        if (bytes.rom == 0 && bytes.ram == 0) continue;
        table.rows.push_back({figures.modules[i].name, fmt::format("{}", bytes.rom),
                              fmt::format("{}", bytes.ram), fmt::format("{}", bytes.stack)});
    }
    table.rows.push_back(
        {"frames of all functions, overlaid", "", fmt::format("{}", figures.frame_bytes), ""});
    table.rows.push_back({"stack, deepest possible", "", fmt::format("{}", figures.stack_bytes),
                          fmt::format("{}", figures.stack_bytes)});
    table.rows.push_back(
        {"stack, deepest seen", "", "", fmt::format("{}", figures.profile.stack_bytes)});
    table.rows.push_back(
        {"all", fmt::format("{}", figures.rom_bytes), fmt::format("{}", figures.ram_bytes), ""});
    return table;
}

Table interrupt_table(const Figures& figures) {
    Table table{"Interrupts",
                {"input", "accepted", "share %", "worst T", "worst ms", "worst latency T",
                 "worst latency ms"},
                {}};
    const ProfileFigures& profile = figures.profile;
    const auto share = [&](uint64_t t) {
        const auto all = static_cast<double>(std::max<uint64_t>(profile.total_t, 1));
        return fmt::format("{:.2f}", 100.0 * static_cast<double>(t) / all);
    };
    for (std::size_t i = 0; i < kInterruptInputCount; ++i) {
        const InterruptTime& input = profile.inputs[i];
        if (input.accepted == 0) continue;
        table.rows.push_back({std::string(input_name(static_cast<InterruptInput>(i))),
                              fmt::format("{}", input.accepted), share(input.total_t),
                              fmt::format("{}", input.worst_t),
                              ms_text(static_cast<double>(input.worst_t), kClockMhz),
                              fmt::format("{}", input.worst_latency_t),
                              ms_text(static_cast<double>(input.worst_latency_t), kClockMhz)});
    }
    table.rows.push_back({"all", "", share(profile.interrupts.total_t), "", "", "", ""});
    return table;
}

Table operation_table(const Operations& operations) {
    return {"Elementary operations of a slip-and-sinkage cycle (tools/opcount)",
            {"operations", "mean", "worst"},
            {{"map_grid", fmt::format("{:.0f}", operations.mean()),
              fmt::format("{}", operations.worst)},
             {"the 1994 paper", "of the order of 100", ""}}};
}

Table limit_table(const Review& review) {
    Table table{"Limits", {"limit", "most", "is", ""}, {}};
    for (const Limit& limit : review.limits) {
        const auto value = limit.value(review.numbers);
        table.rows.push_back({limit.what, fmt::format("{}", limit.most),
                              value ? fmt::format("{}", *value) : "not measured",
                              limit.holds(review.numbers) ? "ok" : (value ? "OVER" : "?")});
    }
    return table;
}

Table difference_table(const std::string& title, const std::vector<Difference>& differences) {
    Table table{title, {"number", "before", "now", "difference"}, {}};
    const auto text = [](std::optional<uint64_t> value) {
        return value ? fmt::format("{}", *value) : std::string("none");
    };
    for (const Difference& one : differences) {
        std::string change;
        if (one.before && one.now) {
            change = fmt::format(
                "{:+}", static_cast<int64_t>(*one.now) - static_cast<int64_t>(*one.before));
        }
        table.rows.push_back({one.name, text(one.before), text(one.now), change});
    }
    return table;
}

std::string heading(const Figures& figures) {
    std::string text = figures.identity + "\n" + fmt::format("{} steps", figures.profile.steps);
    const char* between = ": ";
    for (const LogSize& log : figures.logs) {
        text += fmt::format("{}{} {}", between, log.name, log.steps);
        between = ", ";
    }
    return text + "\n";
}

}  // namespace

std::string ms_text(double t_states, double clock_mhz) {
    return fmt::format("{:.3f}", t_states / (1000.0 * clock_mhz));
}

std::vector<Table> tables_of(const Review& review) {
    const Figures& figures = review.figures;
    std::vector<Table> tables = {step_table(figures), time_table(figures)};
    if (Table spread = spread_table(figures); !spread.rows.empty()) {
        tables.push_back(std::move(spread));
    }
    tables.push_back(byte_table(figures));
    tables.push_back(interrupt_table(figures));
    if (figures.operations) tables.push_back(operation_table(*figures.operations));
    tables.push_back(limit_table(review));
    if (!review.against.empty()) {
        tables.push_back(difference_table("Differences from " + review.against, review.since_then));
    }
    if (!review.differences.empty()) {
        tables.push_back(
            difference_table("DIFFERENT from the reviewed numbers", review.differences));
    }
    return tables;
}

std::string console_text(const Review& review) {
    std::string text = heading(review.figures);
    for (const Table& table : tables_of(review)) {
        std::vector<std::size_t> widths;
        for (std::size_t column = 0; column < table.head.size(); ++column) {
            std::size_t width = table.head[column].size();
            for (const auto& row : table.rows) width = std::max(width, row[column].size());
            widths.push_back(width);
        }
        text += "\n" + table.title + "\n";
        const auto put = [&](const std::vector<std::string>& row) {
            std::string line = fmt::format("  {:<{}}", row[0], widths[0]);
            for (std::size_t column = 1; column < row.size(); ++column) {
                line += fmt::format("  {:>{}}", row[column], widths[column]);
            }
            text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
        };
        put(table.head);
        for (const auto& row : table.rows) put(row);
    }
    return text;
}

std::string markdown_text(const Review& review) {
    std::string text = "# Budget\n\n" + heading(review.figures);
    for (const Table& table : tables_of(review)) {
        text += "\n## " + table.title + "\n\n|";
        for (const std::string& cell : table.head) text += " " + cell + " |";
        text += "\n|---|";
        for (std::size_t column = 1; column < table.head.size(); ++column) text += "---:|";
        text += "\n";
        for (const auto& row : table.rows) {
            text += "|";
            for (const std::string& cell : row) text += " " + cell + " |";
            text += "\n";
        }
    }
    return text;
}

}  // namespace rover_budget
