// reviewed.cpp - see reviewed.hpp.
#include "tools/budget/reviewed.hpp"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tools/budget/budget_error.hpp"

namespace rover_budget {
namespace {

std::optional<uint64_t> find(const Numbers& numbers, std::string_view name) {
    const auto found = numbers.find(name);
    if (found == numbers.end()) return {};
    return found->second;
}

}  // namespace

std::vector<Difference> differences(const Numbers& before, const Numbers& now) {
    std::set<std::string> names;
    for (const auto& [name, value] : before) names.insert(name);
    for (const auto& [name, value] : now) names.insert(name);
    std::vector<Difference> found;
    for (const std::string& name : names) {
        const auto old_value = find(before, name);
        const auto new_value = find(now, name);
        if (old_value != new_value) found.push_back({name, old_value, new_value});
    }
    return found;
}

std::string describe(const Difference& difference) {
    const auto& [name, before, now] = difference;
    if (!before) return fmt::format("{}  new: {}", name, *now);
    if (!now) return fmt::format("{}  {} -> gone", name, *before);
    const auto change = static_cast<int64_t>(*now) - static_cast<int64_t>(*before);
    const std::string percent =
        *before == 0 ? ""
                     : fmt::format(", {:+.1f} %", 100.0 * static_cast<double>(change) /
                                                      static_cast<double>(*before));
    return fmt::format("{}  {} -> {}  ({:+}{})", name, *before, *now, change, percent);
}

Numbers parse_numbers(std::string_view text, std::string_view file) {
    constexpr const char* kAdvice = "give a file that `rover85 budget` has written";
    const auto document = nlohmann::json::parse(text, nullptr, false);
    if (document.is_discarded() || !document.is_object() || !document.contains("numbers") ||
        !document["numbers"].is_object()) {
        throw BudgetError(file, 0, "holds no numbers of a budget", kAdvice);
    }
    Numbers numbers;
    for (const auto& [name, value] : document["numbers"].items()) {
        if (!value.is_number_unsigned()) {
            throw BudgetError(file, 0, name + " is not a whole number", kAdvice);
        }
        numbers[name] = value.get<uint64_t>();
    }
    return numbers;
}

std::string reviewed_text(const Numbers& numbers, std::string_view command, std::string_view page) {
    const nlohmann::ordered_json document = {
        {"about", fmt::format("Reviewed numbers of the image: `{0}` fails while one differs, "
                              "`{0} --update` writes them. {1}",
                              command, page)},
        {"numbers", numbers}};
    return document.dump(2) + "\n";
}

std::optional<uint64_t> Limit::value(const Numbers& numbers) const {
    return find(numbers, number);
}

bool Limit::holds(const Numbers& numbers) const {
    const auto now = value(numbers);
    return now && *now <= most;
}

std::vector<Limit> parse_limits(std::string_view text, std::string_view file) {
    std::vector<Limit> limits;
    std::istringstream lines{std::string(text)};
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        if (line.empty() || line.starts_with('#')) continue;
        const std::size_t first = line.find(',');
        const std::size_t second = first == std::string::npos ? first : line.find(',', first + 1);
        Limit limit;
        const char* const end = second == std::string::npos ? nullptr : line.data() + second;
        if (end != nullptr) {
            limit.number = line.substr(0, first);
            limit.what = line.substr(second + 1);
            const auto [at, error] = std::from_chars(line.data() + first + 1, end, limit.most);
            if (error == std::errc() && at == end && !limit.number.empty() && !limit.what.empty()) {
                limits.push_back(std::move(limit));
                continue;
            }
        }
        throw BudgetError(file, number, "is no line of the limits", "write `name,most,text`");
    }
    return limits;
}

}  // namespace rover_budget
