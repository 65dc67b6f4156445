// replace.hpp - sections that stand in for others of the same names.
#pragma once

#include <vector>

#include "toolchain/asm/object.hpp"

namespace toolchain::assembly {

/// Removes from `modules` every section that one of `by` has a section of the same name for, and
/// appends `by`. Sections that are only in `by` are there afterwards too.
void replace_sections(std::vector<Module>& modules, std::vector<Module> by);

}  // namespace toolchain::assembly
