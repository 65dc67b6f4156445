// number.hpp - addresses, lengths and ranges as people write them on the command line.
// Depends on   host_sim/image (AddressRange).
// Syntax       0x8000 and 8000h are hexadecimal, 32768 is decimal. A hexadecimal number with h
//              begins with a digit (0FFh), so that no symbol is mistaken for one.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "host_sim/image/image.hpp"

namespace i85run {

/// @return nothing when `text` is not a number, or greater than `max`
[[nodiscard]] std::optional<uint32_t> parse_number(std::string_view text, uint32_t max);

/// A count of T-states: decimal digits and nothing else.
[[nodiscard]] std::optional<uint64_t> parse_t_states(std::string_view text);

/// "LO:HI", both inclusive, LO not above HI.
[[nodiscard]] std::optional<host_sim::AddressRange> parse_range(std::string_view text);

/// Part of a --dump argument: what is before the last colon, and the length behind it.
struct PlaceAndLength {
    std::string_view place;
    std::optional<uint32_t> length;  ///< 1 to 65536; none when there is no colon
};

/// @return nothing when there is a colon but no length from 1 to 65536 behind it
[[nodiscard]] std::optional<PlaceAndLength> parse_place(std::string_view text);

}  // namespace i85run
