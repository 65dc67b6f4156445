// rlog_encode.cpp - structs to .rlog bytes. One log has exactly one encoding: what is absent is
// written as 0 (0xFFFF for the converter), every NaN as the same NaN.
#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cmath>

#include "host_sim/log/file_io.hpp"
#include "host_sim/log/little_endian.hpp"
#include "host_sim/log/log_text.hpp"
#include "host_sim/log/rlog_format.hpp"

namespace host_sim {
namespace detail {
namespace {

constexpr std::string_view kProducerAdvice = "correct the program that made this log";

std::uint32_t extend_crc(std::uint32_t crc, std::string_view bytes) {
    return static_cast<std::uint32_t>(
        ::crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void put_bytes(std::string& out, const Field& field, const std::byte* base) {
    const auto size = std::to_integer<std::uint8_t>(base[field.mask_offset]);
    out += static_cast<char>(size);
    out.append(reinterpret_cast<const char*>(base + field.offset), size);
}

void put_integer(std::string& out, const Field& field, const std::byte* base) {
    auto value = static_cast<std::uint64_t>(load_integer(field, base));
    if (!is_present(field, base)) value = field.type == FieldType::adc ? hal::kAdcAbsent : 0;
    if (field.type == FieldType::presence) value &= field.bit;
    switch (field.type) {
        case FieldType::u16:
        case FieldType::s16:
        case FieldType::adc:
            return put_le<2>(out, value);
        case FieldType::s32:
            return put_le<4>(out, value);
        default:
            return put_le<1>(out, value);
    }
}

void put_fields(std::string& out, std::span<const Field> fields, const std::byte* base) {
    for (const Field& field : fields) {
        if (field.type == FieldType::bytes) {
            put_bytes(out, field, base);
        } else if (field.type == FieldType::f64) {
            const double value = load_double(field, base);
            put_le<8>(out, std::isnan(value) ? kNanBits : std::bit_cast<std::uint64_t>(value));
        } else {
            put_integer(out, field, base);
        }
    }
}

void put_text(std::string& out, std::string_view text) {
    put_le<4>(out, text.size());
    out += text;
}

[[noreturn]] void refuse(std::string_view name, std::string_view what) {
    throw LogError(name, {}, what, kProducerAdvice);
}

void check_fields(std::span<const Field> fields, const std::byte* base, std::uint32_t time_ms,
                  std::string_view name) {
    for (const Field& field : fields) {
        if (field.type == FieldType::f64 && std::isinf(load_double(field, base))) {
            refuse(name, fmt::format("step at {} ms: {} is infinite", time_ms, field.name));
        }
        if (field.type == FieldType::mode &&
            load_integer(field, base) > integer_range(FieldType::mode).high) {
            refuse(name, fmt::format("step at {} ms: {} {} does not exist", time_ms, field.name,
                                     load_integer(field, base)));
        }
        if (field.type == FieldType::bytes &&
            std::to_integer<unsigned>(base[field.mask_offset]) > field.capacity) {
            refuse(name,
                   fmt::format("step at {} ms: {} has {} bytes, more than {}", time_ms, field.name,
                               std::to_integer<unsigned>(base[field.mask_offset]), field.capacity));
        }
    }
}

void check_text(std::string_view text, std::string_view what, std::string_view name) {
    const std::string_view fault = text_fault(text);
    if (!fault.empty()) refuse(name, fmt::format("{} {}", what, fault));
}

}  // namespace

std::uint32_t append_header(std::string& out) {
    const std::size_t start = out.size();
    out += kRlogMagic;
    put_le<2>(out, kRlogMajor);
    put_le<2>(out, kRlogMinor);
    const std::uint32_t crc = extend_crc(0, std::string_view(out).substr(start));
    put_le<4>(out, crc);
    return crc;
}

std::uint32_t append_record(std::string& out, std::uint32_t chain_crc, std::uint32_t sequence,
                            std::uint8_t type, std::string_view payload) {
    const std::size_t start = out.size();
    put_le<4>(out, payload.size());
    put_le<4>(out, sequence);
    put_le<1>(out, type);
    out += payload;
    const std::uint32_t crc = extend_crc(chain_crc, std::string_view(out).substr(start));
    put_le<4>(out, crc);
    return crc;
}

void check_head(const LogHead& head, std::string_view name) {
    check_text(head.vehicle, "the vehicle description", name);
    check_text(head.image_identity, "the image identity", name);
    std::size_t size = 1024 + head.vehicle.size() + head.image_identity.size();
    for (const auto& [key, value] : head.notes) {
        if (!is_note_name(key)) {
            refuse(name,
                   fmt::format("note name {} is not 1 to 64 of A-Z a-z 0-9 _ . -", quote(key)));
        }
        check_text(value, fmt::format("note {}", key), name);
        size += 8 + key.size() + value.size();
    }
    if (size > kPayloadSizeMax) refuse(name, "vehicle and notes together exceed 16 MiB");
}

void check_step(const LogStep& step, std::int64_t last_time_ms, std::string_view name) {
    if (step.time_ms <= last_time_ms) {
        refuse(name, fmt::format("step at {} ms comes after {} ms: time must increase",
                                 step.time_ms, last_time_ms));
    }
    if (step.restart > Restart::cold) {
        refuse(name, fmt::format("step at {} ms: restart {} does not exist", step.time_ms,
                                 static_cast<unsigned>(step.restart)));
    }
    check_fields(input_fields(), base_of(step.inputs), step.time_ms, name);
    if (step.truth) check_fields(truth_fields(), base_of(*step.truth), step.time_ms, name);
    if (step.estimates)
        check_fields(estimate_fields(), base_of(*step.estimates), step.time_ms, name);
    if (step.commands) check_fields(command_fields(), base_of(*step.commands), step.time_ms, name);
}

void append_head_payload(std::string& out, const LogHead& head) {
    put_text(out, head.vehicle);
    put_fields(out, calibration_fields(), base_of(head.calibration));
    put_text(out, head.image_identity);
    put_le<4>(out, head.notes.size());
    for (const auto& [key, value] : head.notes) {  // a map: in ascending order of bytes
        put_text(out, key);
        put_text(out, value);
    }
}

void append_step_payload(std::string& out, const LogStep& step) {
    put_le<4>(out, step.time_ms);
    unsigned sections = 0;
    if (step.truth) sections |= kSectionTruth;
    if (step.estimates) sections |= kSectionEstimates;
    if (step.commands) sections |= kSectionCommands;
    put_le<1>(out, sections);
    put_fields(out, input_fields(), base_of(step.inputs));
    if (step.truth) put_fields(out, truth_fields(), base_of(*step.truth));
    if (step.estimates) put_fields(out, estimate_fields(), base_of(*step.estimates));
    if (step.commands) put_fields(out, command_fields(), base_of(*step.commands));
}

RlogEncoder::RlogEncoder(const LogHead& head, std::string_view name, std::string& out)
    : name_(name) {
    check_head(head, name_);
    chain_crc_ = append_header(out);
    append_head_payload(payload_, head);
    append(out, RecordType::head);
}

void RlogEncoder::append(const LogStep& step, std::string& out) {
    check_step(step, last_time_ms_, name_);
    last_time_ms_ = step.time_ms;
    if (step.restart != Restart::none) {
        payload_.assign(1, static_cast<char>(step.restart));
        append(out, RecordType::restart);
    }
    payload_.clear();
    append_step_payload(payload_, step);
    append(out, RecordType::step);
}

void RlogEncoder::append(std::string& out, RecordType type) {
    chain_crc_ =
        append_record(out, chain_crc_, sequence_, static_cast<std::uint8_t>(type), payload_);
    ++sequence_;
}

}  // namespace detail

namespace {

std::string encode_named(const Log& log, std::string_view name) {
    std::string out;
    detail::RlogEncoder encoder(log.head, name, out);
    out.reserve(out.size() + log.steps.size() * 384);
    for (const LogStep& step : log.steps) encoder.append(step, out);
    return out;
}

}  // namespace

std::string encode_rlog(const Log& log) {
    return encode_named(log, "log");
}

void write_rlog(const std::filesystem::path& path, const Log& log) {
    detail::write_file(path, encode_named(log, path.string()));
}

}  // namespace host_sim
