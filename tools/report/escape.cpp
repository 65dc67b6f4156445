#include "tools/report/escape.hpp"

#include <nlohmann/json.hpp>

namespace report {

std::string html(std::string_view text) {
    std::string out;
    out.reserve(text.size() + text.size() / 8);
    for (const char c : text) {
        switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            default: {
                const auto byte = static_cast<unsigned char>(c);
                const bool is_control = (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7F;
                if (!is_control) out += c;
            }
        }
    }
    return out;
}

std::string script_json(std::string_view text) {
    // Pure ASCII output, so U+2028 and U+2029 are \u escapes already.
    const std::string literal = nlohmann::json(std::string(text))
                                    .dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    std::string out;
    out.reserve(literal.size());
    for (const char c : literal) {
        switch (c) {
            case '<':
                out += "\\u003c";
                break;
            case '>':
                out += "\\u003e";
                break;
            case '&':
                out += "\\u0026";
                break;
            default:
                out += c;
        }
    }
    return out;
}

}  // namespace report
