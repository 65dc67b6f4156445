// toml_input.hpp - strict reading of TOML tables: required keys, ranges, no unknown keys, errors
// with file and line. Internal to host_sim/world; the only header that includes toml++.
#pragma once

#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

#include "host_sim/world/input_error.hpp"

namespace host_sim {

inline toml::table parse_toml(std::string_view text, const std::string& file_name) {
    try {
        return toml::parse(text, file_name);
    } catch (const toml::parse_error& error) {
        throw input_error(file_name, error.source().begin.line,
                          "not valid TOML: " + std::string(error.description()));
    }
}

/// One table of a TOML file.
class TomlTable {
public:
    TomlTable(const toml::table& table, std::string file_name, std::string path)
        : table_(&table), file_(std::move(file_name)), path_(std::move(path)) {}

    /// Refuses every key that is not listed.
    void allow_only(std::initializer_list<std::string_view> keys) const {
        for (const auto& [key, node] : *table_) {
            bool known = false;
            for (const std::string_view allowed : keys) known = known || key.str() == allowed;
            if (!known) {
                std::string message = quoted(key.str()) + " is not known here; allowed:";
                for (const std::string_view allowed : keys) message.append(" ").append(allowed);
                throw input_error(file_, node.source().begin.line, message);
            }
        }
    }

    [[nodiscard]] TomlTable table(std::string_view key) const {
        const toml::table* inner = required(key).as_table();
        if (inner == nullptr) throw wrong(key, "must be a table");
        return TomlTable(*inner, file_, full(key));
    }

    [[nodiscard]] std::string text(std::string_view key) const {
        const auto value = required(key).value<std::string>();
        if (!value || value->empty()) throw wrong(key, "must be a text that is not empty");
        return *value;
    }

    [[nodiscard]] double number(std::string_view key, double low, double high) const {
        return checked(key, required(key), low, high);
    }

    [[nodiscard]] std::optional<double> optional_number(std::string_view key, double low,
                                                        double high) const {
        if (!table_->contains(key)) return std::nullopt;
        return number(key, low, high);
    }

    [[nodiscard]] int integer(std::string_view key, int low, int high) const {
        const toml::node& node = required(key);
        const double value = checked(key, node, low, high);
        if (!node.is_integer()) throw wrong(key, "must be a whole number");
        return static_cast<int>(value);
    }

    [[nodiscard]] std::vector<double> numbers(std::string_view key, double low, double high) const {
        const toml::array* array = required(key).as_array();
        if (array == nullptr) throw wrong(key, "must be a list of numbers");
        std::vector<double> values;
        for (const toml::node& element : *array) {
            values.push_back(checked(key, element, low, high));
        }
        return values;
    }

    /// An error at `key`'s line: "'table.key' <what>".
    [[nodiscard]] InputError wrong(std::string_view key, const std::string& what) const {
        const toml::node* node = table_->get(key);
        const auto line = (node != nullptr ? node->source() : table_->source()).begin.line;
        return input_error(file_, line, quoted(key) + " " + what);
    }

private:
    [[nodiscard]] std::string full(std::string_view key) const {
        std::string name = path_;
        if (!name.empty()) name.push_back('.');
        name.append(key);
        return name;
    }

    [[nodiscard]] std::string quoted(std::string_view key) const {
        std::string name(1, '\'');
        name.append(full(key));
        name.push_back('\'');
        return name;
    }

    [[nodiscard]] const toml::node& required(std::string_view key) const {
        const toml::node* node = table_->get(key);
        if (node == nullptr) throw wrong(key, "is missing; add it");
        return *node;
    }

    [[nodiscard]] double checked(std::string_view key, const toml::node& node, double low,
                                 double high) const {
        const auto value = node.is_number() ? node.value<double>() : std::nullopt;
        if (!value || !std::isfinite(*value) || *value < low || *value > high) {
            std::string range = std::to_string(low) + " to " + std::to_string(high);
            throw input_error(file_, node.source().begin.line,
                              quoted(key) + " must be a number from " + range);
        }
        return *value;
    }

    const toml::table* table_;
    std::string file_;
    std::string path_;
};

}  // namespace host_sim
