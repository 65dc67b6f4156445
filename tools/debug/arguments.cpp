// arguments.cpp - see arguments.hpp.
#include "tools/debug/arguments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "hal/board/rb85.hpp"
#include "tools/debug/debug_error.hpp"

namespace debug_console {
namespace {

constexpr std::string_view kSeparators = " \t,\r";

bool is_digit(char character) {
    return character >= '0' && character <= '9';
}

char upper(char character) {
    return static_cast<char>(std::toupper(static_cast<unsigned char>(character)));
}

std::optional<int64_t> digits(std::string_view text, int base) {
    int64_t value = 0;
    const char* const end = text.data() + text.size();
    if (text.empty() || text.front() == '-') return std::nullopt;
    const auto [behind, error] = std::from_chars(text.data(), end, value, base);
    if (error != std::errc{} || behind != end) return std::nullopt;
    return value;
}

/// The byte that the escape at the front of `text` stands for; takes it.
char take_escape(std::string_view& text) {
    constexpr std::string_view kNames = "nrt\\\"";
    constexpr std::string_view kValues = "\n\r\t\\\"";
    const char name = text.empty() ? '\0' : text.front();
    const std::size_t known = name == '\0' ? std::string_view::npos : kNames.find(name);
    if (known != std::string_view::npos) {
        text.remove_prefix(1);
        return kValues[known];
    }
    if (name == 'x' && text.size() >= 3) {
        if (const auto value = digits(text.substr(1, 2), 16)) {
            text.remove_prefix(3);
            return static_cast<char>(*value);
        }
    }
    throw DebugError(R"(unknown escape in a string; \n \r \t \\ \" and \xHH are known)");
}

}  // namespace

std::optional<int64_t> parse_number(std::string_view text) {
    if (text.size() == 3 && text.front() == '\'' && text.back() == '\'') {
        return static_cast<unsigned char>(text[1]);
    }
    if (text.empty() || !is_digit(text.front())) return std::nullopt;
    if (text.starts_with("0x") || text.starts_with("0X")) return digits(text.substr(2), 16);
    const std::string_view body = text.substr(0, text.size() - 1);
    if (upper(text.back()) == 'H') return digits(body, 16);
    if (upper(text.back()) == 'B') return digits(body, 2);
    return digits(text, 10);
}

uint64_t parse_time(std::string_view text, uint64_t now_t) {
    const std::string_view whole = text;
    const bool relative = text.starts_with('+');
    if (relative) text.remove_prefix(1);
    const uint64_t from_t = relative ? now_t : 0;
    if (const auto t_states = parse_number(text)) return from_t + static_cast<uint64_t>(*t_states);
    double number = 0;
    const char* const end = text.data() + text.size();
    const auto [behind, error] = std::from_chars(text.data(), end, number);
    const std::string_view unit(behind, static_cast<std::size_t>(end - behind));
    const double units_per_s = unit == "us" ? 1e6 : unit == "ms" ? 1e3 : unit == "s" ? 1 : 0;
    constexpr double kLongestS = 1e9;
    if (error == std::errc{} && units_per_s != 0 && number >= 0 &&
        number / units_per_s <= kLongestS) {
        // Tiny rounding of the decimal fraction must not cost a T-state.
        const double t_states = number * hal::rb85::kClockHz / units_per_s;
        return from_t + static_cast<uint64_t>(std::floor(t_states + 1e-6));
    }
    throw DebugError(fmt::format(
        "{}: not a time; write T-states (5000, +500) or +2.5ms, with us, ms or s", whole));
}

std::string_view without_comment(std::string_view line) {
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (quoted && line[i] == '\\') {
            ++i;
        } else if (line[i] == '"') {
            quoted = !quoted;
        } else if (!quoted && line[i] == '#' &&
                   (i == 0 || kSeparators.find(line[i - 1]) != std::string_view::npos)) {
            return line.substr(0, i);
        }
    }
    return line;
}

Arguments::Arguments(std::string_view line) : rest_(line) {
    skip_separators();
}

void Arguments::skip_separators() {
    rest_.remove_prefix(std::min(rest_.size(), rest_.find_first_not_of(kSeparators)));
    while (!rest_.empty() && kSeparators.find(rest_.back()) != std::string_view::npos) {
        rest_.remove_suffix(1);
    }
}

std::string_view Arguments::peek() const {
    return rest_.substr(0, rest_.find_first_of(kSeparators));
}

std::string Arguments::word(std::string_view meaning) {
    if (empty()) throw DebugError(fmt::format("{} is missing", meaning));
    std::string taken(peek());
    rest_.remove_prefix(taken.size());
    skip_separators();
    return taken;
}

bool Arguments::take(std::string_view text) {
    if (!same_word(peek(), text)) return false;
    word(text);
    return true;
}

std::string Arguments::take_rest() {
    std::string taken(rest_);
    rest_ = {};
    return taken;
}

std::optional<std::string> Arguments::take_quoted() {
    if (!rest_.starts_with('"')) return std::nullopt;
    std::string_view text = rest_.substr(1);
    std::string bytes;
    while (!text.empty() && text.front() != '"') {
        const char character = text.front();
        text.remove_prefix(1);
        bytes += character == '\\' ? take_escape(text) : character;
    }
    if (text.empty()) throw DebugError("a string has no closing quote");
    rest_ = text.substr(1);
    skip_separators();
    return bytes;
}

void Arguments::expect_end() const {
    if (!empty())
        throw DebugError(
            fmt::format("{}: not understood here; `help COMMAND` shows what it takes", rest_));
}

bool same_word(std::string_view one, std::string_view other) {
    return std::ranges::equal(one, other, {}, upper, upper);
}

std::string quote(std::string_view bytes) {
    std::string text = "\"";
    for (const char byte : bytes) {
        if (byte == '"' || byte == '\\') {
            text += {'\\', byte};
        } else if (byte == '\n') {
            text += "\\n";
        } else if (byte == '\r') {
            text += "\\r";
        } else if (byte >= ' ' && byte <= '~') {
            text += byte;
        } else {
            text += fmt::format("\\x{:02X}", static_cast<unsigned char>(byte));
        }
    }
    return text + '"';
}

}  // namespace debug_console
