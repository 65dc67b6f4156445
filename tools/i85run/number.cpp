#include "tools/i85run/number.hpp"

#include <charconv>
#include <limits>

namespace i85run {
namespace {

template <class Unsigned>
std::optional<Unsigned> digits(std::string_view text, int base, Unsigned max) {
    Unsigned value = 0;
    const char* const end = text.data() + text.size();
    const auto [behind, error] = std::from_chars(text.data(), end, value, base);
    if (error != std::errc{} || behind != end || value > max) return std::nullopt;
    return value;
}

bool is_decimal_digit(char character) {
    return '0' <= character && character <= '9';
}

}  // namespace

std::optional<uint32_t> parse_number(std::string_view text, uint32_t max) {
    if (text.empty() || !is_decimal_digit(text.front())) return std::nullopt;
    if (text.starts_with("0x") || text.starts_with("0X")) return digits(text.substr(2), 16, max);
    if (text.back() == 'h' || text.back() == 'H') {
        return digits(text.substr(0, text.size() - 1), 16, max);
    }
    return digits(text, 10, max);
}

std::optional<uint64_t> parse_t_states(std::string_view text) {
    return digits(text, 10, std::numeric_limits<uint64_t>::max());
}

std::optional<host_sim::AddressRange> parse_range(std::string_view text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    const auto low = parse_number(text.substr(0, colon), 0xFFFF);
    const auto high = parse_number(text.substr(colon + 1), 0xFFFF);
    if (!low || !high || *low > *high) return std::nullopt;
    return host_sim::AddressRange{static_cast<uint16_t>(*low), static_cast<uint16_t>(*high)};
}

std::optional<PlaceAndLength> parse_place(std::string_view text) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos) return PlaceAndLength{text, std::nullopt};
    const auto length = parse_number(text.substr(colon + 1), 0x10000);
    if (!length || *length == 0) return std::nullopt;
    return PlaceAndLength{text.substr(0, colon), length};
}

}  // namespace i85run
