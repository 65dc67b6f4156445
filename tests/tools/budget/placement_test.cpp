// placement_test.cpp - a map by hand: bytes and addresses come to their modules.
#include "tools/budget/placement.hpp"

#include <gtest/gtest.h>

#include "tests/tools/budget/sample_map.hpp"

namespace {

using budget_test::kMap;
using rover_budget::ModuleTable;
using rover_budget::Placement;

constexpr const char* kSymbols =
    "0000 0020 F main()\n0020 0008 F __mul\n0028 0003 D a::table\n8004 0002 D a::value\n"
    "8006 0006 D a::count\n";
constexpr const char* kTable = "work,step,main()\nwork,step,a::*\nlib,library,runtime.*\n";

Placement placed(const char* table) {
    return rover_budget::place(rover_budget::parse_map(kMap, "a.map"),
                               host_sim::read_symbols(kSymbols, "a.sym"),
                               ModuleTable::parse(table, "m.csv"));
}

TEST(Place, BytesOfEachModule) {
    const Placement placement = placed(kTable);
    EXPECT_EQ(placement.bytes[0].rom, 0x20u + 3 + 2);  // code, constant, initial value
    EXPECT_EQ(placement.bytes[0].ram, 2u + 6);         // no frame
    EXPECT_EQ(placement.bytes[0].stack, 6u);
    EXPECT_EQ(placement.bytes[1].rom, 8u);
    EXPECT_TRUE(placement.unmapped.empty());
}

TEST(Place, AddressesOfEachModule) {
    const Placement placement = placed(kTable);
    EXPECT_EQ(placement.module_of[0x001F], 0);
    EXPECT_EQ(placement.module_of[0x0020], 1);
    EXPECT_EQ(placement.module_of[0x0028], 0);
    EXPECT_EQ(placement.module_of[0x002B], 2);
    EXPECT_EQ(placement.module_of[0x800B], 0);
}

TEST(Place, WhatNoPatternFitsIsNamed) {
    const Placement placement = placed("work,step,main()\nlib,library,runtime.*\n");
    EXPECT_EQ(placement.unmapped, (std::vector<std::string>{"a::table", "a::value", "a::count"}));
    EXPECT_EQ(placement.bytes[2].rom, 5u);
}

}  // namespace
