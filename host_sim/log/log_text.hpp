// log_text.hpp - text rules shared by both formats: UTF-8, note names, escapes of CSV comments.
// Internal     to host_sim_log.      Normative  docs/spec/log-format.md, "Text".
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace host_sim::detail {

/// What is wrong with `text` as text of a log head, or empty: it must be valid UTF-8 (RFC 3629: no
/// overlong forms, no surrogates, at most U+10FFFF) without NUL.
std::string_view text_fault(std::string_view text);

/// True for 1 to 64 characters of A-Z a-z 0-9 _ . -
bool is_note_name(std::string_view name);

/// One line without control characters, without a space or tab at its ends: \\ \n \r \t \xHH.
std::string escape(std::string_view text);
/// The same, but spaces and tabs at the start stay as they are.
std::string escape_line(std::string_view text);
/// Undoes both; nothing if an escape is unknown or cut off.
std::optional<std::string> unescape(std::string_view text);

/// At most 40 bytes of `text` in quotes, unprintable ones as '?': for messages.
std::string quote(std::string_view text);

}  // namespace host_sim::detail
