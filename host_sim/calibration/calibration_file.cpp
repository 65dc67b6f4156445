#include "host_sim/calibration/calibration_file.hpp"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <set>
#include <system_error>

#include "host_sim/log/log_io.hpp"

namespace host_sim {
namespace {

constexpr std::string_view kFormat = "rover85-calibration";
constexpr std::string_view kAdvice = "see docs/spec/calibration.md";

/// Reads one table strictly: every key asked for must be there, every other key is refused.
class Section {
public:
    Section(const toml::table& table, std::string path, std::string_view file)
        : table_(table), path_(std::move(path)), file_(file) {}

    [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t low, std::int64_t high) {
        const toml::node& node = find(key);
        const auto value = node.as_integer();
        if (value == nullptr) refuse(node, fmt::format("{} is not an integer", full(key)));
        if (value->get() < low || value->get() > high) {
            refuse(node,
                   fmt::format("{} = {} is outside [{}, {}]", full(key), value->get(), low, high));
        }
        return value->get();
    }

    [[nodiscard]] bool boolean(std::string_view key) {
        const toml::node& node = find(key);
        if (!node.is_boolean()) refuse(node, fmt::format("{} is not true or false", full(key)));
        return node.as_boolean()->get();
    }

    void constant(std::string_view key, std::string_view expected) {
        const toml::node& node = find(key);
        if (!node.is_string() || node.as_string()->get() != expected) {
            refuse(node, fmt::format("{} is not \"{}\"", full(key), expected));
        }
    }

    [[nodiscard]] Section section(std::string_view key) {
        const toml::node& node = find(key);
        if (!node.is_table()) refuse(node, fmt::format("{} is not a table", full(key)));
        return {*node.as_table(), full(key), file_};
    }

    /// Call after everything has been asked for.
    void refuse_unknown_keys() const {
        for (const auto& [key, node] : table_) {
            if (!asked_.contains(key.str())) {
                refuse(node, fmt::format("{} is not a key of this format", full(key.str())));
            }
        }
    }

    [[noreturn]] void refuse(const toml::node& node, std::string_view what) const {
        throw LogError(file_, {.line = node.source().begin.line}, what, kAdvice);
    }
    [[nodiscard]] const toml::table& table() const { return table_; }

private:
    const toml::node& find(std::string_view key) {
        asked_.insert(std::string(key));
        const toml::node* node = table_.get(key);
        if (node == nullptr) refuse(table_, fmt::format("{} is missing", full(key)));
        return *node;
    }
    [[nodiscard]] std::string full(std::string_view key) const {
        return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
    }

    const toml::table& table_;
    std::string path_;
    std::string_view file_;
    std::set<std::string, std::less<>> asked_;
};

toml::table parse_toml(std::string_view text, std::string_view name) {
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& error) {
        throw LogError(name, {.line = error.source().begin.line}, error.description(), kAdvice);
    }
}

void read_wheel(Section wheel, hal::Calibration& record) {
    record.wheel_radius_q4_mm = static_cast<std::uint16_t>(wheel.integer("radius_q4_mm", 1, 65535));
    record.tach_counts_per_turn =
        static_cast<std::uint16_t>(wheel.integer("tach_counts_per_turn", 1, 65535));
    record.tach_q16_mm_per_count =
        static_cast<std::uint16_t>(wheel.integer("tach_q16_mm_per_count", 1, 65535));
    wheel.refuse_unknown_keys();
    const double mm_per_count =
        2 * std::numbers::pi * record.wheel_radius_q4_mm / 16 / record.tach_counts_per_turn;
    const double stated_mm_per_count = record.tach_q16_mm_per_count / 65536.0;
    if (std::abs(stated_mm_per_count / mm_per_count - 1) > 0.01) {
        wheel.refuse(wheel.table(),
                     fmt::format("radius_q4_mm and tach_counts_per_turn give {:.6f} mm a count, "
                                 "tach_q16_mm_per_count {:.6f}",
                                 mm_per_count, stated_mm_per_count));
    }
}

void read_angles(Section angles, hal::Calibration& record) {
    for (std::uint8_t index = 0; index < hal::kAngleChannelCount; ++index) {
        Section channel = angles.section(angle_channel_name(static_cast<hal::AngleChannel>(index)));
        hal::AngleCalibration& angle = record.angle[index];
        angle.zero_q4_count =
            static_cast<std::uint16_t>(channel.integer("zero_q4_count", 0, hal::kAdcMaxQ4Count));
        angle.gain_q16 = static_cast<std::uint16_t>(channel.integer("gain_q16", 0, 65535));
        angle.inverted = channel.boolean("inverted");
        channel.refuse_unknown_keys();
    }
    angles.refuse_unknown_keys();
}

}  // namespace

std::string_view angle_channel_name(hal::AngleChannel channel) {
    constexpr std::array<std::string_view, hal::kAngleChannelCount> kNames = {
        "bogie_left", "bogie_right", "differential", "pitch", "roll"};
    return kNames.at(static_cast<std::size_t>(channel));
}

hal::Calibration parse_calibration(std::string_view text, std::string_view name) {
    const toml::table document = parse_toml(text, name);
    Section root(document, "", name);
    root.constant("format", kFormat);
    hal::Calibration record;
    record.version = static_cast<std::uint16_t>(
        root.integer("version", hal::kCalibrationVersion, hal::kCalibrationVersion));
    read_wheel(root.section("wheel"), record);
    Section range = root.section("range");
    record.range_offset_q1_mm =
        static_cast<std::int16_t>(range.integer("offset_q1_mm", -32768, 32767));
    range.refuse_unknown_keys();
    read_angles(root.section("angle"), record);
    root.refuse_unknown_keys();
    return record;
}

std::string encode_calibration(const hal::Calibration& record,
                               const std::vector<std::string>& comments) {
    std::string text;
    for (const std::string& line : comments) text += fmt::format("# {}\n", line);
    text += fmt::format("format = \"{}\"\nversion = {}\n\n", kFormat, record.version);
    text += fmt::format(
        "[wheel]\nradius_q4_mm = {}\ntach_counts_per_turn = {}\ntach_q16_mm_per_count = {}\n\n",
        record.wheel_radius_q4_mm, record.tach_counts_per_turn, record.tach_q16_mm_per_count);
    text += fmt::format("[range]\noffset_q1_mm = {}\n", record.range_offset_q1_mm);
    for (std::uint8_t index = 0; index < hal::kAngleChannelCount; ++index) {
        const hal::AngleCalibration& angle = record.angle[index];
        text += fmt::format("\n[angle.{}]\nzero_q4_count = {}\ngain_q16 = {}\ninverted = {}\n",
                            angle_channel_name(static_cast<hal::AngleChannel>(index)),
                            angle.zero_q4_count, angle.gain_q16, angle.inverted);
    }
    (void)parse_calibration(text, "calibration record");
    return text;
}

hal::Calibration load_calibration(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw LogError(path.string(), {}, "cannot be read", "check the path");
    return parse_calibration(text, path.string());
}

void save_calibration(const std::filesystem::path& path, const hal::Calibration& record,
                      const std::vector<std::string>& comments) {
    const std::string text = encode_calibration(record, comments);
    std::filesystem::path beside = path;
    beside += ".part";
    std::error_code error;
    {
        std::ofstream out(beside, std::ios::binary);
        out << text << std::flush;
        if (!out) error = std::make_error_code(std::errc::io_error);
    }
    if (!error) std::filesystem::rename(beside, path, error);
    if (error) {
        std::error_code ignored;
        std::filesystem::remove(beside, ignored);
        throw LogError(path.string(), {}, "cannot be written", "check folder and permissions");
    }
}

}  // namespace host_sim
