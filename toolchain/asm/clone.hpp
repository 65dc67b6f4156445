// clone.hpp - a second copy of routines, so that an interrupt has its own.
// Why          a function with a static frame must not be entered while it runs. What both the main
//              program and an interrupt reach is linked twice, with cells and frames of its own.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "toolchain/asm/object.hpp"

namespace toolchain::assembly {

/// Old names and new ones.
using Renaming = std::map<std::string, std::string, std::less<>>;

struct Clones {
    Module module{};      ///< the new sections
    Renaming renaming{};  ///< of every label in them that is not local
};

/// Copies the sections that define `roots` and all that they refer to, with `suffix` behind the
/// names of sections, functions and labels. References among the copies go to the copies. Shared,
/// so not copied and not followed: constants, initialised data, sections at a fixed address and
/// those named in `shared`. A frame keeps its offset; its owner has to give it another one.
/// @errors  Error: a root that nobody defines, names defined twice
[[nodiscard]] Clones clone_sections(std::span<const Module> modules,
                                    std::span<const std::string> roots, const std::string& suffix,
                                    const std::set<std::string>& shared = {});

/// Lets a section refer to the copies.
void rename_references(Section& section, const Renaming& renaming);

}  // namespace toolchain::assembly
