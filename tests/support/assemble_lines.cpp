// assemble_lines.cpp - see assemble_lines.hpp.
#include "tests/support/assemble_lines.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "tests/support/assemble.hpp"

namespace test_support {
namespace {

bool is_name_start(char letter) {
    return std::isalpha(static_cast<unsigned char>(letter)) != 0 || letter == '_' ||
           letter == '?' || letter == '@';
}

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Position of the first of `wanted` outside of quotes, or the size.
std::size_t find_unquoted(std::string_view text, std::string_view wanted) {
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\'') quoted = !quoted;
        if (!quoted && wanted.find(text[i]) != std::string_view::npos) return i;
    }
    return text.size();
}

/// Takes the first word off `text`.
std::string_view take_word(std::string_view& text) {
    const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
    const std::string_view word = text.substr(0, end);
    text = trimmed(text.substr(end));
    return word;
}

std::vector<std::string> split_operands(std::string_view text, std::size_t line) {
    std::vector<std::string> operands;
    if (text.empty()) return operands;
    for (;;) {
        const std::size_t comma = find_unquoted(text, ",");
        operands.emplace_back(trimmed(text.substr(0, comma)));
        if (operands.back().empty()) throw AssembleError(line, "an operand is empty");
        if (comma == text.size()) return operands;
        text.remove_prefix(comma + 1);
    }
}

SourceLine split_line(std::string_view text, std::size_t number) {
    SourceLine line;
    line.number = number;
    text = trimmed(text.substr(0, find_unquoted(text, ";")));
    const std::size_t colon = find_unquoted(text, ":");
    if (colon != text.size()) {
        line.label = trimmed(text.substr(0, colon));
        text = trimmed(text.substr(colon + 1));
        if (!is_symbol(line.label)) {
            throw AssembleError(number, "'" + line.label + "' cannot be a label");
        }
    }
    const std::string first(take_word(text));
    line.operation = upper_case(first);
    if (line.operation == "EQU" && !line.label.empty()) {
        throw AssembleError(number,
                            "'" + line.label + "' is written without a colon in front of EQU");
    }
    std::string_view behind = text;
    if (upper_case(take_word(behind)) == "EQU") {
        if (!line.label.empty() || !is_symbol(first)) {
            throw AssembleError(number, "'" + first + "' cannot be the name of an EQU");
        }
        line.label = first;
        line.operation = "EQU";
        text = behind;
    }
    line.operands = split_operands(text, number);
    return line;
}

}  // namespace

std::vector<SourceLine> split_source(std::string_view source) {
    std::vector<SourceLine> lines;
    for (std::size_t number = 1; !source.empty(); ++number) {
        const std::size_t end = std::min(source.find('\n'), source.size());
        lines.push_back(split_line(source.substr(0, end), number));
        source.remove_prefix(std::min(end + 1, source.size()));
        if (lines.back().operation == "END") break;
    }
    return lines;
}

std::string upper_case(std::string_view text) {
    std::string upper(text);
    for (char& letter : upper) {
        letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    }
    return upper;
}

bool is_symbol(std::string_view text) {
    constexpr std::array<std::string_view, 10> kRegisters = {"A", "B", "C", "D",  "E",
                                                             "H", "L", "M", "SP", "PSW"};
    if (text.empty() || !is_name_start(text.front())) return false;
    if (std::ranges::find(kRegisters, upper_case(text)) != kRegisters.end()) return false;
    return std::ranges::all_of(
        text, [](char letter) { return is_name_start(letter) || is_digit(letter); });
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

int Evaluator::value(std::string_view expression) const {
    int sum = 0;
    bool negative = false;
    std::string_view rest = trimmed(expression);
    if (!rest.empty() && rest.front() == '-') {
        negative = true;
        rest = trimmed(rest.substr(1));
    }
    for (;;) {
        const std::size_t end = find_unquoted(rest, "+-");
        const int next = term(trimmed(rest.substr(0, end)));
        sum += negative ? -next : next;
        if (end == rest.size()) break;
        negative = rest[end] == '-';
        rest = trimmed(rest.substr(end + 1));
    }
    if (sum < -32768 || sum > 65535) {
        throw AssembleError(line_, "'" + std::string(expression) + "' is beyond 16 bits");
    }
    return sum;
}

int Evaluator::term(std::string_view text) const {
    const std::string shown(text);
    if (text.empty()) throw AssembleError(line_, "an expression lacks a number");
    if (text == "$") return here_;
    if (const auto character = string_operand(text)) {
        if (character->size() == 1) return static_cast<unsigned char>(character->front());
        throw AssembleError(line_, shown + " is not one character");
    }
    if (!is_digit(text.front())) {
        const auto found = symbols_.find(shown);
        if (found != symbols_.end()) return found->second;
        throw AssembleError(line_, "'" + shown + "' is not defined");
    }
    const std::string upper = upper_case(text);
    const char suffix = upper.back();
    const int base = suffix == 'H' ? 16 : suffix == 'B' ? 2 : 10;
    const std::string digits = base == 10 ? upper : upper.substr(0, upper.size() - 1);
    int number = 0;
    for (const char digit : digits) {
        const int worth = is_digit(digit)                ? digit - '0'
                          : digit >= 'A' && digit <= 'F' ? digit - 'A' + 10
                                                         : 99;
        if (worth >= base) throw AssembleError(line_, "'" + shown + "' is not a number");
        number = number * base + worth;
        if (number > 65535) throw AssembleError(line_, "'" + shown + "' is beyond 16 bits");
    }
    return number;
}

}  // namespace test_support
