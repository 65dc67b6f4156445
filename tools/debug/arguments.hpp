// arguments.hpp - the words behind a command, taken one by one.
// Depends on   the standard library.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace debug_console {

/// A number as people write it: 0A3H and 0x00A3 (hexadecimal), 1010B (binary), 163 (decimal),
/// 'A' (a character). A hexadecimal number with H begins with a digit, so no name is mistaken for
/// one.
/// @return nothing when `text` is not a number or has more than 63 bits
[[nodiscard]] std::optional<int64_t> parse_number(std::string_view text);

/// A point in time in T-states: "5000" is absolute, "+500" from `now_t` on; with the suffixes us,
/// ms and s ("+2.5ms") a time at 3.072 MHz, rounded down to a whole T-state.
/// @errors DebugError when it is none
[[nodiscard]] uint64_t parse_time(std::string_view text, uint64_t now_t);

/// The line without a comment: a # at its beginning or behind a space, outside of quotes.
[[nodiscard]] std::string_view without_comment(std::string_view line);

/// Takes words from the front of a line. Words are separated by spaces or commas.
class Arguments {
public:
    explicit Arguments(std::string_view line);

    [[nodiscard]] bool empty() const { return rest_.empty(); }
    /// What has not been taken yet, as written.
    [[nodiscard]] std::string_view rest() const { return rest_; }
    /// The next word, without taking it; empty at the end.
    [[nodiscard]] std::string_view peek() const;
    /// @param meaning  what the word should have been, for the message
    /// @errors DebugError when there is none
    std::string word(std::string_view meaning);
    /// Takes the next word if it is `text`, in any case of letters.
    bool take(std::string_view text);
    /// Takes everything.
    std::string take_rest();
    /// Takes a string in double quotes, if one comes next: \n, \r, \t, \\, \" and \xHH stand for
    /// bytes. @errors DebugError when it has no end or an unknown escape
    std::optional<std::string> take_quoted();
    /// @errors DebugError naming what was not understood, unless everything is taken
    void expect_end() const;

private:
    void skip_separators();
    std::string_view rest_;
};

/// Whether two words are equal but for the case of letters.
[[nodiscard]] bool same_word(std::string_view one, std::string_view other);

/// Bytes as a string in double quotes that take_quoted reads back.
[[nodiscard]] std::string quote(std::string_view bytes);

}  // namespace debug_console
