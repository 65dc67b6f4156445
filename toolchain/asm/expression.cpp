// expression.cpp - see expression.hpp.
#include "toolchain/asm/expression.hpp"

#include <algorithm>

#include "toolchain/asm/source_lines.hpp"

namespace toolchain::assembly {
namespace {

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

int digit_value(char digit) {
    if (is_digit(digit)) return digit - '0';
    return digit >= 'A' && digit <= 'F' ? digit - 'A' + 10 : 99;
}

int32_t number(std::string_view text) {
    const std::string shown(text);
    const std::string upper = upper_case(text);
    const char suffix = upper.back();
    const int base = suffix == 'H' ? 16 : suffix == 'B' ? 2 : 10;
    const std::string digits = base == 10 ? upper : upper.substr(0, upper.size() - 1);
    int32_t value = 0;
    for (const char digit : digits) {
        if (digit_value(digit) >= base) throw Mistake("'" + shown + "' is not a number");
        value = value * base + digit_value(digit);
        if (value > 65535) throw Mistake("'" + shown + "' is beyond 16 bits");
    }
    return value;
}

void check_range(int32_t value, std::string_view expression) {
    if (value < -32768 || value > 65535) {
        throw Mistake("'" + std::string(expression) + "' is beyond 16 bits");
    }
}

/// Takes addresses of the same section with opposite signs together.
void cancel(Value& value) {
    for (std::size_t i = 0; i < value.bases.size(); ++i) {
        const Base& one = value.bases[i];
        for (std::size_t j = i + 1; j < value.bases.size(); ++j) {
            const Base& other = value.bases[j];
            const bool same = one.section ? one.section == other.section
                                          : !other.section && one.symbol == other.symbol;
            if (!same || one.negative == other.negative) continue;
            const int32_t difference = one.offset - other.offset;
            value.number += one.negative ? -difference : difference;
            value.bases.erase(value.bases.begin() + static_cast<std::ptrdiff_t>(j));
            value.bases.erase(value.bases.begin() + static_cast<std::ptrdiff_t>(i));
            cancel(value);
            return;
        }
    }
}

class Evaluation {
public:
    explicit Evaluation(const Names& names) : names_(names) {}

    [[nodiscard]] Value sum(std::string_view expression) const {
        Value total;
        std::string_view rest = trimmed(expression);
        bool negative = false;
        bool single = true;
        if (!rest.empty() && rest.front() == '-') {
            negative = true;
            rest = trimmed(rest.substr(1));
        }
        for (;;) {
            const std::size_t end = find_outside(rest, "+-");
            const Value next = term(trimmed(rest.substr(0, end)));
            single = single && end == rest.size() && !negative;
            if (next.part != Part::word && !single) {
                throw Mistake("LOW or HIGH of an address stands alone, as LOW(TABLE+1)");
            }
            add(total, next, negative);
            if (end == rest.size()) break;
            negative = rest[end] == '-';
            rest = trimmed(rest.substr(end + 1));
            single = false;
        }
        simplify(total, expression);
        return total;
    }

private:
    static void add(Value& total, const Value& next, bool negative) {
        total.number += negative ? -next.number : next.number;
        for (Base base : next.bases) {
            base.negative = base.negative != negative;
            total.bases.push_back(base);
        }
        total.part = next.part;
    }

    void simplify(Value& value, std::string_view expression) const {
        cancel(value);
        const bool relocatable =
            value.bases.empty() || (value.bases.size() == 1 && !value.bases[0].negative);
        if (!relocatable) {
            for (const Base& base : value.bases) {
                const auto start = base.section ? names_.address(*base.section) : std::nullopt;
                if (!start) {
                    throw Mistake("'" + std::string(expression) +
                                  "' is neither a number nor one address plus a number");
                }
                value.number += base.negative ? -(*start + base.offset) : *start + base.offset;
            }
            value.bases.clear();
        }
        if (value.bases.empty()) check_range(value.number, expression);
    }

    [[nodiscard]] Value part_of(std::string_view text, Part part) const {
        Value value = sum(text.substr(text.find('(') + 1, text.size() - text.find('(') - 2));
        if (value.part != Part::word) throw Mistake("LOW and HIGH do not nest");
        if (!value.bases.empty()) {
            value.part = part;
        } else {
            const auto word = static_cast<uint16_t>(value.number);
            value.number = part == Part::low ? word & 0xFF : word >> 8;
        }
        return value;
    }

    [[nodiscard]] Value term(std::string_view text) const {
        if (text.empty()) throw Mistake("an expression lacks a number");
        if (text == "$") return names_.here();
        if (text.back() == ')') {
            const std::string function = upper_case(trimmed(text.substr(0, text.find('('))));
            if (function == "LOW") return part_of(text, Part::low);
            if (function == "HIGH") return part_of(text, Part::high);
            if (text.front() == '(') return sum(text.substr(1, text.size() - 2));
        }
        if (const auto character = string_operand(text)) {
            if (character->size() != 1) throw Mistake(std::string(text) + " is not one character");
            return {static_cast<unsigned char>(character->front())};
        }
        if (is_digit(text.front())) return {number(text)};
        // A register's name cannot be defined, so it ends here too.
        return names_.symbol(symbol_name(text));
    }

    const Names& names_;
};

}  // namespace

Value evaluate(std::string_view expression, const Names& names) {
    return Evaluation(names).sum(expression);
}

}  // namespace toolchain::assembly
