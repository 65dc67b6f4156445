// flow_facts.cpp - see flow_facts.hpp.
#include "tools/bounds/flow_facts.hpp"

#include <fnmatch.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "tools/budget/budget_error.hpp"

namespace rover_bounds {
namespace {

bool is_number(std::string_view word) {
    constexpr std::size_t kDigitsMax = 9;
    return !word.empty() && word.size() <= kDigitsMax &&
           std::ranges::all_of(word, [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// Reads one line; every refusal is of that line.
class LineReader {
public:
    LineReader(const std::string& line, std::string_view file, std::size_t number)
        : line_(line), file_(file), number_(number) {}

    void read(FlowTable& table) const {
        const std::size_t first = line_.find(',');
        const std::size_t second = first == std::string::npos ? first : line_.find(',', first + 1);
        if (second == std::string::npos || second + 1 == line_.size()) fail("has no reason");
        const std::string kind = line_.substr(0, first);
        const std::string text = line_.substr(first + 1, second - first - 1);
        const std::string reason = line_.substr(second + 1);
        if (kind == "fact") {
            table.facts.push_back(fact(text, reason));
        } else if (kind == "turns" || kind == "endless" || kind == "waits") {
            table.loops.push_back(rule(kind, text, reason));
        } else {
            fail("begins with no known word");
        }
    }

private:
    [[noreturn]] void fail(const char* what) const {
        throw rover_budget::BudgetError(
            file_, number_, what,
            "write `fact,SUM <= SUM,reason`, `turns,LOOP N,reason`, `endless,LOOP,reason` or "
            "`waits,LOOP,reason`");
    }

    [[nodiscard]] FlowItem item(const std::string& word) const {
        const std::size_t mark = word.rfind('#');
        if (mark == std::string::npos) return {word, {}};
        const std::string digits = word.substr(mark + 1);
        if (!is_number(digits)) fail("has a loop without a number");
        return {word.substr(0, mark), static_cast<unsigned>(std::stoul(digits))};
    }

    [[nodiscard]] LoopRule rule(const std::string& kind, const std::string& text,
                                const std::string& reason) const {
        LoopRule rule;
        rule.kind = kind == "turns"     ? LoopKind::turns
                    : kind == "endless" ? LoopKind::endless
                                        : LoopKind::waits;
        rule.reason = reason;
        rule.line = number_;
        std::istringstream words(text);
        std::string word;
        if (!(words >> word)) fail("names no loop");
        rule.item = item(word);
        if (!rule.item.loop) fail("names no loop");
        if (rule.kind == LoopKind::turns) {
            if (!(words >> word) || !is_number(word)) fail("has no number of turns");
            rule.turns = static_cast<uint32_t>(std::stoul(word));
        }
        if (words >> word) fail("says more than a loop and its turns");
        return rule;
    }

    [[nodiscard]] FlowFact fact(const std::string& text, const std::string& reason) const {
        FlowFact fact;
        fact.text = text;
        fact.reason = reason;
        fact.line = number_;
        std::istringstream words(text);
        int64_t side = 1;
        int64_t number = 0;  // read, and neither a factor nor a constant yet; 0: none
        const auto end_term = [&] {
            fact.most -= side * number;
            number = 0;
        };
        for (std::string word; words >> word;) {
            if (word == "+") {
                end_term();
            } else if (word == "<=") {
                end_term();
                if (side < 0) fail("has two signs <=");
                side = -1;
            } else if (is_number(word)) {
                number = std::stoll(word);
            } else {
                fact.terms.push_back({side * std::max<int64_t>(number, 1), item(word)});
                number = 0;
            }
        }
        end_term();
        if (side > 0 || fact.terms.empty()) fail("is no fact");
        return fact;
    }

    const std::string& line_;
    std::string_view file_;
    std::size_t number_;
};

}  // namespace

bool FlowItem::fits(std::string_view function) const {
    return fnmatch(pattern.c_str(), std::string(function).c_str(), FNM_NOESCAPE) == 0;
}

FlowTable parse_flow(std::string_view text, std::string_view file) {
    FlowTable table;
    table.file = file;
    std::istringstream lines{std::string(text)};
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        if (line.empty() || line.starts_with('#') || line.starts_with("kind,")) continue;
        LineReader(line, file, number).read(table);
    }
    return table;
}

}  // namespace rover_bounds
