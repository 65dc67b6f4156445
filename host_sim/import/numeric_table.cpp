#include "host_sim/import/numeric_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>

#include "host_sim/log/log_io.hpp"

namespace host_sim {
namespace {

[[noreturn]] void refuse(std::string_view name, std::size_t line, std::string_view what,
                         std::string_view advice) {
    throw LogError(name, {.line = line}, what, advice);
}

/// Takes the next line off `text`, without its end.
std::string_view take_line(std::string_view& text, std::string_view name, std::size_t line) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) {
        refuse(name, line, "the last line has no end: the file was cut short",
               "fetch the file again");
    }
    std::string_view taken = text.substr(0, end);
    text.remove_prefix(end + 1);
    if (taken.ends_with('\r')) taken.remove_suffix(1);
    return taken;
}

double parse_field(std::string_view field, std::string_view name, std::size_t line,
                   std::size_t column) {
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value)) {
        refuse(name, line,
               fmt::format("field {} is not a finite number: '{:.40}'", column + 1, field),
               "repair or drop the run");
    }
    return value;
}

void parse_row(std::string_view row, NumericTable& table, std::size_t line) {
    const auto fields = static_cast<std::size_t>(std::ranges::count(row, ',')) + 1;
    if (fields != table.column_count) {
        refuse(table.name, line,
               fmt::format("the row has {} fields, the header {}", fields, table.column_count),
               "repair or drop the run");
    }
    for (std::size_t column = 0; column < fields; ++column) {
        const std::size_t comma = std::min(row.find(','), row.size());
        table.values.push_back(parse_field(row.substr(0, comma), table.name, line, column));
        row.remove_prefix(std::min(comma + 1, row.size()));
    }
}

}  // namespace

NumericTable parse_numeric_table(std::string_view text, std::string_view name,
                                 std::string_view header) {
    NumericTable table;
    table.name = name;
    table.column_count = static_cast<std::size_t>(std::ranges::count(header, ',')) + 1;
    const std::string_view found = take_line(text, name, 1);
    if (found != header) {
        refuse(name, 1, fmt::format("header is '{:.60}', not '{:.60}'", found, header),
               "give the file of this data set that has these columns");
    }
    for (std::size_t line = 2; !text.empty(); ++line) {
        parse_row(take_line(text, name, line), table, line);
    }
    if (table.values.empty()) refuse(name, 2, "no rows after the header", "give a whole run");
    return table;
}

NumericTable read_numeric_table(const std::filesystem::path& path, std::string_view header) {
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw LogError(path.string(), {}, "cannot be read", "check the path");
    return parse_numeric_table(text, path.string(), header);
}

void check_time_column(const NumericTable& table, std::size_t column, double first_max,
                       double step_max, std::string_view unit) {
    const double first = table.at(0, column);
    if (first < 0 || first > first_max) {
        refuse(table.name, NumericTable::line(0),
               fmt::format("time starts at {} {}, outside [0, {}]", first, unit, first_max),
               "give the run from its start");
    }
    for (std::size_t row = 1; row < table.row_count(); ++row) {
        const double step = table.at(row, column) - table.at(row - 1, column);
        if (step <= 0) {
            refuse(table.name, NumericTable::line(row), "time does not increase",
                   "rows are doubled or out of order: fetch the file again");
        }
        if (step > step_max) {
            refuse(table.name, NumericTable::line(row),
                   fmt::format("{:.4g} {} since the row before, at most {} expected", step, unit,
                               step_max),
                   "rows are missing: drop the run or cut it here");
        }
    }
}

void check_magnitude(const NumericTable& table, std::size_t column, double limit,
                     std::string_view what) {
    for (std::size_t row = 0; row < table.row_count(); ++row) {
        if (std::abs(table.at(row, column)) > limit) {
            refuse(table.name, NumericTable::line(row),
                   fmt::format("{} {} is beyond +-{}", what, table.at(row, column), limit),
                   "repair or drop the run");
        }
    }
}

}  // namespace host_sim
