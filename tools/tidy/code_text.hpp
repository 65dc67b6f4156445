// code_text.hpp - what the checks need to know of a C++ file, by text rules and not by parsing.
// Bounds       exact for comments and literals; functions and constant contexts are recognised by
//              their form, which the repository's formatting makes reliable.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tidy {

/// The lines of a text, without their ends. A last line without an end counts.
std::vector<std::string> split_lines(std::string_view text);

/// The same text with comments and the contents of string and character literals replaced by
/// blanks; every line keeps its number and length. Include paths in quotes are kept.
std::string blank_comments_and_literals(std::string_view text);

/// A function body: lines of its head's first and its closing brace, counted from 1.
struct FunctionSpan {
    std::string head;
    int first_line = 0;
    int last_line = 0;

    [[nodiscard]] int line_count() const { return last_line - first_line + 1; }
};

/// Structure of a blanked text.
struct CodeStructure {
    std::vector<FunctionSpan> functions;
    bool declares_functions = false;  ///< a declaration without a body stands somewhere
    std::vector<bool> constant_line;  ///< [line - 1]: everything there is computed at compile time
};

CodeStructure scan_structure(std::string_view blanked);

}  // namespace tidy
