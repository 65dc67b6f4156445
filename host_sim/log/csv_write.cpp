// csv_write.cpp - a log as wide CSV. Cells go through to_chars into a row buffer: formatted streams
// would take most of the time of a simulated traverse.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cmath>
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

void append_rows(std::string& out, const Log& log, std::string_view name) {
    const std::vector<Column> columns = choose_columns(log);
    out += detail::kTimeColumn;
    const bool restarts = std::any_of(log.steps.begin(), log.steps.end(), [](const LogStep& step) {
        return step.restart != Restart::none;
    });
    if (restarts) (out += ',') += detail::kRestartColumn;
    for (const Column& column : columns) (out += ',') += column.field->name;
    out += '\n';
    std::vector<char> row((columns.size() + 2) * kCellSizeMax + 1);
    std::int64_t last_time_ms = -1;
    for (const LogStep& step : log.steps) {
        detail::check_step(step, last_time_ms, name);
        last_time_ms = step.time_ms;
        char* at = std::to_chars(row.data(), row.data() + kCellSizeMax, step.time_ms).ptr;
        if (restarts) {
            *at++ = ',';
            at = std::ranges::copy(detail::restart_names()[static_cast<std::size_t>(step.restart)],
                                   at)
                     .out;
        }
        for (const Column& column : columns) {
            *at++ = ',';
            const std::byte* base = base_of_part(step, column.part);
            if (base != nullptr) at = put_cell(at, *column.field, base);
        }
        *at++ = '\n';
        out.append(row.data(), static_cast<std::size_t>(at - row.data()));
    }
}

std::string encode_named(const Log& log, const CsvOptions& options, std::string_view name) {
    detail::check_head(log.head, name);
    std::string out;
    out.reserve(4096 + log.steps.size() * 384);
    detail::append_csv_head(out, log.head);
    append_rows(out, log, name);
    if (options.checksum) {
        const auto crc = ::crc32_z(0, reinterpret_cast<const Bytef*>(out.data()), out.size());
        out += fmt::format("{}{:08X} rows {}\n", detail::kCsvChecksumPrefix, crc, log.steps.size());
    }
    return out;
}

}  // namespace

std::string encode_csv(const Log& log, const CsvOptions& options) {
    return encode_named(log, options, "log");
}

void write_csv(const std::filesystem::path& path, const Log& log, const CsvOptions& options) {
    detail::write_file(path, encode_named(log, options, path.string()));
}

}  // namespace host_sim
