// csv_write.cpp - a log as wide CSV. Cells go through to_chars into a row buffer: formatted streams
// would take most of the time of a simulated traverse.
#include <fmt/format.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

#include "host_sim/log/csv_format.hpp"
#include "host_sim/log/file_io.hpp"
#include "host_sim/log/rlog_format.hpp"

namespace host_sim {
namespace {

using detail::Field;
using detail::FieldType;
using detail::Part;

struct Column {
    const Field* field;
    Part part;
};

constexpr std::size_t kCellSizeMax = 2 * 255 + 1;  ///< the longest: 255 bytes in hexadecimal
constexpr std::string_view kHexDigits = "0123456789abcdef";

const std::byte* base_of_part(const LogStep& step, Part part) {
    switch (part) {
        case Part::truth:
            return step.truth ? detail::base_of(*step.truth) : nullptr;
        case Part::estimate:
            return step.estimates ? detail::base_of(*step.estimates) : nullptr;
        case Part::command:
            return step.commands ? detail::base_of(*step.commands) : nullptr;
        case Part::input:
            break;
    }
    return detail::base_of(step.inputs);
}

/// True where the reader fills in the same value without a cell.
bool is_default(const Field& field, const hal::RawInputs& inputs) {
    const std::byte* base = detail::base_of(inputs);
    if (field.name == "tick_count") return false;  // the reader would derive it from the time
    // Ranges without a scan counter would be refused: nobody could tell fresh from stale.
    if (field.name == "range_scan_count" && inputs.range_present != 0) return false;
    if (field.type == FieldType::bytes) return base[field.mask_offset] == std::byte{0};
    if (field.type == FieldType::adc || field.optional()) return !detail::is_present(field, base);
    return detail::load_integer(field, base) == 0;
}

/// A column is written when some step has something to say in it; truth, estimates and commands
/// bring all their columns.
bool is_needed(const Log& log, const Field& field, Part part) {
    if (field.type == FieldType::presence) return false;
    return std::any_of(log.steps.begin(), log.steps.end(), [&](const LogStep& step) {
        if (part == Part::input) return !is_default(field, step.inputs);
        return base_of_part(step, part) != nullptr;
    });
}

std::vector<Column> choose_columns(const Log& log) {
    std::vector<Column> columns;
    for (const Part part : {Part::input, Part::truth, Part::estimate, Part::command}) {
        for (const Field& field : detail::fields_of(part)) {
            if (is_needed(log, field, part)) columns.push_back({&field, part});
        }
    }
    return columns;
}

char* put_hex(char* out, const Field& field, const std::byte* base) {
    const auto size = std::to_integer<std::size_t>(base[field.mask_offset]);
    for (std::size_t i = 0; i < size; ++i) {
        const auto value = std::to_integer<unsigned>(base[field.offset + i]);
        *out++ = kHexDigits[value >> 4];
        *out++ = kHexDigits[value & 15u];
    }
    return out;
}

char* put_cell(char* out, const Field& field, const std::byte* base) {
    char* const end = out + kCellSizeMax;
    if (field.type == FieldType::bytes) return put_hex(out, field, base);
    if (field.type == FieldType::f64) {
        const double value = detail::load_double(field, base);
        if (std::isnan(value)) return std::copy_n("nan", 3, out);
        return std::to_chars(out, end, value).ptr;
    }
    if (!detail::is_present(field, base)) return out;
    const std::int64_t value = detail::load_integer(field, base);
    if (field.type == FieldType::mode) {
        const std::string_view name = detail::mode_names()[static_cast<std::size_t>(value)];
        return std::copy(name.begin(), name.end(), out);
    }
    return std::to_chars(out, end, value).ptr;
}

/// The header line and rows of one CSV.
class RowWriter {
public:
    RowWriter(std::vector<Column> columns, bool restarts)
        : columns_(std::move(columns)),
          restarts_(restarts),
          row_((columns_.size() + 2) * kCellSizeMax + 1) {}

    void append_header(std::string& out) const {
        out += detail::kTimeColumn;
        if (restarts_) (out += ',') += detail::kRestartColumn;
        for (const Column& column : columns_) (out += ',') += column.field->name;
        out += '\n';
    }

    void append(std::string& out, const LogStep& step, std::string_view name) {
        detail::check_step(step, last_time_ms_, name);
        last_time_ms_ = step.time_ms;
        char* at = std::to_chars(row_.data(), row_.data() + kCellSizeMax, step.time_ms).ptr;
        if (restarts_) {
            *at++ = ',';
            const auto restart = static_cast<std::size_t>(step.restart);
            at = std::ranges::copy(detail::restart_names()[restart], at).out;
        }
        for (const Column& column : columns_) {
            *at++ = ',';
            const std::byte* base = base_of_part(step, column.part);
            if (base != nullptr) at = put_cell(at, *column.field, base);
        }
        *at++ = '\n';
        out.append(row_.data(), static_cast<std::size_t>(at - row_.data()));
    }

private:
    std::vector<Column> columns_;
    bool restarts_;
    std::vector<char> row_;
    std::int64_t last_time_ms_ = -1;
};

bool has_restart(const LogStep& step) {
    return step.restart != Restart::none;
}

unsigned long crc_of(unsigned long before, std::string_view text) {
    return ::crc32_z(before, reinterpret_cast<const Bytef*>(text.data()), text.size());
}

std::string checksum_line(unsigned long crc, std::size_t row_count) {
    return fmt::format("{}{:08X} rows {}\n", detail::kCsvChecksumPrefix, crc, row_count);
}

std::string encode_named(const Log& log, const CsvOptions& options, std::string_view name) {
    detail::check_head(log.head, name);
    std::string out;
    out.reserve(4096 + log.steps.size() * 384);
    detail::append_csv_head(out, log.head);
    RowWriter rows(choose_columns(log), std::ranges::any_of(log.steps, has_restart));
    rows.append_header(out);
    for (const LogStep& step : log.steps) rows.append(out, step, name);
    if (options.checksum) out += checksum_line(crc_of(0, out), log.steps.size());
    return out;
}

}  // namespace

std::string encode_csv(const Log& log, const CsvOptions& options) {
    return encode_named(log, options, "log");
}

void write_csv(const std::filesystem::path& path, const Log& log, const CsvOptions& options) {
    detail::write_file(path, encode_named(log, options, path.string()));
}

// -- Row by row
// ----------------------------------------------------------------------------------

struct EstimatesCsvWriter::File {
    std::filesystem::path path;
    int descriptor = -1;
    RowWriter rows{estimate_columns(), true};
    unsigned long crc = 0;
    std::size_t row_count = 0;

    static std::vector<Column> estimate_columns() {
        Log log;
        log.steps.emplace_back().estimates.emplace();
        return choose_columns(log);
    }

    /// One call of the system for all of it, so that a kill does not cut it.
    void put(std::string_view text) {
        crc = crc_of(crc, text);
        if (detail::write_all(descriptor, text) == text.size()) return;
        detail::fail_system(path, "cannot be written", errno);
    }
};

EstimatesCsvWriter::EstimatesCsvWriter(const std::filesystem::path& path, const LogHead& head)
    : file_(std::make_unique<File>()) {
    file_->path = path;
    detail::check_head(head, path.string());
    std::string text;
    detail::append_csv_head(text, head);
    file_->rows.append_header(text);
    file_->descriptor = detail::open_for_writing(path);
    if (file_->descriptor < 0) detail::fail_system(path, "cannot be written", errno);
    file_->put(text);
}

EstimatesCsvWriter::~EstimatesCsvWriter() {
    try {
        close();
    } catch (const LogError&) {
        // Said in the header: close() is the way to hear of it.
    }
}

void EstimatesCsvWriter::append(const LogStep& step) {
    if (file_->descriptor < 0) {
        throw LogError(file_->path.string(), {}, "step appended after close()",
                       "correct the program that made this log");
    }
    std::string row;
    file_->rows.append(row, step, file_->path.string());
    file_->put(row);
    ++file_->row_count;
}

void EstimatesCsvWriter::close() {
    if (file_->descriptor < 0) return;
    const int descriptor = file_->descriptor;
    const std::string last = checksum_line(file_->crc, file_->row_count);
    file_->descriptor = -1;
    const bool written = detail::write_all(descriptor, last) == last.size();
    const int error = errno;
    if (::close(descriptor) != 0 && written) {
        detail::fail_system(file_->path, "cannot be written", errno);
    }
    if (!written) detail::fail_system(file_->path, "cannot be written", error);
}

}  // namespace host_sim
