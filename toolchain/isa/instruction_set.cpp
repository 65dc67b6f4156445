// instruction_set.cpp - the table as Intel prints it, a row a bit pattern, and its expansion.
// Everything is computed and checked by the compiler: each opcode is covered by exactly one row,
// bytes agree with the operand, T-states with the machine cycles.
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::isa {
namespace {

constexpr uint8_t kS = flag::kSign;
constexpr uint8_t kZ = flag::kZero;
constexpr uint8_t kK = flag::kK;
constexpr uint8_t kAc = flag::kAuxiliaryCarry;
constexpr uint8_t kP = flag::kParity;
constexpr uint8_t kV = flag::kV;
constexpr uint8_t kCy = flag::kCarry;
constexpr uint8_t kAll = kS | kZ | kK | kAc | kP | kV | kCy;
constexpr uint8_t kAllButCarry = kAll & ~kCy;

/// A row. Letters in `pattern` are fields, and `%letter` in `text` is the name of their value:
/// d, s register but not M (110); p pair with SP; q pair with PSW; x pair B or D; c condition;
/// n number. Machine cycles in Intel's letters: F fetch of 4 T, S fetch of 6 T, R memory read,
/// W memory write, I input, O output, B bus idle. Of a conditional instruction the row gives both
/// cases, not taken first.
struct Row {
    std::string_view pattern;
    std::string_view text;
    uint8_t bytes;
    uint8_t t_not_taken;
    std::string_view cycles_not_taken;
    uint8_t flags = 0;
    Flow flow = Flow::next;
    uint8_t t_taken = 0;  ///< 0: not conditional
    std::string_view cycles_taken = {};
    uint8_t flags_unsettled = 0;
    bool documented = true;
    std::string_view alternate = {};
};

constexpr Row kRows[] = {
    // Move, load and store
    {"01dddsss", "MOV %d,%s", 1, 4, "F"},
    {"01ddd110", "MOV %d,M", 1, 7, "FR"},
    {"01110sss", "MOV M,%s", 1, 7, "FW"},
    {"00ddd110", "MVI %d,d8", 2, 7, "FR"},
    {"00110110", "MVI M,d8", 2, 10, "FRW"},
    {"00pp0001", "LXI %p,d16", 3, 10, "FRR"},
    {"000x0010", "STAX %x", 1, 7, "FW"},
    {"000x1010", "LDAX %x", 1, 7, "FR"},
    {"00110010", "STA a16", 3, 13, "FRRW"},
    {"00111010", "LDA a16", 3, 13, "FRRR"},
    {"00100010", "SHLD a16", 3, 16, "FRRWW"},
    {"00101010", "LHLD a16", 3, 16, "FRRRR"},
    {"11101011", "XCHG", 1, 4, "F"},
    // Stack
    {"11qq0101", "PUSH %q", 1, 12, "SWW"},
    {"11000001", "POP B", 1, 10, "FRR"},
    {"11010001", "POP D", 1, 10, "FRR"},
    {"11100001", "POP H", 1, 10, "FRR"},
    {"11110001", "POP PSW", 1, 10, "FRR", kAll},
    {"11100011", "XTHL", 1, 16, "FRRWW"},
    {"11111001", "SPHL", 1, 6, "S"},
    // Jump, call, return, restart
    {"11000011", "JMP a16", 3, 10, "FRR", 0, Flow::jump},
    {"11ccc010", "J%c a16", 3, 7, "FR", 0, Flow::jump, 10, "FRR"},
    {"11101001", "PCHL", 1, 6, "S", 0, Flow::jump_hl},
    {"11001101", "CALL a16", 3, 18, "SRRWW", 0, Flow::call},
    {"11ccc100", "C%c a16", 3, 9, "SR", 0, Flow::call, 18, "SRRWW"},
    {"11001001", "RET", 1, 10, "FRR", 0, Flow::ret},
    {"11ccc000", "R%c", 1, 6, "S", 0, Flow::ret, 12, "SRR"},
    {"11nnn111", "RST %n", 1, 12, "SWW", 0, Flow::restart},
    // Increment and decrement
    {"00ddd100", "INR %d", 1, 4, "F", kAllButCarry},
    {"00110100", "INR M", 1, 10, "FRW", kAllButCarry},
    {"00ddd101", "DCR %d", 1, 4, "F", kAllButCarry},
    {"00110101", "DCR M", 1, 10, "FRW", kAllButCarry},
    {"00pp0011", "INX %p", 1, 6, "S", kK},
    {"00pp1011", "DCX %p", 1, 6, "S", kK},
    // Add and subtract
    {"10000sss", "ADD %s", 1, 4, "F", kAll},
    {"10000110", "ADD M", 1, 7, "FR", kAll},
    {"11000110", "ADI d8", 2, 7, "FR", kAll},
    {"10001sss", "ADC %s", 1, 4, "F", kAll},
    {"10001110", "ADC M", 1, 7, "FR", kAll},
    {"11001110", "ACI d8", 2, 7, "FR", kAll},
    {"10010sss", "SUB %s", 1, 4, "F", kAll},
    {"10010110", "SUB M", 1, 7, "FR", kAll},
    {"11010110", "SUI d8", 2, 7, "FR", kAll},
    {"10011sss", "SBB %s", 1, 4, "F", kAll},
    {"10011110", "SBB M", 1, 7, "FR", kAll},
    {"11011110", "SBI d8", 2, 7, "FR", kAll},
    {"00pp1001", "DAD %p", 1, 10, "FBB", kCy | kV | kK, Flow::next, 0, {}, kK},
    // Logic
    {"10100sss", "ANA %s", 1, 4, "F", kAll},
    {"10100110", "ANA M", 1, 7, "FR", kAll},
    {"11100110", "ANI d8", 2, 7, "FR", kAll},
    {"10101sss", "XRA %s", 1, 4, "F", kAll},
    {"10101110", "XRA M", 1, 7, "FR", kAll},
    {"11101110", "XRI d8", 2, 7, "FR", kAll},
    {"10110sss", "ORA %s", 1, 4, "F", kAll},
    {"10110110", "ORA M", 1, 7, "FR", kAll},
    {"11110110", "ORI d8", 2, 7, "FR", kAll},
    {"10111sss", "CMP %s", 1, 4, "F", kAll},
    {"10111110", "CMP M", 1, 7, "FR", kAll},
    {"11111110", "CPI d8", 2, 7, "FR", kAll},
    // Rotate
    {"00000111", "RLC", 1, 4, "F", kCy | kV | kK, Flow::next, 0, {}, kV | kK},
    {"00001111", "RRC", 1, 4, "F", kCy | kV | kK, Flow::next, 0, {}, kV | kK},
    {"00010111", "RAL", 1, 4, "F", kCy | kV | kK, Flow::next, 0, {}, kV | kK},
    {"00011111", "RAR", 1, 4, "F", kCy | kV | kK, Flow::next, 0, {}, kV | kK},
    // Specials
    {"00101111", "CMA", 1, 4, "F", kV, Flow::next, 0, {}, kV},
    {"00110111", "STC", 1, 4, "F", kCy},
    {"00111111", "CMC", 1, 4, "F", kCy},
    {"00100111", "DAA", 1, 4, "F", kAll},
    // Input and output, control
    {"11011011", "IN p8", 2, 10, "FRI"},
    {"11010011", "OUT p8", 2, 10, "FRO"},
    {"11111011", "EI", 1, 4, "F"},
    {"11110011", "DI", 1, 4, "F"},
    {"00000000", "NOP", 1, 4, "F"},
    {"01110110", "HLT", 1, 5, "FB", 0, Flow::halt},
    {"00100000", "RIM", 1, 4, "F"},
    {"00110000", "SIM", 1, 4, "F"},
    // Undocumented by Intel
    {"00001000", "DSUB", 1, 10, "FBB", kAll, Flow::next, 0, {}, kS | kZ | kAc | kP, false},
    {"00010000", "ARHL", 1, 7, "FB", kCy, Flow::next, 0, {}, 0, false},
    {"00011000", "RDEL", 1, 10, "FBB", kCy | kV, Flow::next, 0, {}, 0, false},
    {"00101000", "LDHI d8", 2, 10, "FRB", 0, Flow::next, 0, {}, 0, false},
    {"00111000", "LDSI d8", 2, 10, "FRB", 0, Flow::next, 0, {}, 0, false},
    {"11001011", "RSTV", 1, 6, "S", 0, Flow::restart, 12, "SWW", 0, false},
    {"11011001", "SHLX", 1, 10, "FWW", 0, Flow::next, 0, {}, 0, false},
    {"11101101", "LHLX", 1, 10, "FRR", 0, Flow::next, 0, {}, 0, false},
    {"11011101", "JNK a16", 3, 7, "FR", 0, Flow::jump, 10, "FRR", 0, false, "JNX5"},
    {"11111101", "JK a16", 3, 7, "FR", 0, Flow::jump, 10, "FRR", 0, false, "JX5"},
};

/// Name of a field's value; empty when the row does not cover it.
constexpr std::string_view field_name(char letter, unsigned value) {
    constexpr std::string_view kRegisters[] = {"B", "C", "D", "E", "H", "L", "", "A"};
    constexpr std::string_view kPairs[] = {"B", "D", "H", "SP"};
    constexpr std::string_view kStackPairs[] = {"B", "D", "H", "PSW"};
    constexpr std::string_view kConditions[] = {"NZ", "Z", "NC", "C", "PO", "PE", "P", "M"};
    constexpr std::string_view kNumbers[] = {"0", "1", "2", "3", "4", "5", "6", "7"};
    switch (letter) {
        case 'd':
        case 's':
            return kRegisters[value];
        case 'p':
        case 'x':
            return kPairs[value];
        case 'q':
            return kStackPairs[value];
        case 'c':
            return kConditions[value];
        case 'n':
            return kNumbers[value];
        default:
            return {};
    }
}

constexpr unsigned field_value(std::string_view pattern, char letter, unsigned opcode) {
    unsigned value = 0;
    for (unsigned i = 0; i < 8; ++i) {
        if (pattern[i] == letter) value = value << 1 | (opcode >> (7 - i) & 1u);
    }
    return value;
}

constexpr bool covers(const Row& row, unsigned opcode) {
    for (unsigned i = 0; i < 8; ++i) {
        const char letter = row.pattern[i];
        const unsigned bit = opcode >> (7 - i) & 1u;
        if (letter == '0' || letter == '1') {
            if (bit != static_cast<unsigned>(letter - '0')) return false;
        } else if (field_name(letter, field_value(row.pattern, letter, opcode)).empty()) {
            return false;
        }
    }
    return true;
}

constexpr BusCycle cycle_kind(char letter) {
    switch (letter) {
        case 'F':
            return BusCycle::fetch4;
        case 'S':
            return BusCycle::fetch6;
        case 'R':
            return BusCycle::memory_read;
        case 'W':
            return BusCycle::memory_write;
        case 'I':
            return BusCycle::io_read;
        case 'O':
            return BusCycle::io_write;
        case 'B':
            return BusCycle::bus_idle;
        default:
            throw "unknown letter of a machine cycle";
    }
}

constexpr BusCycles bus_cycles(std::string_view letters) {
    BusCycles cycles;
    for (const char letter : letters) cycles.kinds[cycles.count++] = cycle_kind(letter);
    return cycles;
}

constexpr unsigned t_states(const BusCycles& cycles, bool halt) {
    unsigned t = 0;
    for (unsigned i = 0; i < cycles.count; ++i) {
        const BusCycle kind = cycles.kinds[i];
        t += kind == BusCycle::fetch4 ? 4 : kind == BusCycle::fetch6 ? 6 : 3;
    }
    return halt ? t - 2 : t;  // HLT leaves its idle cycle after one T-state
}

constexpr Operand operand_of(std::string_view text) {
    if (text.ends_with("d8")) return Operand::data8;
    if (text.ends_with("d16")) return Operand::data16;
    if (text.ends_with("a16")) return Operand::address16;
    if (text.ends_with("p8")) return Operand::port8;
    return Operand::none;
}

constexpr unsigned bytes_of(Operand operand) {
    switch (operand) {
        case Operand::none:
            return 1;
        case Operand::data8:
        case Operand::port8:
            return 2;
        default:
            return 3;
    }
}

constexpr Instruction expand(const Row& row, unsigned opcode) {
    Instruction result;
    const auto put = [&result](char letter) { result.text_storage[result.text_size++] = letter; };
    for (std::size_t i = 0; i < row.text.size(); ++i) {
        if (row.text[i] == ' ') result.mnemonic_size = result.text_size;
        if (row.text[i] == '%') {
            const char letter = row.text[++i];
            for (const char part : field_name(letter, field_value(row.pattern, letter, opcode))) {
                put(part);
            }
        } else {
            put(row.text[i]);
        }
    }
    if (result.mnemonic_size == 0) result.mnemonic_size = result.text_size;

    const bool conditional = row.t_taken != 0;
    result.opcode = static_cast<uint8_t>(opcode);
    result.bytes = row.bytes;
    result.operand = operand_of(row.text);
    result.t_not_taken = row.t_not_taken;
    result.t_taken = conditional ? row.t_taken : row.t_not_taken;
    result.cycles_not_taken = bus_cycles(row.cycles_not_taken);
    result.cycles_taken = conditional ? bus_cycles(row.cycles_taken) : result.cycles_not_taken;
    result.flags = row.flags;
    result.flags_unsettled = row.flags_unsettled;
    result.documented = row.documented;
    result.flow = row.flow;
    result.alternate_mnemonic = row.alternate;
    return result;
}

/// Throwing here is a compile error.
consteval std::array<Instruction, 256> expand_all() {
    std::array<Instruction, 256> table{};
    for (unsigned opcode = 0; opcode < 256; ++opcode) {
        unsigned rows = 0;
        for (const Row& row : kRows) {
            if (!covers(row, opcode)) continue;
            ++rows;
            table[opcode] = expand(row, opcode);
        }
        if (rows != 1) throw "an opcode is not covered by exactly one row";
        const Instruction& entry = table[opcode];
        const bool halt = entry.flow == Flow::halt;
        if (entry.bytes != bytes_of(entry.operand)) throw "bytes disagree with the operand";
        if (entry.t_not_taken != t_states(entry.cycles_not_taken, halt) ||
            entry.t_taken != t_states(entry.cycles_taken, halt)) {
            throw "T-states disagree with the machine cycles";
        }
        if ((entry.flags_unsettled & ~entry.flags) != 0) throw "an unsettled flag is not in flags";
    }
    return table;
}

constexpr std::array<Instruction, 256> kTable = expand_all();

}  // namespace

std::span<const Instruction, 256> instruction_set() {
    return kTable;
}

}  // namespace toolchain::isa
