// file_checks.cpp - the rules that look at one file at a time.
#include "tools/tidy/file_checks.hpp"

#include <algorithm>

#include "tools/tidy/code_text.hpp"

namespace tidy {
namespace {

bool is_cpp(std::string_view path) {
    return path.ends_with(".hpp") || path.ends_with(".cpp");
}

/// Characters of UTF-8 text: bytes that do not continue another.
int length_in_characters(const std::string& line) {
    return static_cast<int>(std::count_if(line.begin(), line.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u;
    }));
}

/// One file with the views of it that the checks share.
class FileChecker {
public:
    FileChecker(const SourceFile& file, const Rules& rules)
        : file_(file), rules_(rules), raw_(split_lines(file.text)) {
        if (!is_cpp(file.path)) return;
        const std::string blanked = blank_comments_and_literals(file.text);
        code_ = split_lines(blanked);
        structure_ = scan_structure(blanked);
    }

    std::vector<Violation> run() {
        check_end();
        check_line_lengths();
        for (const ForbiddenPattern& entry : rules_.forbidden) check_forbidden(entry);
        if (is_cpp(file_.path)) {
            check_header();
            check_file_length();
            check_function_lengths();
        }
        return std::move(found_);
    }

private:
    void report(int line, const std::string& rule, const std::string& message) {
        if (!is_allowed(line, rule)) found_.push_back({file_.path, line, rule, message});
    }

    /// Looks for `tidy-allow(rule): reason` on the line and on the one above.
    [[nodiscard]] bool is_allowed(int line, const std::string& rule) const {
        const std::string mark = "tidy-allow(" + rule + "): ";
        for (int i = std::max(1, line - 1); i <= line && i <= line_count(); ++i) {
            if (raw_[static_cast<std::size_t>(i - 1)].find(mark) != std::string::npos) return true;
        }
        return false;
    }

    [[nodiscard]] int line_count() const { return static_cast<int>(raw_.size()); }

    void check_end() {
        if (!file_.text.empty() && !file_.text.ends_with('\n')) {
            report(line_count(), "final-newline", "the last line has no end");
        }
    }

    void check_line_lengths() {
        if (!ends_with_any(file_.path, rules_.line_length_files)) return;
        for (int line = 1; line <= line_count(); ++line) {
            const int length = length_in_characters(raw_[static_cast<std::size_t>(line - 1)]);
            if (length > rules_.line_length) {
                report(line, "line-length",
                       std::to_string(length) + " characters, at most " +
                           std::to_string(rules_.line_length));
            }
        }
    }

    /// A source may open with the header that has the comment instead.
    void check_header() {
        const std::string first = raw_.empty() ? std::string() : raw_[0];
        const bool own_header = file_.path.ends_with(".cpp") && first.starts_with("#include \"");
        if (!first.starts_with("// ") && !own_header) {
            report(1, "file-header", "begin with a comment: `// name - what this file is.`");
        }
        if (!file_.path.ends_with(".hpp")) return;
        const bool once = std::any_of(code_.begin(), code_.end(), [](const std::string& line) {
            return line.starts_with("#pragma once");
        });
        if (!once) report(1, "pragma-once", "a header needs #pragma once");
    }

    [[nodiscard]] bool is_generated() const {
        const auto end = raw_.begin() + std::min<std::ptrdiff_t>(5, std::ssize(raw_));
        return std::any_of(raw_.begin(), end, [&](const std::string& line) {
            return line.find(rules_.generated_mark) != std::string::npos;
        });
    }

    void check_file_length() {
        const FileLimit* limit = longest_match(rules_.file_limits, file_.path);
        if (limit == nullptr || is_generated()) return;
        const bool header = file_.path.ends_with(".hpp");
        const int lines = header ? limit->header_lines : limit->source_lines;
        if (line_count() > lines) {
            report(1, "file-length",
                   std::to_string(line_count()) + " lines, at most " + std::to_string(lines));
        }
    }

    void check_function_lengths() {
        const FunctionLimit* limit = longest_match(rules_.function_limits, file_.path);
        if (limit == nullptr) return;
        for (const FunctionSpan& function : structure_.functions) {
            if (function.line_count() <= limit->lines) continue;
            report(function.first_line, "function-length",
                   std::to_string(function.line_count()) + " lines, at most " +
                       std::to_string(limit->lines));
        }
    }

    void check_forbidden(const ForbiddenPattern& entry) {
        if (!ends_with_any(file_.path, entry.files) || !under_any(file_.path, entry.paths)) return;
        if (under_any(file_.path, entry.except)) return;
        const std::vector<std::string>& lines = entry.raw ? raw_ : code_;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            if (!std::regex_search(lines[i], entry.pattern)) continue;
            if (entry.exempt_pattern && std::regex_search(lines[i], *entry.exempt_pattern))
                continue;
            if (entry.constants_ok && structure_.constant_line[i]) continue;
            report(static_cast<int>(i) + 1, entry.rule, entry.message);
        }
    }

    const SourceFile& file_;
    const Rules& rules_;
    std::vector<std::string> raw_;
    std::vector<std::string> code_;
    CodeStructure structure_;
    std::vector<Violation> found_;
};

}  // namespace

std::vector<Violation> check_file(const SourceFile& file, const Rules& rules) {
    return FileChecker(file, rules).run();
}

}  // namespace tidy
