// numeric_table.hpp - strict reader for comma-separated tables of numbers with a known header.
// Depends on   host_sim/log/log_io.hpp (LogError).
// Refuses      another header, a missing or extra field, anything that is not a finite decimal
//              number, an empty line, a last line without its end (a file that was cut short).
// Tests        tests/host_sim/import/numeric_table_test.cpp
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace host_sim {

/// A table in memory, row by row. Every value is finite.
struct NumericTable {
    std::string name;  ///< file name, for messages
    std::size_t column_count = 0;
    std::vector<double> values;  ///< row-major

    [[nodiscard]] std::size_t row_count() const { return values.size() / column_count; }
    [[nodiscard]] double at(std::size_t row, std::size_t column) const {
        return values[row * column_count + column];
    }
    /// 1-based line of a row in the file; the header is line 1.
    [[nodiscard]] static std::size_t line(std::size_t row) { return row + 2; }
};

/// Parses a table. Lines end with LF or CR LF.
/// @param header  the exact first line, without its end
/// @errors  LogError with the line for everything under "Refuses", and for a table without rows
NumericTable parse_numeric_table(std::string_view text, std::string_view name,
                                 std::string_view header);

/// The same from a file. @errors also LogError when the file cannot be read
NumericTable read_numeric_table(const std::filesystem::path& path, std::string_view header);

/// Checks that a column strictly increases, starts in [0, first_max] and never steps by more than
/// `step_max`. @errors LogError with the first line at fault
/// @param unit  for messages: "s", "ms"
void check_time_column(const NumericTable& table, std::size_t column, double first_max,
                       double step_max, std::string_view unit);

/// Checks that |value| <= limit in a whole column. @errors LogError with the first line at fault
void check_magnitude(const NumericTable& table, std::size_t column, double limit,
                     std::string_view what);

}  // namespace host_sim
