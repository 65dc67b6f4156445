// text_file.cpp - whole files, numbers and CSV rows.
#include "host_sim/world/text_file.hpp"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>

namespace host_sim {

std::string read_text_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw InputError(path + ": cannot be opened; check the name and the permissions");
    std::string text;
    try {
        text.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    } catch (const std::ios_base::failure&) {  // a folder, say
        throw InputError(path + ": cannot be read; is it a file?");
    }
    if (file.bad()) throw InputError(path + ": cannot be read; is it a file?");
    return text;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view kBlank = " \t\r\n";
    const std::size_t first = text.find_first_not_of(kBlank);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

bool parse_number(std::string_view field, double& value) {
    field = trimmed(field);
    const auto result = std::from_chars(field.data(), field.data() + field.size(), value);
    return result.ec == std::errc{} && result.ptr == field.data() + field.size() &&
           std::isfinite(value);
}

CsvRows::CsvRows(std::string_view text, const std::string& file_name)
    : rest_(text), file_(file_name) {
    if (!read_line()) throw InputError(file_ + ": is empty; a header line is needed");
    header_ = fields_;
}

bool CsvRows::read_line() {
    while (!rest_.empty()) {
        const std::size_t end = rest_.find('\n');
        std::string_view line = trimmed(rest_.substr(0, end));
        rest_ = end == std::string_view::npos ? std::string_view{} : rest_.substr(end + 1);
        ++line_;
        if (line.empty()) continue;
        fields_.clear();
        for (std::size_t comma = line.find(','); comma != std::string_view::npos;
             comma = line.find(',')) {
            fields_.push_back(trimmed(line.substr(0, comma)));
            line = line.substr(comma + 1);
        }
        fields_.push_back(trimmed(line));
        return true;
    }
    return false;
}

std::size_t CsvRows::column(std::string_view name) const {
    std::size_t found = header_.size();
    for (std::size_t i = 0; i < header_.size(); ++i) {
        if (header_[i] != name) continue;
        if (found != header_.size()) {
            throw input_error(file_, 1, "column '" + std::string(name) + "' appears twice");
        }
        found = i;
    }
    if (found == header_.size()) {
        throw input_error(file_, 1, "column '" + std::string(name) + "' is missing in the header");
    }
    return found;
}

bool CsvRows::next() {
    if (!read_line()) return false;
    if (fields_.size() != header_.size()) {
        throw wrong("has " + std::to_string(fields_.size()) + " fields, the header " +
                    std::to_string(header_.size()));
    }
    return true;
}

double CsvRows::number(std::size_t column) const {
    double value = 0;
    if (!parse_number(fields_[column], value)) {
        throw wrong("'" + std::string(fields_[column]) + "' in column '" +
                    std::string(header_[column]) + "' is not a finite number");
    }
    return value;
}

InputError CsvRows::wrong(const std::string& what) const {
    return input_error(file_, line_, what);
}

}  // namespace host_sim
