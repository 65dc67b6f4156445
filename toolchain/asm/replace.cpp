// replace.cpp - see replace.hpp.
#include "toolchain/asm/replace.hpp"

#include <set>
#include <string>
#include <utility>

namespace toolchain::assembly {

void replace_sections(std::vector<Module>& modules, std::vector<Module> by) {
    std::set<std::string> names;
    for (const Module& module : by) {
        for (const Section& section : module.sections) names.insert(section.name);
    }
    for (Module& module : modules) {
        std::erase_if(module.sections,
                      [&](const Section& section) { return names.contains(section.name); });
    }
    for (Module& module : by) modules.push_back(std::move(module));
}

}  // namespace toolchain::assembly
