// log_fields.hpp - one table of everything a log records: both formats walk the same lines.
// Depends on   log.hpp.      Normative  docs/spec/log-format.md; the order here is the order of
//              the .rlog payload, the names are the CSV's columns.
// Internal     to host_sim_log and its tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "host_sim/log/log.hpp"

namespace host_sim::detail {

enum class FieldType : std::uint8_t {
    u8,
    s8,
    u16,
    s16,
    s32,
    boolean,   ///< one byte, 0 or 1; CSV: true, false
    adc,       ///< u16 in [0, kAdcMaxQ4Count] or kAdcAbsent; CSV: an empty cell is absent
    f64,       ///< finite or NaN
    mode,      ///< rover::SlipMode: one byte; CSV: its name
    presence,  ///< u8 mask of a sensor group; no column of its own
    bytes,     ///< size byte, then that many bytes; CSV: hexadecimal digits
};

/// One recorded value inside one of the structs.
struct Field {
    std::string_view name;  ///< CSV column, or key of the calibration record
    FieldType type;
    std::size_t offset;           ///< of the value, in its struct; for bytes: of the first one
    std::uint8_t bit = 0;         ///< presence: mask of legal bits; optional value: its mask bit
    std::size_t mask_offset = 0;  ///< optional value: of its presence mask; bytes: of the size
    std::uint8_t capacity = 0;    ///< bytes: the most there can be

    [[nodiscard]] bool optional() const { return bit != 0 && type != FieldType::presence; }
};

std::span<const Field> calibration_fields();
std::span<const Field> input_fields();
std::span<const Field> truth_fields();
std::span<const Field> estimate_fields();
std::span<const Field> command_fields();

struct IntegerRange {
    std::int64_t low, high;
};
/// Legal values of an integer field (adc: of a present value).
IntegerRange integer_range(FieldType type);

/// An integer field (any type but f64 and bytes) of the struct at `base`, and back. Values given to
/// store_integer lie in the field's range.
std::int64_t load_integer(const Field& field, const std::byte* base);
void store_integer(const Field& field, std::byte* base, std::int64_t value);

double load_double(const Field& field, const std::byte* base);
void store_double(const Field& field, std::byte* base, double value);

/// False for an optional value whose presence bit is clear and for an absent converter channel.
bool is_present(const Field& field, const std::byte* base);
void set_present(const Field& field, std::byte* base);

/// Names of rover::SlipMode and of Restart in order of value; no restart has none.
std::span<const std::string_view> mode_names();
std::span<const std::string_view> restart_names();

template <class Struct>
const std::byte* base_of(const Struct& value) {
    return reinterpret_cast<const std::byte*>(&value);
}
template <class Struct>
std::byte* base_of(Struct& value) {
    return reinterpret_cast<std::byte*>(&value);
}

}  // namespace host_sim::detail
