// runtime_abi.cpp - see runtime_abi.hpp. A test compares the table with the routines' own headers.
#include "toolchain/codegen/runtime_abi.hpp"

#include <array>
#include <string_view>

namespace toolchain::codegen {

namespace {

/// Bytes in the order of the values, least significant first: a register's letter, 'x' the next
/// byte of the first cell, 'y' of the second.
struct Row {
    std::string_view name;
    std::string_view arguments;
    std::string_view results;
    std::string_view clobbers;
    const char* cells[2] = {nullptr, nullptr};
};

constexpr const char* kA = "__wide.a";
constexpr const char* kB = "__wide.b";
constexpr const char* kFactor = "__mul32.cells";
constexpr const char* kDivisor = "__udiv32.cells";

constexpr std::array<Row, 36> kRows = {{
    {"__mul8", "AE", "LH", "ADHLF", {}},
    {"__mul8s", "AE", "LH", "ADHLF", {}},
    {"__mul8_16", "AED", "LH", "AHLF", {}},
    {"__mul16", "LHED", "LH", "AHLF", {}},
    {"__mul8_16w", "AED", "LHA", "AHLF", {}},
    {"__mul8_s16w", "AED", "LHA", "AHLF", {}},
    {"__smul16w", "LHED", "LHED", "ADEHLF", {}},
    {"__umul16w", "LHED", "LHED", "ADEHLF", {}},
    {"__mul32", "LHEDxxxx", "LHED", "ADEHLF", {kFactor}},
    {"__mul64", "xxxxxxxxyyyyyyyy", "xxxxxxxx", "ADEHLF", {kA, kB}},
    {"__udiv8", "AE", "LA", "AHLF", {}},
    {"__sdiv8", "AE", "LA", "AEHLF", {}},
    {"__udiv16", "LHED", "LHED", "ADEHLF", {}},
    {"__sdiv16", "LHED", "LHED", "ADEHLF", {}},
    {"__udiv24_8", "LHAE", "LHE", "ADEHLF", {}},
    {"__udiv32_16", "LHEDCB", "LHEDCB", "ABCDEHLF", {}},
    {"__udiv32", "LHEDxxxx", "LHEDxxxx", "ADEHLF", {kDivisor}},
    {"__sdiv32", "LHEDxxxx", "LHEDxxxx", "ADEHLF", {kDivisor}},
    {"__udiv64", "xxxxxxxxyyyyyyyy", "xxxxxxxxyyyyyyyy", "ABCDEHLF", {kA, kB}},
    {"__sdiv64", "xxxxxxxxyyyyyyyy", "xxxxxxxxyyyyyyyy", "ABCDEHLF", {kA, kB}},
    {"__shl8", "AE", "A", "AEF", {}},
    {"__lshr8", "AE", "A", "AEF", {}},
    {"__ashr8", "AE", "A", "AEF", {}},
    {"__shl16", "LHA", "LH", "AHLF", {}},
    {"__lshr16", "LHA", "LH", "AHLF", {}},
    {"__ashr16", "LHA", "LH", "AHLF", {}},
    {"__shl32", "LHEDA", "LHED", "ADEHLF", {}},
    {"__lshr32", "LHEDA", "LHED", "ADEHLF", {}},
    {"__ashr32", "LHEDA", "LHED", "ADEHLF", {}},
    {"__shl64", "xxxxxxxxA", "xxxxxxxx", "ABHLF", {kA}},
    {"__lshr64", "xxxxxxxxA", "xxxxxxxx", "ABCHLF", {kA}},
    {"__ashr64", "xxxxxxxxA", "xxxxxxxx", "ABCHLF", {kA}},
    {"__memcpy", "LHEDCB", "", "ABCDEHLF", {}},
    {"__memcpy8", "LHEDC", "", "ACDEHLF", {}},
    {"__memmove", "LHEDCB", "", "ABCDEHLF", {}},
    {"__memset", "LHACB", "", "ABCHLF", {}},
}};

Register register_of(char letter) {
    switch (letter) {
        case 'A':
            return Register::a;
        case 'B':
            return Register::b;
        case 'C':
            return Register::c;
        case 'D':
            return Register::d;
        case 'E':
            return Register::e;
        case 'H':
            return Register::h;
        case 'L':
            return Register::l;
        default:
            return Register::flags;
    }
}

std::vector<RoutineByte> bytes_of(std::string_view text, const Row& row) {
    std::vector<RoutineByte> bytes;
    std::array<uint8_t, 2> next{};
    for (const char letter : text) {
        if (letter != 'x' && letter != 'y') {
            bytes.push_back({register_of(letter), nullptr, 0});
            continue;
        }
        const std::size_t cell = letter == 'x' ? 0 : 1;
        bytes.push_back({Register::flags, row.cells[cell], next[cell]++});
    }
    return bytes;
}

}  // namespace

std::optional<RoutineAbi> routine_abi(const std::string& name) {
    for (const Row& row : kRows) {
        if (row.name != name || name.empty()) continue;
        RoutineAbi abi{bytes_of(row.arguments, row), bytes_of(row.results, row), 0};
        for (const char letter : row.clobbers) abi.clobbers |= set_of(register_of(letter));
        return abi;
    }
    return std::nullopt;
}

}  // namespace toolchain::codegen
