// escape.hpp - text from a log on its way into a page: nothing in it may become markup or script.
// Depends on   the standard library and nlohmann-json (in the source).
#pragma once

#include <string>
#include <string_view>

namespace report {

/// Text for element content or a quoted attribute: & < > " ' become character references; control
/// characters other than tab and line feed are dropped.
std::string html(std::string_view text);

/// A JSON string literal, quotes included, that is safe inside a script element: no < > & and no
/// line separators appear in it. Bytes that are not UTF-8 become U+FFFD.
std::string script_json(std::string_view text);

}  // namespace report
