// rules.hpp - the table of rules, read from rules.toml, and what a check reports.
// Depends on   toml++ (in rules.cpp only).
#pragma once

#include <optional>
#include <regex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace tidy {

/// One finding. `line` counts from 1; 0 means the file as a whole.
struct Violation {
    std::string file;
    int line = 0;
    std::string rule;
    std::string message;
};

/// A tracked file: path relative to the root with '/', whole content.
struct SourceFile {
    std::string path;
    std::string text;
};

/// The rule table cannot be used; what() names line and key.
struct RuleError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

struct FunctionLimit {
    std::string path;
    int lines = 0;
};

struct FileLimit {
    std::string path;
    int header_lines = 0;
    int source_lines = 0;
};

struct Layer {
    std::string path;
    std::vector<std::string> may_include;
};

struct ForbiddenPattern {
    std::string rule;
    std::regex pattern;
    std::optional<std::regex> exempt_pattern;  ///< a line that matches this too is fine
    std::vector<std::string> paths;            ///< prefixes; "" is everywhere
    std::vector<std::string> except;           ///< prefixes left out
    std::vector<std::string> files;            ///< endings; default .hpp and .cpp
    bool raw = false;                          ///< sees comments and strings too
    bool constants_ok = false;                 ///< allowed in constant expressions
    std::string message;
};

struct Exemption {
    std::string path;  ///< a file, or a folder when it ends in '/'
    std::string rule;
    std::string reason;
};

struct Rules {
    int line_length = 0;
    std::vector<std::string> line_length_files;
    std::string generated_mark;
    std::vector<FunctionLimit> function_limits;
    std::vector<FileLimit> file_limits;
    std::vector<std::string> include_directories;
    std::vector<std::string> generated_includes;
    std::vector<Layer> layers;
    std::vector<std::string> mirror_paths;
    std::vector<ForbiddenPattern> forbidden;
    std::vector<Exemption> exemptions;
};

/// Reads the table.
/// @errors  RuleError on bad TOML, a missing key, an invalid pattern or an exemption without reason
Rules parse_rules(std::string_view toml);

/// The entry whose `path` is the longest prefix of `file`; nullptr when none is.
template <class Entry>
const Entry* longest_match(const std::vector<Entry>& entries, std::string_view file) {
    const Entry* best = nullptr;
    for (const Entry& entry : entries) {
        const bool longer = best == nullptr || entry.path.size() > best->path.size();
        if (file.starts_with(entry.path) && longer) best = &entry;
    }
    return best;
}

/// Whether `file` starts with any of the prefixes.
bool under_any(std::string_view file, const std::vector<std::string>& prefixes);

/// Whether `file` ends with any of the endings.
bool ends_with_any(std::string_view file, const std::vector<std::string>& endings);

/// Removes what the exemptions cover; adds a violation `stale-exemption` for each exemption that
/// covered nothing, so that the table stays true.
std::vector<Violation> apply_exemptions(std::vector<Violation> violations, const Rules& rules);

}  // namespace tidy
