// code_text.cpp - blanks comments and literals; finds functions by matching braces.
#include "tools/tidy/code_text.hpp"

#include <algorithm>
#include <cctype>
#include <regex>

namespace tidy {
namespace {

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Walks a text once, copying code and blanking the rest.
class Blanker {
public:
    explicit Blanker(std::string_view text) : text_(text) {}

    std::string run() {
        while (at_ < text_.size()) step();
        return std::move(out_);
    }

private:
    [[nodiscard]] char peek(std::size_t ahead) const {
        return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
    }

    void copy() { out_ += text_[at_++]; }

    void blank() {
        out_ += text_[at_] == '\n' ? '\n' : ' ';
        ++at_;
    }

    void blank_to(std::size_t end) {
        while (at_ < std::min(end, text_.size())) blank();
    }

    void step() {
        const char c = peek(0);
        if (c == '/' && peek(1) == '/') {
            blank_to(text_.find('\n', at_));
        } else if (c == '/' && peek(1) == '*') {
            const std::size_t end = text_.find("*/", at_ + 2);
            blank_to(end == std::string_view::npos ? end : end + 2);
        } else if (c == '"') {
            string_literal();
        } else if (c == '\'' && !is_digit_separator()) {
            quoted('\'');
        } else {
            copy();
        }
    }

    void string_literal() {
        if (!out_.empty() && out_.back() == 'R') {
            raw_string();
        } else if (is_include_line()) {
            blank_free_quoted();
        } else {
            quoted('"');
        }
    }

    void raw_string() {
        const std::size_t open = text_.find('(', at_);
        if (open == std::string_view::npos) return quoted('"');
        std::string end(1, ')');
        end.append(text_.substr(at_ + 1, open - at_ - 1)).append(1, '"');
        const std::size_t close = text_.find(end, open);
        blank_to(close == std::string_view::npos ? close : close + end.size());
    }

    void quoted(char quote) {
        copy();
        while (at_ < text_.size() && text_[at_] != quote && text_[at_] != '\n') {
            if (text_[at_] == '\\') blank();
            if (at_ < text_.size()) blank();
        }
        if (at_ < text_.size()) copy();
    }

    void blank_free_quoted() {
        copy();
        while (at_ < text_.size() && text_[at_] != '"' && text_[at_] != '\n') copy();
        if (at_ < text_.size()) copy();
    }

    [[nodiscard]] bool is_include_line() const {
        const std::size_t start = out_.rfind('\n') + 1;  // npos + 1 is 0
        static const std::regex kInclude(R"(\s*#\s*include\s*)");
        return std::regex_match(out_.substr(start), kInclude);
    }

    /// 1'000 or 0xFF'FF, as opposed to 'a' or u8'a'.
    [[nodiscard]] bool is_digit_separator() const {
        std::size_t start = out_.size();
        while (start > 0 && (is_word(out_[start - 1]) || out_[start - 1] == '\'')) --start;
        return start < out_.size() && std::isdigit(static_cast<unsigned char>(out_[start])) != 0;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::string out_;
};

/// What a pair of braces encloses.
enum class Scope { container, function, control, initializer };

struct OpenScope {
    Scope kind = Scope::container;
    bool constant = false;
    std::string head;
    int first_line = 0;
};

bool matches(const std::string& head, const std::regex& pattern) {
    return std::regex_search(head, pattern);
}

/// A constexpr variable, also as the start of its initialiser; not `if constexpr`, not a function.
bool declares_constant(const std::string& head) {
    static const std::regex kConstexpr(R"(\bconstexpr\b)");
    static const std::regex kIfConstexpr(R"(\bif\s+constexpr\b)");
    return matches(head, kConstexpr) && !matches(head, kIfConstexpr);
}

bool is_evaluated_by_compiler(const std::string& head) {
    static const std::regex kEvaluated(R"(\b(static_assert|consteval)\b)");
    return matches(head, kEvaluated);
}

bool is_function_head(const std::string& head) {
    static const std::regex kFunction(R"(\)\s*((const|noexcept|override|final|mutable)\s*)*)"
                                      R"((->\s*[\w:<>,&*\s]+)?(requires\s.*)?$)");
    return matches(head, kFunction);
}

/// A head that ends at a semicolon: a function without its body, as opposed to data, an assertion
/// or a deleted function.
bool is_function_declaration(const std::string& head) {
    static const std::regex kOther(R"(\b(static_assert|using|typedef|friend)\b)");
    return is_function_head(head) && !matches(head, kOther) && head.find('=') == std::string::npos;
}

Scope classify(const std::string& head, bool inside_function) {
    static const std::regex kConstructor(R"(\)\s*:\s.*[)}]\s*$)");
    static const std::regex kContainer(R"(\b(namespace|class|struct|union|enum|extern)\b)");
    if (inside_function) return Scope::control;
    if (is_function_head(head) || matches(head, kConstructor)) return Scope::function;
    if (matches(head, kContainer)) return Scope::container;
    return Scope::initializer;
}

/// Walks blanked code once, keeping the stack of open braces.
class Scanner {
public:
    explicit Scanner(std::string_view code) : code_(code) {}

    CodeStructure run() {
        bool continued = false;
        for (const std::string& line : split_lines(code_)) {
            const bool preprocessor = continued || is_directive(line);
            continued = preprocessor && line.ends_with('\\');
            if (!preprocessor) {
                for (const char c : line) step(c);
            }
            end_line(preprocessor);
        }
        return std::move(result_);
    }

private:
    static bool is_directive(const std::string& line) {
        const std::size_t start = line.find_first_not_of(" \t");
        return start != std::string::npos && line[start] == '#';
    }

    void step(char c) {
        if (c == '{') {
            open();
        } else if (c == '}') {
            close();
        } else if (c == ';' && parentheses_ == 0) {
            note_constant();
            if (!inside_function() && is_function_declaration(head_)) {
                result_.declares_functions = true;
            }
            head_.clear();
        } else {
            if (c == '(') ++parentheses_;
            if (c == ')') parentheses_ = std::max(0, parentheses_ - 1);
            if (head_.empty() && c == ' ') return;
            if (head_.empty()) head_line_ = line_;
            head_ += c;
        }
    }

    void open() {
        note_constant();
        OpenScope scope;
        scope.kind = classify(head_, inside_function());
        scope.head = head_;
        scope.first_line = head_.empty() ? line_ : head_line_;
        const bool outer = !stack_.empty() && stack_.back().constant;
        const bool data = scope.kind != Scope::function;
        static const std::regex kEnum(R"(\benum\b)");
        scope.constant = outer || is_evaluated_by_compiler(head_) || matches(head_, kEnum) ||
                         (data && declares_constant(head_));
        stack_.push_back(scope);
        head_.clear();
        parentheses_ = 0;
        note_constant();
    }

    void close() {
        note_constant();
        head_.clear();
        if (stack_.empty()) return;
        const OpenScope scope = stack_.back();
        stack_.pop_back();
        if (scope.kind == Scope::function) {
            result_.functions.push_back({scope.head, scope.first_line, line_});
        } else if (scope.kind == Scope::initializer) {
            head_ = scope.head + "{}";  // the declaration goes on behind its initialiser
            head_line_ = scope.first_line;
        }
    }

    void end_line(bool preprocessor) {
        note_constant();
        result_.constant_line.push_back(constant_here_ && !preprocessor);
        constant_here_ = false;
        ++line_;
        if (!head_.empty()) head_ += ' ';
        note_constant();
    }

    /// A line counts as constant as soon as a constant statement or scope covers part of it.
    void note_constant() {
        const bool scope = !stack_.empty() && stack_.back().constant;
        const bool variable = head_.find('=') != std::string::npos && declares_constant(head_);
        if (scope || variable || is_evaluated_by_compiler(head_)) constant_here_ = true;
    }

    [[nodiscard]] bool inside_function() const {
        return std::any_of(stack_.begin(), stack_.end(),
                           [](const OpenScope& scope) { return scope.kind == Scope::function; });
    }

    std::string_view code_;
    CodeStructure result_;
    std::vector<OpenScope> stack_;
    std::string head_;
    int head_line_ = 1;
    int line_ = 1;
    int parentheses_ = 0;
    bool constant_here_ = false;
};

}  // namespace

std::vector<std::string> split_lines(std::string_view text) {
    std::vector<std::string> lines;
    std::size_t start = 0;
    while (start < text.size()) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        lines.emplace_back(text.substr(start, end - start));
        start = end + 1;
    }
    return lines;
}

std::string blank_comments_and_literals(std::string_view text) {
    return Blanker(text).run();
}

CodeStructure scan_structure(std::string_view blanked) {
    return Scanner(blanked).run();
}

}  // namespace tidy
