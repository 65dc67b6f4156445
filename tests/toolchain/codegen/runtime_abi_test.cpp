// The table of operands against the comment blocks of the routines themselves.
#include "toolchain/codegen/runtime_abi.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/toolchain/codegen/compiled_program.hpp"

namespace {

using namespace toolchain::codegen;
using toolchain::assembly::Item;
using toolchain::assembly::ItemKind;

struct Header {
    std::set<char> in;
    std::set<char> out;
    std::set<char> clobbers;
    std::set<std::string> cells;
};

void take(const std::string& note, Header& header) {
    std::istringstream words(note.substr(0, note.find(';')));
    std::string key;
    words >> key;
    for (std::string word; words >> word;) {
        if (word == "none") continue;
        if (word.starts_with("__")) {
            if (key != "calls") header.cells.insert(word);
            continue;
        }
        for (const char letter : word) {
            if (key == "in") header.in.insert(letter);
            if (key == "out") header.out.insert(letter);
            if (key == "clobbers") header.clobbers.insert(letter);
        }
    }
}

/// By the name of the routine; its notes stand before or behind its label.
std::map<std::string, Header> headers() {
    std::map<std::string, Header> result;
    for (const auto& module : codegen_test::runtime_modules()) {
        for (const auto& section : module.sections) {
            std::string current;
            std::vector<std::string> waiting;
            for (const Item& item : section.items) {
                if (item.kind == ItemKind::note) waiting.push_back(item.text);
                const bool names = item.kind == ItemKind::label &&
                                   !toolchain::assembly::is_local(item.operand.symbol);
                if (!names) continue;
                for (const std::string& note : waiting) take(note, result[item.operand.symbol]);
                waiting.clear();
            }
        }
    }
    return result;
}

std::set<char> letters(const std::vector<RoutineByte>& bytes) {
    std::set<char> result;
    for (const RoutineByte& byte : bytes) {
        if (byte.where != Register::flags) {
            result.insert("BCDEHLFA"[static_cast<std::size_t>(byte.where)]);
        }
    }
    return result;
}

std::set<std::string> cells(const RoutineAbi& abi) {
    std::set<std::string> result;
    for (const auto* bytes : {&abi.arguments, &abi.results}) {
        for (const RoutineByte& byte : *bytes) {
            if (byte.cell != nullptr) result.insert(byte.cell);
        }
    }
    return result;
}

TEST(RuntimeAbi, AgreesWithTheRoutinesHeaders) {
    // Called by nobody with operands of the program, or only by code made by hand.
    const std::set<std::string> others = {"__jumpindex", "__callhl", "__ucmp64", "__scmp64"};
    std::size_t checked = 0;
    for (const auto& [name, header] : headers()) {
        const auto abi = routine_abi(name);
        ASSERT_EQ(abi.has_value(),
                  !others.contains(name) && !(header.in.empty() && header.cells.empty()))
            << name;
        if (!abi) continue;
        ++checked;
        EXPECT_EQ(letters(abi->arguments), header.in) << name;
        const std::set<char> results = letters(abi->results);
        EXPECT_TRUE(std::ranges::includes(header.out, results)) << name;
        EXPECT_EQ(cells(*abi), header.cells) << name;
        std::set<char> changed = header.out;
        changed.insert(header.clobbers.begin(), header.clobbers.end());
        std::set<char> stated;
        for (unsigned i = 0; i < 8; ++i) {
            if ((abi->clobbers >> i & 1) != 0) stated.insert("BCDEHLFA"[i]);
        }
        EXPECT_EQ(stated, changed) << name;
    }
    EXPECT_EQ(checked, 36U);
}

TEST(RuntimeAbi, BytesAreInTheirOrder) {
    const auto divide = routine_abi("__udiv32");
    ASSERT_TRUE(divide.has_value());
    ASSERT_EQ(divide->arguments.size(), 8U);
    EXPECT_EQ(divide->arguments[0].where, Register::l);
    EXPECT_EQ(divide->arguments[3].where, Register::d);
    EXPECT_EQ(divide->arguments[5].offset, 1);
    EXPECT_STREQ(divide->results[7].cell, "__udiv32.cells");
    EXPECT_FALSE(routine_abi("main").has_value());
    EXPECT_FALSE(routine_abi("").has_value());
}

}  // namespace
