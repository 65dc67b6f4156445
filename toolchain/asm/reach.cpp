// reach.cpp - see reach.hpp.
#include "toolchain/asm/reach.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

namespace toolchain::assembly {
namespace {

constexpr std::size_t kNoSection = static_cast<std::size_t>(-1);

}  // namespace

std::string file_of(const Module& module, Location location) {
    return location.known() && location.file < module.files.size() ? module.files[location.file]
                                                                   : module.name;
}

NameIndex::NameIndex(std::span<const Module> modules) {
    std::vector<Diagnostic> mistakes;
    for (const Module& module : modules) {
        for (const Section& section : module.sections) {
            std::set<std::string_view> local;
            for (const Item& item : section.items) {
                if (item.kind != ItemKind::label) continue;
                const std::string& name = item.operand.symbol;
                const std::string file = file_of(module, item.location);
                if (!is_local(name)) {
                    define(name, {sections_.size(), file, item.location.line}, mistakes);
                } else if (!local.insert(name).second) {
                    mistakes.push_back(
                        {file, item.location.line,
                         fmt::format("'{}' is defined twice in section '{}'", name, section.name)});
                }
            }
            sections_.push_back(&section);
            modules_.push_back(&module);
        }
        for (const Equate& equate : module.equates) {
            define(equate.name,
                   {kNoSection, file_of(module, equate.location), equate.location.line}, mistakes);
            equates_.emplace(equate.name, &equate);
        }
    }
    if (!mistakes.empty()) throw Error(std::move(mistakes));
}

void NameIndex::define(std::string_view name, const Place& place,
                       std::vector<Diagnostic>& mistakes) {
    const auto [found, is_new] = labels_.emplace(name, place);
    if (is_new) return;
    mistakes.push_back({place.file, place.line,
                        fmt::format("'{}' is defined twice; first in {}:{}", name,
                                    found->second.file, found->second.line)});
}

std::optional<std::size_t> NameIndex::section_of(std::string_view name) const {
    // An EQU that names itself through others ends the search.
    for (std::size_t steps = 0; steps <= equates_.size(); ++steps) {
        const auto found = labels_.find(name);
        if (found == labels_.end()) return {};
        if (found->second.section != kNoSection) return found->second.section;
        name = equates_.at(name)->value.symbol;
    }
    return {};
}

const Equate* NameIndex::equate(std::string_view name) const {
    const auto found = equates_.find(name);
    return found == equates_.end() ? nullptr : found->second;
}

}  // namespace toolchain::assembly
