// modules.hpp - which function and which variable belongs to which module of the image.
// Depends on   the standard library, fnmatch.
// Format       tests/budgets/modules.csv: `module,kind,pattern` a line; docs/design/budget.md
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rover_budget {

/// What a module's T-states count as.
enum class ModuleKind : uint8_t {
    step,       ///< the main line's work of a step
    idle,       ///< waiting for the next step
    boot,       ///< before the first step
    interrupt,  ///< handlers
    library,    ///< called by the others: its T-states are its caller's, its bytes its own
};
[[nodiscard]] std::string_view kind_name(ModuleKind kind);

struct Module {
    std::string name;
    ModuleKind kind = ModuleKind::step;
};

/// The modules in the order of the table, then "other" for what no pattern fits.
class ModuleTable {
public:
    /// @param file  name for messages
    /// @errors  BudgetError: not this form, an unknown kind, a module with two kinds or named
    /// "other"
    static ModuleTable parse(std::string_view text, std::string_view file);

    [[nodiscard]] const std::vector<Module>& modules() const { return modules_; }
    [[nodiscard]] std::size_t other() const { return modules_.size() - 1; }
    /// Index of the module of the first pattern that fits a name; other() if none does.
    [[nodiscard]] std::size_t of(std::string_view name) const;

private:
    struct Rule {
        std::string pattern;
        std::size_t module = 0;
    };
    std::size_t add(const std::string& name, ModuleKind kind, std::string_view file,
                    std::size_t line);
    std::vector<Module> modules_;
    std::vector<Rule> rules_;
};

}  // namespace rover_budget
