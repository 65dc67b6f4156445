// rules.cpp - reads rules.toml.
#include "tools/tidy/rules.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <sstream>

namespace tidy {
namespace {

[[noreturn]] void fail(const toml::node& where, const std::string& what) {
    std::ostringstream text;
    text << "line " << where.source().begin.line << ": " << what;
    throw RuleError(text.str());
}

template <class T>
T required(const toml::table& table, std::string_view key) {
    const std::optional<T> value = table[key].value<T>();
    if (!value) fail(table, "missing or mistyped key '" + std::string(key) + "'");
    return *value;
}

std::vector<std::string> strings(const toml::table& table, std::string_view key) {
    std::vector<std::string> result;
    const toml::array* list = table[key].as_array();
    if (list == nullptr) return result;
    for (const toml::node& item : *list) {
        const std::optional<std::string> text = item.value<std::string>();
        if (!text) fail(item, "'" + std::string(key) + "' must hold strings");
        result.push_back(*text);
    }
    return result;
}

std::vector<std::string> required_strings(const toml::table& table, std::string_view key) {
    std::vector<std::string> result = strings(table, key);
    if (result.empty()) fail(table, "missing or empty list '" + std::string(key) + "'");
    return result;
}

std::regex pattern(const toml::table& table, std::string_view key) {
    try {
        return std::regex(required<std::string>(table, key), std::regex::optimize);
    } catch (const std::regex_error& error) {
        fail(table, std::string("bad pattern: ") + error.what());
    }
}

/// Calls `read` with every table of an array of tables; an absent array is empty.
template <class Read>
void each(const toml::node_view<const toml::node>& view, Read read) {
    const toml::array* list = view.as_array();
    if (list == nullptr) return;
    for (const toml::node& item : *list) {
        const toml::table* table = item.as_table();
        if (table == nullptr) fail(item, "a table is expected here");
        read(*table);
    }
}

ForbiddenPattern read_forbidden(const toml::table& table) {
    ForbiddenPattern entry;
    entry.rule = required<std::string>(table, "rule");
    entry.pattern = pattern(table, "pattern");
    if (table.contains("exempt_pattern")) entry.exempt_pattern = pattern(table, "exempt_pattern");
    entry.paths = required_strings(table, "paths");
    entry.except = strings(table, "except");
    entry.files = strings(table, "files");
    if (entry.files.empty()) entry.files = {".hpp", ".cpp"};
    entry.raw = table["raw"].value_or(false);
    entry.constants_ok = table["constants_ok"].value_or(false);
    entry.message = required<std::string>(table, "message");
    return entry;
}

Exemption read_exemption(const toml::table& table) {
    Exemption entry{required<std::string>(table, "path"), required<std::string>(table, "rule"),
                    required<std::string>(table, "reason")};
    if (entry.reason.empty()) fail(table, "an exemption needs a reason");
    return entry;
}

void read_limits(const toml::table& limits, Rules& rules) {
    rules.line_length = required<int>(limits, "line_length");
    rules.line_length_files = required_strings(limits, "line_length_files");
    rules.generated_mark = required<std::string>(limits, "generated_mark");
    each(limits["function"], [&](const toml::table& entry) {
        rules.function_limits.push_back(
            {required<std::string>(entry, "path"), required<int>(entry, "lines")});
    });
    each(limits["file"], [&](const toml::table& entry) {
        rules.file_limits.push_back({required<std::string>(entry, "path"),
                                     required<int>(entry, "header_lines"),
                                     required<int>(entry, "source_lines")});
    });
}

bool covers(const Exemption& exemption, const Violation& violation) {
    if (exemption.rule != violation.rule) return false;
    if (exemption.path.ends_with('/')) return violation.file.starts_with(exemption.path);
    return violation.file == exemption.path;
}

const toml::table& section(const toml::table& root, std::string_view key) {
    const toml::table* table = root[key].as_table();
    if (table == nullptr) fail(root, "missing section [" + std::string(key) + "]");
    return *table;
}

}  // namespace

Rules parse_rules(std::string_view toml_text) {
    toml::table root;
    try {
        root = toml::parse(toml_text);
    } catch (const toml::parse_error& error) {
        std::ostringstream text;
        text << "line " << error.source().begin.line << ": " << error.description();
        throw RuleError(text.str());
    }
    const toml::table& constant_root = root;
    Rules rules;
    read_limits(section(root, "limits"), rules);
    rules.include_directories = required_strings(section(root, "includes"), "directories");
    rules.generated_includes = strings(section(root, "includes"), "generated");
    rules.mirror_paths = required_strings(section(root, "mirror"), "paths");
    each(constant_root["layer"], [&](const toml::table& entry) {
        rules.layers.push_back(
            {required<std::string>(entry, "path"), required_strings(entry, "may_include")});
    });
    each(constant_root["forbid"],
         [&](const toml::table& entry) { rules.forbidden.push_back(read_forbidden(entry)); });
    each(constant_root["exempt"],
         [&](const toml::table& entry) { rules.exemptions.push_back(read_exemption(entry)); });
    return rules;
}

bool under_any(std::string_view file, const std::vector<std::string>& prefixes) {
    return std::any_of(prefixes.begin(), prefixes.end(),
                       [&](const std::string& prefix) { return file.starts_with(prefix); });
}

bool ends_with_any(std::string_view file, const std::vector<std::string>& endings) {
    return std::any_of(endings.begin(), endings.end(),
                       [&](const std::string& ending) { return file.ends_with(ending); });
}

std::vector<Violation> apply_exemptions(std::vector<Violation> violations, const Rules& rules) {
    for (const Exemption& exemption : rules.exemptions) {
        const auto removed = std::erase_if(
            violations, [&](const Violation& violation) { return covers(exemption, violation); });
        if (removed == 0) {
            violations.push_back({exemption.path, 0, "stale-exemption",
                                  "rules.toml exempts this from '" + exemption.rule +
                                      "', but nothing needs it; delete the entry"});
        }
    }
    return violations;
}

}  // namespace tidy
