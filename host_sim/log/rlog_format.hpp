// rlog_format.hpp - the .rlog encoding, one record at a time: building and parsing.
// Normative    docs/spec/log-format.md.      Internal  to host_sim_log and its tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "host_sim/log/log_fields.hpp"
#include "host_sim/log/log_io.hpp"

namespace host_sim::detail {

inline constexpr std::string_view kRlogMagic{"\x89RLOG\r\n\x1A", 8};
inline constexpr std::uint16_t kRlogMajor = 1;
inline constexpr std::uint16_t kRlogMinor = 0;
inline constexpr std::size_t kRlogHeaderSize = 16;   ///< magic, major, minor, checksum
inline constexpr std::size_t kRecordPrefixSize = 9;  ///< payload size, sequence number, type
inline constexpr std::size_t kRecordOverhead = kRecordPrefixSize + 4;  ///< and the checksum
inline constexpr std::size_t kPayloadSizeMax = std::size_t{1} << 24;

enum class RecordType : std::uint8_t { head = 1, step = 2, restart = 3 };
inline constexpr std::uint64_t kNanBits = 0x7FF8'0000'0000'0000;  ///< the only NaN written
inline constexpr std::uint8_t kSkippableBit = 0x80;  ///< an unknown type with it is skipped

/// Bits of a step's section byte, in payload order.
enum Section : std::uint8_t { kSectionTruth = 1, kSectionEstimates = 2, kSectionCommands = 4 };

/// Appends the file header. @return the running checksum after it
std::uint32_t append_header(std::string& out);

/// Appends one record. @return the running checksum after it
std::uint32_t append_record(std::string& out, std::uint32_t chain_crc, std::uint32_t sequence,
                            std::uint8_t type, std::string_view payload);

/// Appends the payload of a head or a step that has passed its check.
void append_head_payload(std::string& out, const LogHead& head);
void append_step_payload(std::string& out, const LogStep& step);

/// Refuses what neither format can hold. @errors LogError naming `name`
void check_head(const LogHead& head, std::string_view name);
void check_step(const LogStep& step, std::int64_t last_time_ms, std::string_view name);

/// Checks, encodes, numbers and chains the records of one log.
class RlogEncoder {
public:
    /// Appends file header and head record to `out`. @errors LogError naming `name`
    RlogEncoder(const LogHead& head, std::string_view name, std::string& out);
    /// Appends a step. @errors LogError; `out` is then untouched
    void append(const LogStep& step, std::string& out);

private:
    void append(std::string& out, RecordType type);

    std::string name_;
    std::string payload_;
    std::uint32_t chain_crc_ = 0;
    std::uint32_t sequence_ = 0;
    std::int64_t last_time_ms_ = -1;
};

/// Walks the records of an .rlog in memory; refuses at the first thing that is not as specified.
class RlogParser {
public:
    /// Reads the file header and the head record.
    RlogParser(std::string_view bytes, std::string_view name);

    [[nodiscard]] LogHead take_head() { return std::move(head_); }
    /// Reads up to the next step, over skippable records. @return false at the end of the file
    /// @errors  LogError; offset() is then the start of the first record that is not whole, or of
    ///          the restart record before it
    bool next(LogStep& step);
    [[nodiscard]] std::size_t offset() const {
        return restart_ == Restart::none ? offset_ : restart_offset_;
    }

private:
    struct Record {
        std::uint8_t type;
        std::string_view payload;
    };
    void read_header();
    Record read_record();
    void accept(const Record& record);
    void decode_head(std::string_view payload);
    void decode_step(std::string_view payload, LogStep& step);
    void decode_restart(std::string_view payload);
    [[noreturn]] void fail(std::size_t at, std::string_view what) const;

    std::string_view bytes_;
    std::string name_;
    LogHead head_;
    std::size_t offset_ = 0;
    Restart restart_ = Restart::none;  ///< of a record whose step has not come yet
    std::size_t restart_offset_ = 0;
    std::uint32_t chain_crc_ = 0;
    std::uint32_t next_crc_ = 0;
    std::uint32_t sequence_ = 0;
    std::int64_t last_time_ms_ = -1;
};

}  // namespace host_sim::detail
