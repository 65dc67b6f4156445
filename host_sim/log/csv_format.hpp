// csv_format.hpp - pieces of the wide CSV that its writer and its reader share.
// Normative    docs/spec/log-format.md.      Internal  to host_sim_log.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "host_sim/log/log_fields.hpp"
#include "host_sim/log/log_io.hpp"

namespace host_sim::detail {

inline constexpr std::string_view kCsvVersionPrefix = "# rover85-log ";
inline constexpr std::string_view kCsvVersion = "1";
inline constexpr std::string_view kCsvChecksumPrefix = "# crc32 ";
inline constexpr std::string_view kTimeColumn = "time_ms";
inline constexpr std::string_view kRestartColumn = "restart";
inline constexpr std::string_view kFormatAdvice = "docs/spec/log-format.md describes the format";

/// Which struct of a step a column belongs to.
enum class Part : std::uint8_t { input, truth, estimate, command };
inline constexpr std::size_t kPartCount = 4;

inline std::span<const Field> fields_of(Part part) {
    switch (part) {
        case Part::truth:
            return truth_fields();
        case Part::estimate:
            return estimate_fields();
        case Part::command:
            return command_fields();
        case Part::input:
            break;
    }
    return input_fields();
}

/// The leading comment lines of a head that has passed check_head.
void append_csv_head(std::string& out, const LogHead& head);

/// Collects a head from comment lines.
class CsvHeadReader {
public:
    explicit CsvHeadReader(std::string_view name) : name_(name) {}
    /// Takes one line that starts with '#'. @errors LogError: unknown, repeated or illegal
    void take(std::string_view line, std::uint64_t line_number);
    [[nodiscard]] const LogHead& head() const { return head_; }

private:
    void take_version(std::string_view version);
    void take_vehicle(std::string_view text);
    void take_setting(std::string_view key, std::string_view value);
    void take_calibration(std::string_view key, std::string_view value);
    [[noreturn]] void fail(std::string_view what, std::string_view advice) const;
    [[nodiscard]] std::string text_of(std::string_view escaped) const;

    std::string_view name_;
    std::uint64_t line_number_ = 0;
    bool has_vehicle_ = false;
    std::set<std::string, std::less<>> seen_;
    LogHead head_;
};

}  // namespace host_sim::detail
