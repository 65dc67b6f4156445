// rlog_decode.cpp - .rlog bytes to structs, refusing whatever encode would not have written.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <istream>
#include <iterator>

#include "host_sim/log/little_endian.hpp"
#include "host_sim/log/log_text.hpp"
#include "host_sim/log/rlog_format.hpp"

namespace host_sim {
namespace detail {
namespace {

constexpr std::string_view kForeignAdvice = "give an .rlog file";
constexpr std::size_t kReserveMax = 100'000;  ///< steps; a rubbish file must not claim memory

/// A payload error before it has the file's name and offset.
struct PayloadError {
    std::size_t at;
    std::string what;
};

/// Reads a payload from front to back; throws PayloadError where it ends too early.
class Cursor {
public:
    explicit Cursor(std::string_view payload) : payload_(payload) {}

    template <std::size_t kBytes>
    std::uint64_t number() {
        need(kBytes);
        const std::uint64_t value = get_le<kBytes>(payload_, at_);
        at_ += kBytes;
        return value;
    }
    std::string_view bytes(std::size_t size) {
        need(size);
        at_ += size;
        return payload_.substr(at_ - size, size);
    }
    [[nodiscard]] std::size_t at() const { return at_; }
    void end() const {
        if (at_ != payload_.size()) throw PayloadError{at_, "payload is longer than its content"};
    }

private:
    void need(std::size_t size) const {
        if (payload_.size() - at_ < size) throw PayloadError{at_, "payload is too short"};
    }
    std::string_view payload_;
    std::size_t at_ = 0;
};

std::int64_t get_integer(Cursor& cursor, FieldType type) {
    switch (type) {
        case FieldType::s8:
            return static_cast<std::int8_t>(cursor.number<1>());
        case FieldType::u16:
        case FieldType::adc:
            return static_cast<std::uint16_t>(cursor.number<2>());
        case FieldType::s16:
            return static_cast<std::int16_t>(cursor.number<2>());
        case FieldType::s32:
            return static_cast<std::int32_t>(cursor.number<4>());
        default:
            return static_cast<std::int64_t>(cursor.number<1>());
    }
}

void read_integer(Cursor& cursor, const Field& field, std::byte* base) {
    const std::size_t at = cursor.at();
    const std::int64_t value = get_integer(cursor, field.type);
    if (field.type == FieldType::presence) {
        if ((value & ~std::int64_t{field.bit}) != 0) {
            throw PayloadError{at,
                               fmt::format("presence bits {:#04x} beyond the last sensor", value)};
        }
    } else if (field.type == FieldType::adc && value == hal::kAdcAbsent) {
        // Absent: the mark itself is the value.
    } else if (const IntegerRange range = integer_range(field.type); value > range.high) {
        throw PayloadError{at, fmt::format("{} = {} is out of range [{}, {}]", field.name, value,
                                           range.low, range.high)};
    } else if (value != 0 && !is_present(field, base) && field.type != FieldType::adc) {
        throw PayloadError{at,
                           fmt::format("{} = {} although it is marked absent", field.name, value)};
    }
    store_integer(field, base, value);
}

void read_double(Cursor& cursor, const Field& field, std::byte* base) {
    const std::size_t at = cursor.at();
    const std::uint64_t bits = cursor.number<8>();
    const auto value = std::bit_cast<double>(bits);
    if (std::isinf(value) || (std::isnan(value) && bits != kNanBits)) {
        throw PayloadError{
            at, fmt::format("{} is neither a finite number nor the absent mark", field.name)};
    }
    store_double(field, base, value);
}

void read_bytes(Cursor& cursor, const Field& field, std::byte* base) {
    const std::size_t at = cursor.at();
    const auto size = static_cast<std::uint8_t>(cursor.number<1>());
    if (size > field.capacity) {
        throw PayloadError{
            at, fmt::format("{} has {} bytes, more than {}", field.name, size, field.capacity)};
    }
    const std::string_view bytes = cursor.bytes(size);
    base[field.mask_offset] = std::byte{size};
    if (size != 0) std::memcpy(base + field.offset, bytes.data(), size);
}

template <class Struct>
void read_fields(Cursor& cursor, std::span<const Field> fields, Struct& value) {
    std::byte* base = base_of(value);
    for (const Field& field : fields) {
        if (field.type == FieldType::bytes) {
            read_bytes(cursor, field, base);
        } else if (field.type == FieldType::f64) {
            read_double(cursor, field, base);
        } else {
            read_integer(cursor, field, base);
        }
    }
}

std::string read_text(Cursor& cursor, std::string_view what) {
    const auto size = static_cast<std::size_t>(cursor.number<4>());
    const std::size_t at = cursor.at();
    const std::string_view text = cursor.bytes(size);
    const std::string_view fault = text_fault(text);
    if (!fault.empty()) throw PayloadError{at, fmt::format("{} {}", what, fault)};
    return std::string(text);
}

void read_notes(Cursor& cursor, std::map<std::string, std::string>& notes) {
    const std::uint64_t count = cursor.number<4>();
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::size_t at = cursor.at();
        const std::string key = read_text(cursor, "note name");
        if (!is_note_name(key)) throw PayloadError{at, "note name " + quote(key) + " is not legal"};
        if (!notes.empty() && key <= notes.rbegin()->first) {
            throw PayloadError{at, "note " + quote(key) + " is out of order or repeated"};
        }
        notes.emplace_hint(notes.end(), key, read_text(cursor, "note " + key));
    }
}

}  // namespace

RlogParser::RlogParser(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {
    read_header();
    const Record record = read_record();
    if (record.type != static_cast<std::uint8_t>(RecordType::head)) {
        fail(offset_, fmt::format("the first record has type {} and not head (1)", record.type));
    }
    try {
        decode_head(record.payload);
    } catch (const PayloadError& error) {
        fail(offset_ + kRecordPrefixSize + error.at, error.what);
    }
    accept(record);
}

void RlogParser::fail(std::size_t at, std::string_view what) const {
    const bool salvageable = sequence_ > 0;
    const std::string advice =
        salvageable
            ? fmt::format("run `rover85 recover {} -o OUT` to keep what comes before", name_)
            : "nothing can be salvaged, record or copy the log again";
    throw LogError(name_, {0, static_cast<std::int64_t>(at)}, what, advice);
}

void RlogParser::read_header() {
    const std::string_view magic = bytes_.substr(0, kRlogMagic.size());
    if (bytes_.empty()) throw LogError(name_, {0, 0}, "the file is empty", kForeignAdvice);
    if (magic != kRlogMagic.substr(0, magic.size())) {
        throw LogError(name_, {0, 0}, "not an .rlog: the magic bytes are missing", kForeignAdvice);
    }
    if (bytes_.size() < kRlogHeaderSize) fail(bytes_.size(), "the file ends inside its header");
    next_crc_ = static_cast<std::uint32_t>(
        ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes_.data()), kRlogHeaderSize - 4));
    if (next_crc_ != get_le<4>(bytes_, kRlogHeaderSize - 4)) {
        fail(kRlogHeaderSize - 4, "header checksum is wrong: the header is damaged");
    }
    const auto major = get_le<2>(bytes_, kRlogMagic.size());
    if (major != kRlogMajor) {
        throw LogError(name_, {0, static_cast<std::int64_t>(kRlogMagic.size())},
                       fmt::format("format version {}.{}, this program reads {}.x", major,
                                   get_le<2>(bytes_, kRlogMagic.size() + 2), kRlogMajor),
                       "use the rover85 that wrote it, or have that one convert it to CSV");
    }
    chain_crc_ = next_crc_;
    offset_ = kRlogHeaderSize;
}

RlogParser::Record RlogParser::read_record() {
    const std::size_t left = bytes_.size() - offset_;
    if (left < kRecordOverhead) {
        fail(offset_, fmt::format("the file ends inside record {}: {} bytes of it are there",
                                  sequence_, left));
    }
    const auto size = static_cast<std::size_t>(get_le<4>(bytes_, offset_));
    const auto sequence = static_cast<std::uint32_t>(get_le<4>(bytes_, offset_ + 4));
    if (size > kPayloadSizeMax) {
        fail(offset_,
             fmt::format("record {} is damaged: impossible payload size {}", sequence_, size));
    }
    if (left < size + kRecordOverhead) {
        fail(offset_, fmt::format("the file ends inside record {}: {} of {} bytes are there",
                                  sequence_, left, size + kRecordOverhead));
    }
    const std::string_view covered = bytes_.substr(offset_, kRecordPrefixSize + size);
    next_crc_ = static_cast<std::uint32_t>(
        ::crc32_z(chain_crc_, reinterpret_cast<const Bytef*>(covered.data()), covered.size()));
    const bool crc_good = next_crc_ == get_le<4>(bytes_, offset_ + covered.size());
    if (sequence != sequence_) {
        fail(offset_, fmt::format("record {} found where record {} belongs: records are missing, "
                                  "repeated, out of order or damaged",
                                  sequence, sequence_));
    }
    if (!crc_good) {
        fail(offset_, fmt::format("checksum of record {} is wrong: it is damaged or comes from "
                                  "another log",
                                  sequence_));
    }
    return {static_cast<std::uint8_t>(covered[kRecordPrefixSize - 1]),
            covered.substr(kRecordPrefixSize)};
}

void RlogParser::accept(const Record& record) {
    offset_ += record.payload.size() + kRecordOverhead;
    chain_crc_ = next_crc_;
    ++sequence_;
}

bool RlogParser::next(LogStep& step) {
    while (offset_ < bytes_.size()) {
        const Record record = read_record();
        const bool is_step = record.type == static_cast<std::uint8_t>(RecordType::step);
        if (is_step || record.type == static_cast<std::uint8_t>(RecordType::restart)) {
            try {
                if (is_step) {
                    decode_step(record.payload, step);
                } else {
                    decode_restart(record.payload);
                }
            } catch (const PayloadError& error) {
                fail(offset_ + kRecordPrefixSize + error.at, error.what);
            }
            accept(record);
            if (is_step) return true;
            continue;
        }
        if ((record.type & kSkippableBit) == 0) {
            fail(offset_, fmt::format("record {} has type {}, which this program does not know and "
                                      "must not skip",
                                      sequence_, record.type));
        }
        accept(record);
    }
    if (restart_ != Restart::none) {
        fail(restart_offset_, "the file ends behind a restart: its step is missing");
    }
    return false;
}

void RlogParser::decode_restart(std::string_view payload) {
    Cursor cursor(payload);
    if (restart_ != Restart::none) throw PayloadError{0, "two restarts before one step"};
    const auto kind = static_cast<unsigned>(cursor.number<1>());
    if (kind == 0 || kind > static_cast<unsigned>(Restart::cold)) {
        throw PayloadError{0, fmt::format("restart {} is out of range [1, 2]", kind)};
    }
    cursor.end();
    restart_ = static_cast<Restart>(kind);
    restart_offset_ = offset_;
}

void RlogParser::decode_head(std::string_view payload) {
    Cursor cursor(payload);
    head_.vehicle = read_text(cursor, "the vehicle description");
    read_fields(cursor, calibration_fields(), head_.calibration);
    head_.image_identity = read_text(cursor, "the image identity");
    read_notes(cursor, head_.notes);
    cursor.end();
}

void RlogParser::decode_step(std::string_view payload, LogStep& step) {
    step = {};
    Cursor cursor(payload);
    step.time_ms = static_cast<std::uint32_t>(cursor.number<4>());
    if (step.time_ms <= last_time_ms_) {
        throw PayloadError{0, fmt::format("step at {} ms comes after {} ms: time must increase",
                                          step.time_ms, last_time_ms_)};
    }
    const auto sections = static_cast<unsigned>(cursor.number<1>());
    if (sections >= 2 * kSectionCommands) {
        throw PayloadError{4, fmt::format("unknown section bits {:#04x}", sections)};
    }
    read_fields(cursor, input_fields(), step.inputs);
    if ((sections & kSectionTruth) != 0) read_fields(cursor, truth_fields(), step.truth.emplace());
    if ((sections & kSectionEstimates) != 0) {
        read_fields(cursor, estimate_fields(), step.estimates.emplace());
    }
    if ((sections & kSectionCommands) != 0) {
        read_fields(cursor, command_fields(), step.commands.emplace());
    }
    cursor.end();
    last_time_ms_ = step.time_ms;
    step.restart = restart_;
    restart_ = Restart::none;
}

}  // namespace detail

Log read_rlog(std::string_view bytes, std::string_view name) {
    detail::RlogParser parser(bytes, name);
    Log log;
    log.head = parser.take_head();
    log.steps.reserve(std::min(bytes.size() / 256, detail::kReserveMax));
    while (parser.next(log.steps.emplace_back())) {
    }
    log.steps.pop_back();
    return log;
}

Log read_rlog(std::istream& in, std::string_view name) {
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    return read_rlog(bytes, name);
}

}  // namespace host_sim
