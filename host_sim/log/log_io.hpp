// log_io.hpp - reads, writes and salvages logs: wide CSV for people, .rlog for machines.
// Depends on   host_sim/log/log.hpp.     Library  host_sim_log.
// Format       docs/spec/log-format.md (normative).
// Errors       every function throws LogError; a refused file is never half-read.
// Absent       what a struct marks absent is not recorded: it reads back as 0 (kAdcAbsent for the
//              converter), whatever number stood beside the mark when it was written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "host_sim/log/log.hpp"

namespace host_sim {
namespace detail {
class RlogEncoder;
}

/// What is wrong with a log, where, and what to do. what() is one printable line:
/// `file:12: what; advice` (CSV), `file:byte 345: what; advice` (.rlog), `file: what; advice`.
class LogError : public std::runtime_error {
public:
    /// Where in the file. At most one of the two is set.
    struct Place {
        std::uint64_t line = 0;         ///< CSV: 1-based; 0: not a line
        std::int64_t byte_offset = -1;  ///< .rlog: 0-based; -1: not an offset
    };
    LogError(std::string_view file, Place place, std::string_view what, std::string_view advice);

    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] std::uint64_t line() const { return place_.line; }
    [[nodiscard]] std::int64_t byte_offset() const { return place_.byte_offset; }

private:
    std::string file_;
    Place place_;
};

/// Reads a log of either kind; the content decides (the .rlog magic, else CSV), not the name.
Log load_log(const std::filesystem::path& path);

/// Reads a whole .rlog. `name` stands in error messages.
Log read_rlog(std::string_view bytes, std::string_view name);
Log read_rlog(std::istream& in, std::string_view name);

/// Reads a whole wide CSV. Log::unverified tells that it has no checksum line.
Log read_csv(std::string_view text, std::string_view name);
Log read_csv(std::istream& in, std::string_view name);

/// The bytes of a log; one log has exactly one encoding.
/// @errors  what the format cannot hold: time not increasing, infinite truth, a mode that does not
///          exist, text that is not UTF-8 or holds NUL, a note name that is not [A-Za-z0-9_.-]+
std::string encode_rlog(const Log& log);

struct CsvOptions {
    bool checksum = true;  ///< end with a line `# crc32 XXXXXXXX rows N`
};
/// The text of a log. @errors as encode_rlog
std::string encode_csv(const Log& log, const CsvOptions& options = {});

/// Write files. The file appears whole or not at all (written beside, then renamed), and replaces
/// an older one of the same name.
void write_rlog(const std::filesystem::path& path, const Log& log);
void write_csv(const std::filesystem::path& path, const Log& log, const CsvOptions& options = {});

/// Writes an .rlog step by step, for long or live recordings. Only whole records are handed to the
/// system, so a crash leaves a file that reads, or recovers, up to the last whole record.
class RlogWriter {
public:
    /// Creates (or replaces) the file and writes the head at once.
    /// @param flush_size  bytes gathered before a write; 0: every record is written at once
    RlogWriter(const std::filesystem::path& path, const LogHead& head,
               std::size_t flush_size = 65536);
    ~RlogWriter();  ///< writes what is left; errors are lost, so call close()
    RlogWriter(const RlogWriter&) = delete;
    RlogWriter& operator=(const RlogWriter&) = delete;

    /// Appends a step. @errors as encode_rlog; then nothing of this step has been written
    void append(const LogStep& step);
    void flush();
    void close();  ///< flush and close; append is an error from here on

private:
    std::filesystem::path path_;
    std::string buffer_;
    std::size_t flush_size_;
    std::unique_ptr<detail::RlogEncoder> encoder_;
    int descriptor_ = -1;
};

/// Writes a wide CSV row by row, for recordings of what a controller said: columns time, restart,
/// tick_count and the estimates; nothing else of a step is recorded. Each row is handed to the
/// system whole. Without close(), after a crash, the file lacks its checksum line and reads as
/// unverified.
class EstimatesCsvWriter {
public:
    /// Creates (or replaces) the file and writes the head and the header line at once.
    EstimatesCsvWriter(const std::filesystem::path& path, const LogHead& head);
    ~EstimatesCsvWriter();  ///< as close(); errors are lost
    EstimatesCsvWriter(const EstimatesCsvWriter&) = delete;
    EstimatesCsvWriter& operator=(const EstimatesCsvWriter&) = delete;

    /// Appends a step. @errors as encode_csv; then nothing of this step has been written
    void append(const LogStep& step);
    void close();  ///< writes the checksum line; append is an error from here on

private:
    struct File;
    std::unique_ptr<File> file_;
};

/// What recover_rlog kept and dropped.
struct Recovery {
    std::uint64_t steps = 0;          ///< steps in the output
    std::uint64_t kept_bytes = 0;     ///< leading bytes of the input that were kept
    std::uint64_t dropped_bytes = 0;  ///< bytes after them; 0: the input was whole
    std::string reason;               ///< what is wrong with the first dropped byte; empty: nothing
};

/// Copies all whole leading records of a damaged .rlog to `out`, then reads `out` back strictly and
/// compares it with what was kept.
/// @errors  not an .rlog, version unknown, head damaged (nothing can be salvaged), in and out are
///          the same file, out cannot be written or does not read back
Recovery recover_rlog(const std::filesystem::path& in, const std::filesystem::path& out);

/// The same in memory: the leading part of `bytes` that read_rlog accepts.
std::string_view salvage_rlog(std::string_view bytes, std::string_view name, Recovery& recovery);

}  // namespace host_sim
