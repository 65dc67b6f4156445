// csv_read.cpp - wide CSV to a log: every cell is parsed strictly, nothing is guessed.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <istream>
#include <iterator>
#include <limits>
#include <vector>

#include "host_sim/log/csv_format.hpp"
#include "host_sim/log/log_text.hpp"

namespace host_sim {
namespace {

using detail::Field;
using detail::FieldType;
using detail::kPartCount;
using detail::Part;
using detail::quote;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Truth kNoTruth{kNan, kNan, kNan, kNan, kNan, kNan};
constexpr std::size_t kReserveMax = 100'000;  ///< steps; a rubbish file must not claim memory
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

struct Column {
    const Field* field;
    Part part;
};

/// The one column beside time that is no field of a struct; of a type that no other column has.
constexpr Field kRestartField{detail::kRestartColumn, FieldType::presence, 0};

/// True if an empty cell means something by itself: an absent sensor, an unknown truth, no bytes.
bool may_be_empty(const Column& column) {
    return column.part == Part::truth || column.field == &kRestartField ||
           column.field->type == FieldType::bytes || column.field->type == FieldType::adc ||
           column.field->optional();
}

class CsvReader {
public:
    CsvReader(std::string_view text, std::string_view name)
        : text_(text), name_(name), head_(name) {}
    Log read();

private:
    struct Row {
        std::array<std::byte*, kPartCount> base{};
        std::array<std::size_t, kPartCount> filled{};  ///< cells that are not empty
    };

    [[noreturn]] void fail(std::string_view what, std::string_view advice) const;
    [[noreturn]] void fail_cell(std::string_view column, std::string_view cell,
                                std::string_view why) const;
    void check_bytes();
    bool next_line(std::string_view& line);
    void read_header(std::string_view line);
    void add_column(std::string_view name);
    void check_columns();
    void read_row(std::string_view line, Log& log);
    std::uint32_t read_time(std::string_view cell);
    [[nodiscard]] Restart read_restart(std::string_view cell) const;
    void read_cell(const Column& column, std::string_view cell, Row& row) const;
    void read_double(const Field& field, std::string_view cell, std::byte* base) const;
    void read_integer(const Field& field, std::string_view cell, std::byte* base) const;
    void read_mode(const Field& field, std::string_view cell, std::byte* base) const;
    void read_hex(const Field& field, std::string_view cell, std::byte* base) const;
    void close_row(const Row& row, std::string_view line, LogStep& step) const;
    void check_whole(const Row& row, std::string_view line, Part part) const;
    void verify(std::string_view line, std::size_t covered, std::size_t rows) const;

    std::string_view text_;
    std::string_view name_;
    detail::CsvHeadReader head_;
    std::vector<Column> columns_;
    std::array<std::size_t, kPartCount> column_count_{};
    std::array<std::size_t, kPartCount> required_count_{};
    bool has_tick_ = false;
    std::size_t at_ = 0;
    std::uint64_t line_number_ = 0;
    std::int64_t last_time_ms_ = -1;
};

void CsvReader::fail(std::string_view what, std::string_view advice) const {
    throw LogError(name_, {line_number_}, what, advice);
}

void CsvReader::fail_cell(std::string_view column, std::string_view cell,
                          std::string_view why) const {
    fail(
        fmt::format("column {}: {} {}", column, cell.empty() ? "the empty cell" : quote(cell), why),
        "correct the cell or delete the row");
}

void CsvReader::check_bytes() {
    if (text_.empty())
        throw LogError(name_, {}, "the file is empty", "give an .rlog or a wide CSV");
    const auto line_of = [this](std::size_t at) {
        return 1 + static_cast<std::uint64_t>(std::count(
                       text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    };
    if (const std::size_t nul = text_.find('\0'); nul != std::string_view::npos) {
        line_number_ = line_of(nul);
        fail("a NUL byte: the file is damaged, or is neither an .rlog nor a CSV",
             "copy it again; a spreadsheet must save as CSV UTF-8");
    }
    if (text_.back() != '\n') {
        line_number_ = line_of(text_.size());
        fail("the last line has no end: the file was cut off",
             "delete this line, or copy it again");
    }
    if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
}

bool CsvReader::next_line(std::string_view& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = text_.find('\n', at_);  // there is one: check_bytes saw the last
    line = text_.substr(at_, end - at_);
    if (line.ends_with('\r')) line.remove_suffix(1);
    at_ = end + 1;
    ++line_number_;
    return true;
}

Log CsvReader::read() {
    check_bytes();
    Log log;
    log.unverified = true;
    std::string_view line;
    bool header_found = false;
    while (!header_found && next_line(line)) {
        if (line.starts_with('#')) {
            head_.take(line, line_number_);
        } else {
            read_header(line);
            header_found = true;
        }
    }
    if (!header_found)
        fail("the header line with the column names is missing", detail::kFormatAdvice);
    log.head = head_.head();
    for (std::size_t start = at_; next_line(line); start = at_) {
        if (log.steps.empty()) {
            log.steps.reserve(std::min(text_.size() / (line.size() + 1) + 1, kReserveMax));
        }
        if (!line.starts_with('#')) {
            read_row(line, log);
        } else if (!line.starts_with(detail::kCsvChecksumPrefix)) {
            fail("comment after the header line", "move it to the top of the file");
        } else {
            verify(line, start, log.steps.size());
            log.unverified = false;
            if (next_line(line))
                fail("content after the checksum line", "delete the checksum line");
        }
    }
    return log;
}

void CsvReader::read_header(std::string_view line) {
    const std::string_view first = line.substr(0, line.find(','));
    if (first != detail::kTimeColumn) {
        fail(fmt::format("not a rover85 log: the first column is {} and not {}", quote(first),
                         detail::kTimeColumn),
             first.find_first_of(";\t") != std::string_view::npos ? "separate columns by commas"
                                                                  : detail::kFormatAdvice);
    }
    for (std::size_t at = first.size(); at < line.size();) {
        const std::size_t end = std::min(line.find(',', at + 1), line.size());
        add_column(line.substr(at + 1, end - at - 1));
        at = end;
    }
    check_columns();
}

void CsvReader::add_column(std::string_view name) {
    if (name == detail::kRestartColumn) {
        for (const Column& column : columns_) {
            if (column.field == &kRestartField) {
                fail("column restart appears twice", "delete one of them");
            }
        }
        columns_.push_back({&kRestartField, Part::input});
        return;
    }
    for (const Part part : {Part::input, Part::truth, Part::estimate, Part::command}) {
        for (const Field& field : detail::fields_of(part)) {
            if (field.name != name || field.type == FieldType::presence) continue;
            for (const Column& column : columns_) {
                if (column.field == &field) {
                    fail(fmt::format("column {} appears twice", name), "delete one of them");
                }
            }
            columns_.push_back({&field, part});
            const auto index = static_cast<std::size_t>(part);
            ++column_count_[index];
            if (!may_be_empty(columns_.back())) ++required_count_[index];
            if (name == "tick_count") has_tick_ = true;
            return;
        }
    }
    if (name == detail::kTimeColumn) fail("column time_ms appears twice", "delete one of them");
    fail(fmt::format("unknown column {}", quote(name)),
         "correct its name or delete it; docs/spec/log-format.md lists the columns");
}

void CsvReader::check_columns() {
    const auto has = [this](const Field& wanted) {
        for (const Column& column : columns_) {
            if (column.field == &wanted) return true;
        }
        return false;
    };
    bool range = false;
    bool scan = false;
    for (const Column& column : columns_) {
        if (column.field->name == "range_scan_count")
            scan = true;
        else if (column.field->name.starts_with("range_"))
            range = true;
    }
    if (range && !scan) {
        fail("column range_scan_count is missing: without it fresh ranges look stale",
             "add it: it counts the scans, modulo 256");
    }
    for (const Part part : {Part::estimate, Part::command}) {
        if (column_count_[static_cast<std::size_t>(part)] == 0) continue;
        for (const Field& field : detail::fields_of(part)) {
            if (!has(field)) {
                fail(fmt::format(
                         "column {} is missing: estimates and commands come whole or not at all",
                         field.name),
                     "add it, or delete the others of its kind");
            }
        }
    }
}

std::uint32_t CsvReader::read_time(std::string_view cell) {
    std::uint32_t time_ms = 0;
    const char* end = cell.data() + cell.size();
    const auto [stop, error] = std::from_chars(cell.data(), end, time_ms);
    if (error != std::errc{} || stop != end) {
        fail_cell(detail::kTimeColumn, cell, "is not a whole number in [0, 4294967295]");
    }
    if (time_ms <= last_time_ms_) {
        fail_cell(detail::kTimeColumn, cell,
                  fmt::format("comes after {}: time must increase", last_time_ms_));
    }
    last_time_ms_ = time_ms;
    return time_ms;
}

void CsvReader::read_row(std::string_view line, Log& log) {
    const auto commas = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (commas != columns_.size()) {
        fail(fmt::format("{} cells where the header has {}", commas + 1, columns_.size() + 1),
             "correct or delete the row; decimal points are points, cells are not quoted");
    }
    std::size_t end = std::min(line.find(','), line.size());
    LogStep& step = log.steps.emplace_back();
    step.time_ms = read_time(line.substr(0, end));
    if (!has_tick_) step.inputs.tick_count = static_cast<std::uint16_t>(step.time_ms / 10);
    for (std::uint16_t& channel : step.inputs.adc_q4_count) channel = hal::kAdcAbsent;
    Row row;
    row.base[0] = detail::base_of(step.inputs);
    if (column_count_[1] != 0) row.base[1] = detail::base_of(step.truth.emplace(kNoTruth));
    if (column_count_[2] != 0) row.base[2] = detail::base_of(step.estimates.emplace());
    if (column_count_[3] != 0) row.base[3] = detail::base_of(step.commands.emplace());
    for (const Column& column : columns_) {
        const std::size_t start = end + 1;
        const void* comma = std::memchr(line.data() + start, ',', line.size() - start);
        end = comma == nullptr
                  ? line.size()
                  : static_cast<std::size_t>(static_cast<const char*>(comma) - line.data());
        if (end == start) continue;
        const std::string_view cell = line.substr(start, end - start);
        if (column.field == &kRestartField) {
            step.restart = read_restart(cell);
        } else {
            read_cell(column, cell, row);
        }
    }
    close_row(row, line, step);
}

void CsvReader::read_cell(const Column& column, std::string_view cell, Row& row) const {
    const auto part = static_cast<std::size_t>(column.part);
    const Field& field = *column.field;
    std::byte* base = row.base[part];
    switch (field.type) {
        case FieldType::f64:
            read_double(field, cell, base);
            break;
        case FieldType::bytes:
            return read_hex(field, cell, base);  // counted by its size
        case FieldType::mode:
            read_mode(field, cell, base);
            break;
        default:
            read_integer(field, cell, base);
            break;
    }
    if (column.part != Part::input || !may_be_empty(column)) ++row.filled[part];
}

void CsvReader::read_double(const Field& field, std::string_view cell, std::byte* base) const {
    double value = kNan;
    if (cell != "nan") {
        const char* end = cell.data() + cell.size();
        const auto [stop, error] = std::from_chars(cell.data(), end, value);
        if (error != std::errc{} || stop != end || !std::isfinite(value)) {
            fail_cell(field.name, cell, "is neither a finite number nor nan");
        }
    }
    detail::store_double(field, base, value);
}

void CsvReader::read_integer(const Field& field, std::string_view cell, std::byte* base) const {
    const detail::IntegerRange range = detail::integer_range(field.type);
    std::int64_t value = 0;
    const char* end = cell.data() + cell.size();
    const auto [stop, error] = std::from_chars(cell.data(), end, value);
    if (error != std::errc{} || stop != end || value < range.low || value > range.high) {
        fail_cell(field.name, cell,
                  fmt::format("is not a whole number in [{}, {}]", range.low, range.high));
    }
    detail::store_integer(field, base, value);
    detail::set_present(field, base);
}

void CsvReader::read_mode(const Field& field, std::string_view cell, std::byte* base) const {
    const auto names = detail::mode_names();
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == cell) {
            return detail::store_integer(field, base, static_cast<std::int64_t>(i));
        }
    }
    fail_cell(field.name, cell, "is not a slip mode (odometry_only, tracking, ...)");
}

Restart CsvReader::read_restart(std::string_view cell) const {
    const auto names = detail::restart_names();
    const auto found = std::find(names.begin() + 1, names.end(), cell);
    if (found == names.end()) fail_cell(detail::kRestartColumn, cell, "is not warm or cold");
    return static_cast<Restart>(found - names.begin());
}

void CsvReader::read_hex(const Field& field, std::string_view cell, std::byte* base) const {
    const std::size_t size = cell.size() / 2;
    if (cell.size() % 2 != 0 || size > field.capacity) {
        fail_cell(field.name, cell,
                  fmt::format("has {} hexadecimal digits: an even number up to {} is legal",
                              cell.size(), 2 * field.capacity));
    }
    for (std::size_t i = 0; i < size; ++i) {
        std::uint8_t value = 0;
        const char* end = cell.data() + 2 * i + 2;
        if (std::from_chars(end - 2, end, value, 16).ptr != end) {
            fail_cell(field.name, cell, "holds something else than hexadecimal digits");
        }
        base[field.offset + i] = std::byte{value};
    }
    base[field.mask_offset] = static_cast<std::byte>(size);
}

/// Names the first empty cell of a part that must be whole in this row.
void CsvReader::check_whole(const Row& row, std::string_view line, Part part) const {
    const auto index = static_cast<std::size_t>(part);
    if (row.filled[index] == required_count_[index]) return;
    std::size_t at = line.find(',') + 1;
    for (const Column& column : columns_) {
        const std::size_t end = std::min(line.find(',', at), line.size());
        if (column.part == part && end == at && !may_be_empty(column)) {
            fail_cell(column.field->name, {},
                      part == Part::input ? "must hold a number"
                                          : "has neighbours that are filled: a row has all "
                                            "estimates (all commands) or none");
        }
        at = end + 1;
    }
}

void CsvReader::close_row(const Row& row, std::string_view line, LogStep& step) const {
    check_whole(row, line, Part::input);
    if (row.filled[1] == 0) step.truth.reset();
    if (row.filled[2] == 0) {
        step.estimates.reset();
    } else {
        check_whole(row, line, Part::estimate);
    }
    if (row.filled[3] == 0 && (!step.commands || step.commands->telemetry_size == 0)) {
        step.commands.reset();
    } else {
        check_whole(row, line, Part::command);
    }
}

void CsvReader::verify(std::string_view line, std::size_t covered, std::size_t rows) const {
    auto crc = ::crc32_z(0, nullptr, 0);
    const auto add = [&crc](std::string_view bytes) {
        crc = ::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
    };
    // Carriage returns before line feeds do not count: changed line ends are no damage.
    for (std::string_view rest = text_.substr(0, covered); !rest.empty();) {
        const std::size_t end = rest.find("\r\n");
        add(rest.substr(0, end));
        rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    const std::string expected =
        fmt::format("{}{:08X} rows {}", detail::kCsvChecksumPrefix, crc, rows);
    if (line == expected) return;
    fail(fmt::format("checksum and row count do not match ({}): the file was changed after it was "
                     "written",
                     quote(line.substr(std::min(line.size(), std::size_t{2})))),
         "delete this line if you edited the file by hand, else copy the file again");
}

}  // namespace

Log read_csv(std::string_view text, std::string_view name) {
    return CsvReader(text, name).read();
}

Log read_csv(std::istream& in, std::string_view name) {
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    return read_csv(text, name);
}

}  // namespace host_sim
