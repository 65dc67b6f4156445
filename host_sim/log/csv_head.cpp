// csv_head.cpp - the comment lines at the top of a wide CSV.
#include <fmt/format.h>

#include <charconv>

#include "host_sim/log/csv_format.hpp"
#include "host_sim/log/log_text.hpp"

namespace host_sim::detail {
namespace {

constexpr std::string_view kVehiclePrefix = "# vehicle:";
constexpr std::string_view kCalibrationPrefix = "calibration.";
constexpr std::string_view kNotePrefix = "note.";

void append_setting(std::string& out, std::string_view key, std::string_view value) {
    out += fmt::format("# {} ={}{}\n", key, value.empty() ? "" : " ", value);
}

std::string_view trim(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

void append_csv_head(std::string& out, const LogHead& head) {
    out += fmt::format("{}{}\n", kCsvVersionPrefix, kCsvVersion);
    if (!head.image_identity.empty()) append_setting(out, "image", escape(head.image_identity));
    for (const Field& field : calibration_fields()) {
        const std::int64_t value = load_integer(field, base_of(head.calibration));
        const std::string key = fmt::format("{}{}", kCalibrationPrefix, field.name);
        if (field.type == FieldType::boolean) {
            append_setting(out, key, value != 0 ? "true" : "false");
        } else {
            append_setting(out, key, fmt::format("{}", value));
        }
    }
    for (const auto& [key, value] : head.notes) {
        append_setting(out, fmt::format("{}{}", kNotePrefix, key), escape(value));
    }
    if (head.vehicle.empty()) return;
    // n line feeds make n + 1 lines, so a final line feed shows as a last empty line.
    for (std::string_view rest = head.vehicle;;) {
        const std::size_t end = rest.find('\n');
        const std::string line = escape_line(rest.substr(0, end));
        out += fmt::format("{}{}{}\n", kVehiclePrefix, line.empty() ? "" : " ", line);
        if (end == std::string_view::npos) return;
        rest.remove_prefix(end + 1);
    }
}

void CsvHeadReader::fail(std::string_view what, std::string_view advice) const {
    throw LogError(name_, {line_number_}, what, advice);
}

std::string CsvHeadReader::text_of(std::string_view escaped) const {
    std::optional<std::string> text = unescape(escaped);
    if (!text) {
        fail(fmt::format("unknown escape in {}", quote(escaped)),
             "write a backslash as \\\\, control characters as \\n, \\r, \\t or \\x1F");
    }
    const std::string_view fault = text_fault(*text);
    if (!fault.empty()) fail(fmt::format("text {}", fault), "save the file as UTF-8");
    return std::move(*text);
}

void CsvHeadReader::take(std::string_view line, std::uint64_t line_number) {
    line_number_ = line_number;
    if (line.starts_with("##")) return;
    if (line.starts_with(kCsvVersionPrefix)) {
        return take_version(line.substr(kCsvVersionPrefix.size()));
    }
    if (line.starts_with(kVehiclePrefix)) return take_vehicle(line.substr(kVehiclePrefix.size()));
    if (line.starts_with(kCsvChecksumPrefix)) {
        fail("checksum line before the header line", "delete it, it belongs at the end");
    }
    const std::size_t equals = line.find('=');
    if (!line.starts_with("# ") || equals == std::string_view::npos) {
        fail(fmt::format("unknown metadata {}", quote(line)),
             "write `# note.NAME = TEXT`, or start a free comment with ##");
    }
    take_setting(trim(line.substr(2, equals - 2)), trim(line.substr(equals + 1)));
}

void CsvHeadReader::take_version(std::string_view version) {
    if (line_number_ != 1) fail("`# rover85-log` is not the first line", "keep one log per file");
    if (version != kCsvVersion) {
        fail(fmt::format("format version {}, this program reads {}", quote(version), kCsvVersion),
             "use the rover85 that wrote it");
    }
}

void CsvHeadReader::take_vehicle(std::string_view text) {
    if (text.starts_with(' ')) text.remove_prefix(1);
    if (has_vehicle_) head_.vehicle += '\n';
    has_vehicle_ = true;
    head_.vehicle += text_of(text);
}

void CsvHeadReader::take_setting(std::string_view key, std::string_view value) {
    if (!seen_.emplace(key).second) {
        fail(fmt::format("{} is given twice", quote(key)), "keep one of them");
    }
    if (key == "image") {
        head_.image_identity = text_of(value);
    } else if (key.starts_with(kCalibrationPrefix)) {
        take_calibration(key.substr(kCalibrationPrefix.size()), value);
    } else if (key.starts_with(kNotePrefix) && is_note_name(key.substr(kNotePrefix.size()))) {
        head_.notes.emplace(key.substr(kNotePrefix.size()), text_of(value));
    } else {
        fail(fmt::format("unknown metadata {}", quote(key)),
             "write `# note.NAME = TEXT` with a NAME of 1 to 64 of A-Z a-z 0-9 _ . -, or start a "
             "free comment with ##");
    }
}

void CsvHeadReader::take_calibration(std::string_view key, std::string_view value) {
    for (const Field& field : calibration_fields()) {
        if (field.name != key) continue;
        std::int64_t number = 0;
        if (field.type == FieldType::boolean) {
            if (value != "true" && value != "false") {
                fail(
                    fmt::format("calibration.{} = {} is neither true nor false", key, quote(value)),
                    "correct the value");
            }
            number = value == "true" ? 1 : 0;
        } else {
            const IntegerRange range = integer_range(field.type);
            const char* end = value.data() + value.size();
            const auto [stop, error] = std::from_chars(value.data(), end, number);
            if (error != std::errc{} || stop != end || number < range.low || number > range.high) {
                fail(fmt::format("calibration.{} = {} is not a whole number in [{}, {}]", key,
                                 quote(value), range.low, range.high),
                     "correct the value");
            }
        }
        store_integer(field, base_of(head_.calibration), number);
        return;
    }
    fail(fmt::format("unknown calibration value {}", quote(key)), kFormatAdvice);
}

}  // namespace host_sim::detail
