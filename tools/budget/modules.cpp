// modules.cpp - see modules.hpp.
#include "tools/budget/modules.hpp"

#include <fnmatch.h>

#include <array>
#include <sstream>
#include <utility>

#include "tools/budget/budget_error.hpp"

namespace rover_budget {
namespace {

constexpr std::array<std::pair<std::string_view, ModuleKind>, 5> kKinds = {{
    {"step", ModuleKind::step},
    {"idle", ModuleKind::idle},
    {"boot", ModuleKind::boot},
    {"interrupt", ModuleKind::interrupt},
    {"library", ModuleKind::library},
}};
constexpr const char* kForm = "write `module,kind,pattern`";

ModuleKind kind_of(std::string_view name, std::string_view file, std::size_t line) {
    for (const auto& [known, kind] : kKinds) {
        if (known == name) return kind;
    }
    throw BudgetError(file, line, std::string(name) + " is not a kind",
                      "step, idle, boot, interrupt and library are");
}

}  // namespace

std::string_view kind_name(ModuleKind kind) {
    return kKinds[static_cast<std::size_t>(kind)].first;
}

std::size_t ModuleTable::add(const std::string& name, ModuleKind kind, std::string_view file,
                             std::size_t line) {
    for (std::size_t i = 0; i < modules_.size(); ++i) {
        if (modules_[i].name != name) continue;
        if (modules_[i].kind == kind) return i;
        throw BudgetError(file, line, name + " has another kind further up", "give it one kind");
    }
    modules_.push_back({name, kind});
    return modules_.size() - 1;
}

ModuleTable ModuleTable::parse(std::string_view text, std::string_view file) {
    ModuleTable table;
    std::istringstream lines{std::string(text)};
    std::size_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        if (line.empty() || line.starts_with('#')) continue;
        const std::size_t first = line.find(',');
        const std::size_t second = first == std::string::npos ? first : line.find(',', first + 1);
        if (second == std::string::npos || first == 0 || second + 1 == line.size()) {
            throw BudgetError(file, number, "is no line of the module table", kForm);
        }
        const std::string name = line.substr(0, first);
        if (name == "other") {
            throw BudgetError(file, number, "other is what no pattern fits", "choose another name");
        }
        const ModuleKind kind =
            kind_of(std::string_view(line).substr(first + 1, second - first - 1), file, number);
        table.rules_.push_back({line.substr(second + 1), table.add(name, kind, file, number)});
    }
    table.modules_.push_back({"other", ModuleKind::step});
    return table;
}

std::size_t ModuleTable::of(std::string_view name) const {
    const std::string text(name);
    for (const Rule& rule : rules_) {
        if (fnmatch(rule.pattern.c_str(), text.c_str(), FNM_NOESCAPE) == 0) return rule.module;
    }
    return other();
}

}  // namespace rover_budget
