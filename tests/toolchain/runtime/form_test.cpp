// form_test.cpp - what docs/spec/runtime.md says of all routines, checked on their sources.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "tests/toolchain/runtime/runtime_machine.hpp"
#include "toolchain/asm/clone.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace runtime_test {
namespace {

using toolchain::assembly::Item;
using toolchain::assembly::ItemKind;
using toolchain::assembly::Section;

std::set<std::string> labels_of(const Section& section) {
    std::set<std::string> labels;
    for (const Item& item : section.items) {
        if (item.kind == ItemKind::label) labels.insert(item.operand.symbol);
    }
    return labels;
}

/// Calls `check` with every section that has anything in it.
template <typename Check>
void with_sections(Check check) {
    for (const auto& module : runtime().modules()) {
        for (const Section& section : module.sections) {
            if (!section.items.empty()) check(section);
        }
    }
}

std::string page(const std::string& path) {
    std::ifstream file(ROVER_SOURCE_DIR "/docs/" + path);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Form, EveryEntryHasItsBlock) {
    std::set<std::string> described;
    for (const Routine& routine : runtime().routines()) {
        EXPECT_TRUE(described.insert(routine.name).second) << routine.name;
        EXPECT_FALSE(routine.in.empty()) << routine.name;
        EXPECT_FALSE(routine.clobbers.empty()) << routine.name;
        EXPECT_GT(routine.best_t, 0U) << routine.name;
        EXPECT_GE(routine.worst_t, routine.best_t) << routine.name;
    }
    std::set<std::string> entries;
    with_sections([&](const Section& section) {
        for (const std::string& label : labels_of(section)) {
            const bool code = section.kind == toolchain::assembly::SectionKind::code;
            if (code && label.starts_with("__")) entries.insert(label);
        }
    });
    EXPECT_EQ(described, entries);
}

TEST(Form, SizesAreThoseStated) {
    for (const Routine& routine : runtime().routines()) {
        with_sections([&](const Section& section) {
            if (section.name != routine.section) return;
            EXPECT_EQ(section_size(section), routine.stated_bytes) << section.name;
        });
    }
}

TEST(Form, DocumentedInstructionsOnly) {
    with_sections([](const Section& section) {
        for (const Item& item : section.items) {
            if (item.kind != ItemKind::instruction) continue;
            EXPECT_TRUE(kUndocumented || toolchain::isa::instruction(item.opcode).documented)
                << section.name << ' ' << toolchain::isa::instruction(item.opcode).text();
        }
    });
}

// What a routine refers to decides what has to be duplicated for an interrupt.
TEST(Form, ReferencesAreOwnCellsAndStatedCalls) {
    with_sections([](const Section& section) {
        std::set<std::string> allowed = labels_of(section);
        for (const Routine& routine : runtime().routines()) {
            if (routine.section != section.name) continue;
            allowed.insert(routine.name + ".cells");
            std::vector<std::string> names = routine.in;
            names.insert(names.end(), routine.out.begin(), routine.out.end());
            names.insert(names.end(), routine.calls.begin(), routine.calls.end());
            allowed.insert(names.begin(), names.end());
        }
        for (const Item& item : section.items) {
            const std::string name(reference_of(item));
            EXPECT_TRUE(name.empty() || allowed.contains(name)) << section.name << ' ' << name;
        }
    });
}

TEST(Form, ADuplicateSharesNothing) {
    for (const Routine& routine : runtime().routines()) {
        const std::string root = routine.name;
        const auto clones = clone_sections(runtime().modules(), {&root, 1}, ".irq");
        std::set<std::string> own;
        for (const Section& section : clones.module.sections) own.merge(labels_of(section));
        EXPECT_TRUE(own.contains(root + ".irq"));
        for (const Section& section : clones.module.sections) {
            for (const Item& item : section.items) {
                const std::string name(reference_of(item));
                EXPECT_TRUE(name.empty() || own.contains(name)) << root << ' ' << name;
            }
        }
    }
}

TEST(Form, PagesNameEveryRoutineWithItsFigures) {
    const std::string spec = page("spec/runtime.md");
    const std::string design = page("design/runtime.md");
    for (const Routine& routine : runtime().routines()) {
        EXPECT_NE(spec.find("`" + routine.name + "`"), spec.npos) << routine.name;
        if (!routine.is_stated) continue;
        const char* name = kSmall ? ", small" : kTable ? ", table" : ", 8085u";
        const char* variant = routine.is_variant ? name : "";
        const std::string row = fmt::format("| `{}`{} |", routine.name, variant);
        const std::size_t begin = design.find(row);
        ASSERT_NE(begin, design.npos) << routine.name;
        const std::string line = design.substr(begin, design.find('\n', begin) - begin);
        EXPECT_NE(line.find(fmt::format("| {} |", routine.best_t)), line.npos) << line;
        EXPECT_TRUE(line.ends_with(fmt::format("| {} |", routine.worst_t))) << line;
    }
}

}  // namespace
}  // namespace runtime_test
