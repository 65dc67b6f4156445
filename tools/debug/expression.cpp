// expression.cpp - see expression.hpp.
#include "tools/debug/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "tools/debug/arguments.hpp"
#include "tools/debug/debug_error.hpp"

namespace debug_console {

using host_sim::BoardState;

namespace {

std::string_view trim(std::string_view text) {
    constexpr std::string_view kSpaces = " \t";
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(kSpaces)));
    return text.substr(0, text.find_last_not_of(kSpaces) + 1);
}

/// Where the term at the front of `text` ends: at a + or - outside of brackets and quotes.
std::size_t term_end(std::string_view text) {
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '\'') {
            i += 2;
        } else if (text[i] == '[') {
            ++depth;
        } else if (text[i] == ']') {
            --depth;
        } else if (depth == 0 && i > 0 && (text[i] == '+' || text[i] == '-')) {
            return i;
        }
    }
    return text.size();
}

/// Where the word "and", on its own, begins.
std::size_t find_and(std::string_view text) {
    for (std::size_t i = 1; i + 4 < text.size(); ++i) {
        if (text[i - 1] == ' ' && text[i + 3] == ' ' && same_word(text.substr(i, 3), "and")) {
            return i;
        }
    }
    return std::string_view::npos;
}

uint8_t byte_at(const BoardState& state, int64_t address) {
    return state.memory.bytes[static_cast<uint16_t>(address)];
}

}  // namespace

Expression Expression::parse(std::string_view text, const Names& names) {
    std::string_view rest = trim(text);
    Expression expression;
    bool subtract = false;
    if (rest.starts_with('-')) {
        subtract = true;
        rest = trim(rest.substr(1));
    }
    while (true) {
        const std::size_t end = term_end(rest);
        const std::string_view part = trim(rest.substr(0, end));
        if (part.empty()) throw DebugError(fmt::format("\"{}\": a value is missing", text));
        expression.terms_.push_back(parse_term(part, names));
        expression.terms_.back().subtract = subtract;
        if (end >= rest.size()) return expression;
        subtract = rest[end] == '-';
        rest = trim(rest.substr(end + 1));
    }
}

Expression::Term Expression::parse_term(std::string_view text, const Names& names) {
    Term term;
    const bool word = text.size() > 4 && same_word(text.substr(0, 4), "word") && text[4] == '[';
    const std::string_view bracket = word ? text.substr(4) : text;
    if (bracket.starts_with('[') && bracket.ends_with(']')) {
        term.kind = word ? Term::Kind::word : Term::Kind::byte;
        term.address.push_back(parse(bracket.substr(1, bracket.size() - 2), names));
    } else if (same_word(text, "M")) {
        term.kind = Term::Kind::byte;
        term.address.push_back(parse("HL", names));
    } else if (const auto number = parse_number(text)) {
        term.number = *number;
    } else if (const auto which = find_register(text)) {
        term.kind = Term::Kind::name;
        term.which = *which;
    } else if (const auto address = names.find(text)) {
        term.number = *address;
    } else {
        throw DebugError(
            fmt::format("{}: no number, register or symbol (`symbols` lists those loaded)", text));
    }
    return term;
}

int64_t Expression::term_value(const Term& term, const BoardState& state) {
    switch (term.kind) {
        case Term::Kind::number:
            return term.number;
        case Term::Kind::name:
            return register_value(state.cpu, term.which);
        case Term::Kind::byte:
            return byte_at(state, term.address.front().value(state));
        case Term::Kind::word:
            break;
    }
    const int64_t address = term.address.front().value(state);
    return byte_at(state, address) | byte_at(state, address + 1) << 8;
}

int64_t Expression::value(const BoardState& state) const {
    uint64_t sum = 0;  // unsigned, so that nothing a person types overflows
    for (const Term& term : terms_) {
        const auto part = static_cast<uint64_t>(term_value(term, state));
        sum = term.subtract ? sum - part : sum + part;
    }
    return static_cast<int64_t>(sum);
}

Condition Condition::parse(std::string_view text, const Names& names) {
    Condition condition;
    condition.text_ = trim(text);
    std::string_view rest = condition.text_;
    while (true) {
        const std::size_t end = find_and(rest);
        condition.comparisons_.push_back(parse_comparison(rest.substr(0, end), names));
        if (end == std::string_view::npos) return condition;
        rest = rest.substr(end + 3);
    }
}

Condition::Comparison Condition::parse_comparison(std::string_view text, const Names& names) {
    struct Sign {
        std::string_view text;
        Operator how;
    };
    constexpr std::array kSigns = {
        Sign{"==", Operator::equal},      Sign{"!=", Operator::unequal},
        Sign{"<=", Operator::less_equal}, Sign{">=", Operator::greater_equal},
        Sign{"<", Operator::less},        Sign{">", Operator::greater},
    };
    for (const Sign& sign : kSigns) {
        const std::size_t at = text.find(sign.text);
        if (at == std::string_view::npos) continue;
        return {Expression::parse(text.substr(0, at), names), sign.how,
                Expression::parse(text.substr(at + sign.text.size()), names)};
    }
    throw DebugError(fmt::format(
        "\"{}\": no condition; compare two values, like A == 5, with == != < <= > >=", text));
}

bool Condition::holds(const BoardState& state) const {
    return std::ranges::all_of(comparisons_, [&state](const Comparison& comparison) {
        const int64_t left = comparison.left.value(state);
        const int64_t right = comparison.right.value(state);
        switch (comparison.how) {
            case Operator::equal:
                return left == right;
            case Operator::unequal:
                return left != right;
            case Operator::less:
                return left < right;
            case Operator::less_equal:
                return left <= right;
            case Operator::greater:
                return left > right;
            case Operator::greater_equal:
                break;
        }
        return left >= right;
    });
}

}  // namespace debug_console
