// clone.cpp - see clone.hpp.
#include "toolchain/asm/clone.hpp"

#include <utility>

#include "toolchain/asm/reach.hpp"

namespace toolchain::assembly {
namespace {

void rename_to(std::string& name, const Renaming& renaming) {
    if (const auto found = renaming.find(name); found != renaming.end()) name = found->second;
}

/// @param renaming  gains the section's labels
Section copy_of(const Section& section, const std::string& suffix, Renaming& renaming) {
    Section copy = section;
    copy.name += suffix;
    if (!copy.function.empty()) copy.function += suffix;
    if (!copy.title.empty()) copy.title += " [" + suffix + "]";
    for (Item& item : copy.items) {
        if (item.kind != ItemKind::label || is_local(item.operand.symbol)) continue;
        renaming[item.operand.symbol] = item.operand.symbol + suffix;
        item.operand.symbol += suffix;
    }
    return copy;
}

}  // namespace

Clones clone_sections(std::span<const Module> modules, std::span<const std::string> roots,
                      const std::string& suffix, const std::set<std::string>& shared) {
    const NameIndex index(modules);
    for (const std::string& root : roots) {
        if (index.section_of(root)) continue;
        throw Error(
            {Diagnostic{{}, 0, "'" + root + "' is to be cloned, but no module defines it"}});
    }
    const auto reached = index.reachable(roots, [&](const Section& section) {
        return section.kind == SectionKind::constant || section.kind == SectionKind::initialised ||
               section.address.has_value() || shared.contains(section.name);
    });
    Clones clones;
    clones.module.name = "clones" + suffix;
    std::map<const Module*, uint32_t> first_file;
    for (std::size_t i = 0; i < reached.size(); ++i) {
        if (!reached[i]) continue;
        const Module& origin = index.module_of(i);
        auto& files = clones.module.files;
        const auto [file, is_new] =
            first_file.emplace(&origin, static_cast<uint32_t>(files.size()));
        if (is_new) files.insert(files.end(), origin.files.begin(), origin.files.end());
        Section copy = copy_of(*index.sections()[i], suffix, clones.renaming);
        copy.location.file += file->second;
        for (Item& item : copy.items) item.location.file += file->second;
        clones.module.sections.push_back(std::move(copy));
    }
    for (Section& section : clones.module.sections) rename_references(section, clones.renaming);
    return clones;
}

void rename_references(Section& section, const Renaming& renaming) {
    for (Item& item : section.items) {
        if (item.kind != ItemKind::label) rename_to(item.operand.symbol, renaming);
    }
}

}  // namespace toolchain::assembly
