// source_lines.cpp - see source_lines.hpp.
#include "toolchain/asm/source_lines.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace toolchain::assembly {
namespace {

bool is_name_start(char letter) {
    return std::isalpha(static_cast<unsigned char>(letter)) != 0 || letter == '_' ||
           letter == '?' || letter == '@' || letter == '.';
}

bool is_name_part(char letter) {
    return is_name_start(letter) || (letter >= '0' && letter <= '9');
}

bool is_register(std::string_view text) {
    constexpr std::array<std::string_view, 10> kRegisters = {"A", "B", "C", "D",  "E",
                                                             "H", "L", "M", "SP", "PSW"};
    return std::ranges::find(kRegisters, upper_case(text)) != kRegisters.end();
}

/// A name that needs no quotes.
bool is_plain(std::string_view text) {
    return !text.empty() && is_name_start(text.front()) &&
           std::ranges::all_of(text, is_name_part) && !is_register(text);
}

/// Takes the first word off `text`.
std::string_view take_word(std::string_view& text) {
    const std::size_t end = find_outside(text, " \t");
    const std::string_view word = text.substr(0, end);
    text = trimmed(text.substr(end));
    return word;
}

std::vector<std::string> split_operands(std::string_view text) {
    std::vector<std::string> operands;
    if (text.empty()) return operands;
    for (;;) {
        const std::size_t comma = find_outside(text, ",");
        operands.emplace_back(trimmed(text.substr(0, comma)));
        if (operands.back().empty()) throw Mistake("an operand is empty");
        if (comma == text.size()) return operands;
        text.remove_prefix(comma + 1);
    }
}

}  // namespace

SourceLine split_line(std::string_view text) {
    SourceLine line;
    const std::size_t comment = find_outside(text, ";");
    if (text.substr(comment).starts_with(";@")) line.note = trimmed(text.substr(comment + 2));
    text = trimmed(text.substr(0, comment));
    const std::size_t colon = find_outside(text, ":");
    if (colon != text.size()) {
        const std::string_view name = trimmed(text.substr(0, colon));
        text = trimmed(text.substr(colon + 1));
        if (!is_symbol(name)) throw Mistake("'" + std::string(name) + "' cannot be a label");
        line.label = symbol_name(name);
    }
    const std::string first(take_word(text));
    line.operation = upper_case(first);
    if (line.operation == "EQU" && !line.label.empty()) {
        throw Mistake("'" + line.label + "' is written without a colon in front of EQU");
    }
    std::string_view behind = text;
    if (upper_case(take_word(behind)) == "EQU") {
        if (!line.label.empty() || !is_symbol(first)) {
            throw Mistake("'" + first + "' cannot be the name of an EQU");
        }
        line.label = symbol_name(first);
        line.operation = "EQU";
        text = behind;
    }
    line.operands = split_operands(text);
    return line;
}

std::string upper_case(std::string_view text) {
    std::string upper(text);
    for (char& letter : upper) {
        letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    }
    return upper;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::size_t find_outside(std::string_view text, std::string_view wanted) {
    char quote = 0;
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char letter = text[i];
        if (quote != 0) {
            if (letter == quote) quote = 0;
            continue;
        }
        if (depth <= 0 && wanted.find(letter) != std::string_view::npos) return i;
        if (letter == '\'' || letter == '"') quote = letter;
        if (letter == '(') ++depth;
        if (letter == ')') --depth;
    }
    return text.size();
}

bool is_symbol(std::string_view text) {
    if (text.size() > 2 && text.front() == '"' && text.find('"', 1) == text.size() - 1) return true;
    return is_plain(text);
}

std::string symbol_name(std::string_view text) {
    if (text.starts_with('"')) return std::string(text.substr(1, text.size() - 2));
    return std::string(text);
}

std::string symbol_text(std::string_view name) {
    if (is_plain(name)) return std::string(name);
    return '"' + std::string(name) + '"';
}

std::optional<std::string> string_operand(std::string_view operand) {
    if (operand.size() < 2 || operand.front() != '\'' || operand.back() != '\'') return {};
    operand = operand.substr(1, operand.size() - 2);
    std::string text;
    for (std::size_t i = 0; i < operand.size(); ++i) {
        if (operand[i] == '\'') {
            if (i + 1 == operand.size() || operand[i + 1] != '\'') return {};  // 'A'+'B'
            ++i;
        }
        text += operand[i];
    }
    return text;
}

}  // namespace toolchain::assembly
