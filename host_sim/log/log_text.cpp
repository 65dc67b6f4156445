// log_text.cpp - see log_text.hpp.
#include "host_sim/log/log_text.hpp"

#include <cstddef>
#include <cstdint>

namespace host_sim::detail {
namespace {

constexpr std::string_view kHexDigits = "0123456789ABCDEF";

std::uint32_t byte_at(std::string_view text, std::size_t index) {
    return static_cast<unsigned char>(text[index]);
}

/// Size of the valid UTF-8 sequence at `at`; 0 if there is none.
std::size_t sequence_size(std::string_view text, std::size_t at) {
    const std::uint32_t lead = byte_at(text, at);
    if (lead < 0x80) return 1;
    const std::size_t size = lead >= 0xF0 ? 4u : lead >= 0xE0 ? 3u : 2u;
    if (lead < 0xC2 || lead > 0xF4 || text.size() - at < size) return 0;
    std::uint32_t code = lead & (0x7Fu >> size);
    for (std::size_t i = 1; i < size; ++i) {
        const std::uint32_t next = byte_at(text, at + i);
        if ((next & 0xC0u) != 0x80u) return 0;
        code = code << 6 | (next & 0x3Fu);
    }
    if (size == 3 && (code < 0x800 || (code >= 0xD800 && code <= 0xDFFF))) return 0;
    if (size == 4 && (code < 0x10000 || code > 0x10FFFF)) return 0;
    return size;
}

void append_escaped(std::string& out, char character, bool at_end) {
    const auto code = static_cast<unsigned char>(character);
    if (character == '\\') {
        out += "\\\\";
    } else if (character == '\n') {
        out += "\\n";
    } else if (character == '\r') {
        out += "\\r";
    } else if (character == '\t') {
        out += "\\t";
    } else if (code < 0x20 || code == 0x7F || (character == ' ' && at_end)) {
        out += "\\x";
        out += kHexDigits[code >> 4];
        out += kHexDigits[code & 15u];
    } else {
        out += character;
    }
}

std::string escape_from(std::string_view text, std::size_t start) {
    std::string out(text.substr(0, start));
    for (std::size_t i = start; i < text.size(); ++i) {
        append_escaped(out, text[i], i == 0 || i + 1 == text.size());
    }
    return out;
}

}  // namespace

std::string_view text_fault(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        if (text[i] == '\0') return "holds a NUL byte";
        const std::size_t size = sequence_size(text, i);
        if (size == 0) return "is not valid UTF-8";
        i += size;
    }
    return {};
}

bool is_note_name(std::string_view name) {
    constexpr std::string_view kAllowed =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_.-";
    return !name.empty() && name.size() <= 64 &&
           name.find_first_not_of(kAllowed) == std::string_view::npos;
}

std::string escape(std::string_view text) {
    return escape_from(text, 0);
}

std::string escape_line(std::string_view text) {
    const std::size_t start = text.find_first_not_of(" \t");
    // A line of nothing but spaces would be cut off by editors, so its last one is escaped.
    if (start == std::string_view::npos)
        return text.empty() ? "" : escape_from(text, text.size() - 1);
    return escape_from(text, start);
}

std::optional<std::string> unescape(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\') {
            out += text[i];
            continue;
        }
        if (++i == text.size()) return std::nullopt;
        if (text[i] == '\\') {
            out += '\\';
        } else if (text[i] == 'n') {
            out += '\n';
        } else if (text[i] == 'r') {
            out += '\r';
        } else if (text[i] == 't') {
            out += '\t';
        } else if (text[i] == 'x' && text.size() - i > 2) {
            const std::size_t high = kHexDigits.find(text[i + 1]);
            const std::size_t low = kHexDigits.find(text[i + 2]);
            if (high == std::string_view::npos || low == std::string_view::npos)
                return std::nullopt;
            out += static_cast<char>(high << 4 | low);
            i += 2;
        } else {
            return std::nullopt;
        }
    }
    return out;
}

std::string quote(std::string_view text) {
    constexpr std::size_t kShown = 40;
    std::string out = "\"";
    for (const char character : text.substr(0, kShown)) {
        out += character >= ' ' && character <= '~' ? character : '?';
    }
    out += text.size() > kShown ? "...\"" : "\"";
    return out;
}

}  // namespace host_sim::detail
