// runtime_library_test.cpp - the compiler's runtime routines as modules: all of them link, and a
// program gets only the units that it needs.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "support.hpp"
#include "toolchain/asm/map_file.hpp"
#include "toolchain/asm/verify.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

std::vector<Module> runtime_modules() {
    std::vector<std::filesystem::path> paths;
    for (const auto& entry :
         std::filesystem::directory_iterator(ROVER_SOURCE_DIR "/toolchain/runtime")) {
        if (entry.path().extension() == ".s85") paths.push_back(entry.path());
    }
    std::ranges::sort(paths);
    std::vector<Module> modules;
    for (const auto& path : paths) {
        std::ifstream in(path);
        const std::string source((std::istreambuf_iterator<char>(in)), {});
        modules.push_back(parse(source, {path.filename().string(), {}, true}));
    }
    return modules;
}

TEST(RuntimeLibrary, EverySectionLinksAndIsDocumented) {
    const auto modules = runtime_modules();
    ASSERT_GE(modules.size(), 5u);
    LinkOptions options;
    std::size_t code_sections = 0;
    for (const Module& module : modules) {
        for (const Section& section : module.sections) {
            if (section.kind == SectionKind::code) ++code_sections;
            for (const Item& item : section.items) {
                if (item.kind == ItemKind::label) options.roots.push_back(item.operand.symbol);
            }
        }
    }
    std::erase_if(options.roots, [](const std::string& name) { return is_local(name); });
    const Program program = link(modules, options);
    EXPECT_TRUE(verify(program).empty());
    EXPECT_EQ(function_sizes(program).size(), code_sections);
    for (const FunctionSizes& one : function_sizes(program)) {
        EXPECT_TRUE(one.t_states.has_value()) << one.name;
    }
}

TEST(RuntimeLibrary, OnlyWhatIsNeededIsTaken) {
    auto modules = runtime_modules();
    modules.push_back(module_of("SECTION main,code\nmain: CALL __mul8\nRET\n"));
    const Program program = link(modules, rooted({"main"}));
    ASSERT_EQ(program.sections.size(), 2u);
    EXPECT_NE(program.find("__mul8"), nullptr);
    EXPECT_EQ(program.find("__mul8")->kind, LabelKind::function);
    EXPECT_EQ(program.find("__mul16"), nullptr);
}

}  // namespace
