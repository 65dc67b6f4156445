// reach.hpp - which section defines a name, and which sections others need.
// Internal     to link.cpp and clone.cpp.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "toolchain/asm/object.hpp"

namespace toolchain::assembly {

/// The global names of some modules. Refers to them.
class NameIndex {
public:
    /// @errors  Error: names and sections defined twice
    explicit NameIndex(std::span<const Module> modules);

    /// All sections, in their order.
    [[nodiscard]] const std::vector<const Section*>& sections() const { return sections_; }
    /// Module that a section is from.
    [[nodiscard]] const Module& module_of(std::size_t section) const { return *modules_[section]; }
    /// The section that defines a label, also by way of an EQU.
    [[nodiscard]] std::optional<std::size_t> section_of(std::string_view name) const;
    /// The EQU of that name, or nullptr.
    [[nodiscard]] const Equate* equate(std::string_view name) const;

    /// Marks the sections that define `roots` and all that they refer to, directly or not. Names
    /// that nobody defines are passed over.
    /// @param barred  called for a section that is reached; true: it is not taken
    template <typename Barred>
    [[nodiscard]] std::vector<bool> reachable(std::span<const std::string> roots,
                                              Barred barred) const {
        std::vector<bool> reached(sections_.size());
        std::vector<std::size_t> work;
        const auto reach = [&](std::string_view name) {
            const auto section = section_of(name);
            if (!section || reached[*section] || barred(*sections_[*section])) return;
            reached[*section] = true;
            work.push_back(*section);
        };
        for (const std::string& root : roots) reach(root);
        while (!work.empty()) {
            const Section& section = *sections_[work.back()];
            work.pop_back();
            for (const Item& item : section.items) {
                const std::string_view name = reference_of(item);
                if (!name.empty() && !is_local(name)) reach(name);
            }
        }
        return reached;
    }

private:
    struct Place {
        std::size_t section;
        std::string file;
        uint32_t line;
    };
    void define(std::string_view name, const Place& place, std::vector<Diagnostic>& mistakes);

    std::vector<const Section*> sections_;
    std::vector<const Module*> modules_;  ///< by section
    std::unordered_map<std::string_view, Place> labels_;
    std::unordered_map<std::string_view, const Equate*> equates_;
};

/// The name of a location's file, or of the module.
[[nodiscard]] std::string file_of(const Module& module, Location location);

}  // namespace toolchain::assembly
