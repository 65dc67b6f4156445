// modules_test.cpp - the table of modules: the first pattern that fits, and what is refused.
#include "tools/budget/modules.hpp"

#include <gtest/gtest.h>

#include "tools/budget/budget_error.hpp"

namespace {

using rover_budget::BudgetError;
using rover_budget::ModuleKind;
using rover_budget::ModuleTable;

constexpr const char* kTable =
    "# comment\n"
    "\n"
    "map,step,*slip::*\n"
    "tick,interrupt,on_tick\n"
    "map,step,fill, or not\n"
    "rest,library,runtime.*\n";

TEST(ModuleTable, FirstPatternThatFitsCounts) {
    const ModuleTable table = ModuleTable::parse(kTable, "m.csv");
    ASSERT_EQ(table.modules().size(), 4u);
    EXPECT_EQ(table.modules()[0].name, "map");
    EXPECT_EQ(table.modules()[1].kind, ModuleKind::interrupt);
    EXPECT_EQ(table.modules()[3].name, "other");
    EXPECT_EQ(table.of("void rover::slip::fill(int)"), 0u);
    EXPECT_EQ(table.of("on_tick"), 1u);
    EXPECT_EQ(table.of("on_tick2"), table.other());
    EXPECT_EQ(table.of("runtime.mul16"), 2u);
    EXPECT_EQ(table.of("fill, or not"), 0u);
}

std::string error_of(const std::string& text) {
    try {
        (void)ModuleTable::parse(text, "m.csv");
    } catch (const BudgetError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(ModuleTable, RefusesWithFileAndLine) {
    EXPECT_EQ(error_of("a,step\n"),
              "m.csv:1: is no line of the module table; write `module,kind,pattern`");
    EXPECT_EQ(error_of("#\na,step,\n").substr(0, 8), "m.csv:2:");
    EXPECT_EQ(error_of("a,stop,x\n"),
              "m.csv:1: stop is not a kind; step, idle, boot, interrupt and library are");
    EXPECT_EQ(error_of("a,step,x\na,boot,y\n").substr(0, 8), "m.csv:2:");
    EXPECT_NE(error_of("other,step,x\n"), "accepted");
}

TEST(ModuleTable, NamesOfTheKinds) {
    for (const char* kind : {"step", "idle", "boot", "interrupt", "library"}) {
        const ModuleTable table = ModuleTable::parse(std::string("a,") + kind + ",x", "m.csv");
        EXPECT_EQ(rover_budget::kind_name(table.modules()[0].kind), kind);
    }
}

}  // namespace
