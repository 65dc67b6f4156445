// text_file.hpp - reading whole text files and splitting CSV lines, with errors that say where.
// Internal to host_sim/world.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "host_sim/world/input_error.hpp"

namespace host_sim {

/// @errors  InputError when the file cannot be read
std::string read_text_file(const std::string& path);

/// A number that fills the whole field.
/// @return  false when it does not, or is not finite
bool parse_number(std::string_view field, double& value);

std::string_view trimmed(std::string_view text);

/// Rows of a CSV text without quoting, header first. Empty lines are skipped.
class CsvRows {
public:
    /// @errors  InputError when there is no header
    CsvRows(std::string_view text, const std::string& file_name);

    /// @errors  InputError when the header has no such column, or has it twice
    [[nodiscard]] std::size_t column(std::string_view name) const;

    /// Moves to the next row.
    /// @return  false at the end
    /// @errors  InputError when the row has another number of fields than the header
    bool next();

    [[nodiscard]] std::string_view text(std::size_t column) const { return fields_[column]; }
    /// @errors  InputError when the field is not a finite number
    [[nodiscard]] double number(std::size_t column) const;
    [[nodiscard]] InputError wrong(const std::string& what) const;

private:
    bool read_line();

    std::string_view rest_;
    std::string file_;
    std::size_t line_ = 0;
    std::vector<std::string_view> header_;
    std::vector<std::string_view> fields_;
};

}  // namespace host_sim
