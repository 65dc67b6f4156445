// effects.cpp - see effects.hpp.
#include "toolchain/codegen/effects.hpp"

#include "toolchain/codegen/coder.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

using namespace resource;

constexpr unsigned kMemory = 6;  ///< the register number that stands for M

ResourceSet pair_of(unsigned number) {
    return number == 3 ? ResourceSet{0} : static_cast<ResourceSet>(3U << 2 * number);
}

void use(Effects& effects, unsigned which, bool reads, bool writes) {
    if (which != kMemory) {
        if (reads) effects.reads |= of(which);
        if (writes) effects.writes |= of(which);
        return;
    }
    effects.reads |= kHl;
    effects.pointer = 2;
    effects.memory = reads && writes ? MemoryAccess::read_write
                     : reads         ? MemoryAccess::read
                                     : MemoryAccess::write;
}

ResourceSet flags_written(uint8_t opcode) {
    constexpr uint8_t kSignFlags =
        isa::flag::kSign | isa::flag::kZero | isa::flag::kAuxiliaryCarry | isa::flag::kParity;
    const uint8_t flags = isa::instruction(opcode).flags;
    ResourceSet set = 0;
    if ((flags & isa::flag::kCarry) != 0) set |= kCarry;
    if ((flags & kSignFlags) != 0) set |= kSign;
    if ((flags & isa::flag::kK) != 0) set |= kK;
    return set;
}

ResourceSet condition_of(uint8_t opcode) {
    if (op::asks_k(opcode)) return kK;
    const unsigned condition = opcode >> 3 & 7U;
    return condition == 2 || condition == 3 ? kCarry : kSign;
}

/// The undocumented ones but jumps. @return  false: it is none of them
bool undocumented(Effects& effects, uint8_t opcode) {
    switch (opcode) {
        case op::kDsub:
            effects.reads |= kHl | kBc;
            effects.writes |= kHl | kFlags;
            break;
        case op::kArhl:
            effects.reads |= kHl;
            effects.writes |= kHl | kCarry;
            break;
        case op::kRdel:
            effects.reads |= kDe | kCarry;
            effects.writes |= kDe | kCarry;
            break;
        case op::kLdhi:
            effects.reads |= kHl;
            effects.writes |= kDe;
            break;
        case op::kShlx:
        case op::kLhlx:
            effects.pointer = 1;
            effects.size = 2;
            effects.reads |= kDe;
            effects.memory = opcode == op::kShlx ? MemoryAccess::write : MemoryAccess::read;
            (opcode == op::kShlx ? effects.reads : effects.writes) |= kHl;
            return true;
        default:
            return false;
    }
    effects.pure = true;
    return true;
}

// 00H to 3FH.
void low_quarter(Effects& effects, uint8_t opcode) {
    const unsigned which = opcode >> 3 & 7U;
    const unsigned pair = opcode >> 4 & 3U;
    switch (opcode & 0x0FU) {
        case 0x01:  // LXI
            effects.writes |= pair_of(pair);
            effects.pure = pair != 3;
            return;
        case 0x03:  // INX
        case 0x0B:  // DCX
            effects.reads |= pair_of(pair);
            effects.writes |= pair_of(pair);
            effects.writes |= kK;
            effects.pure = pair != 3;
            return;
        case 0x09:  // DAD
            effects.reads = static_cast<ResourceSet>(kHl | pair_of(pair));
            effects.writes |= kHl | kCarry | kK;
            effects.pure = pair != 3;
            return;
        case 0x02:
        case 0x0A: {
            const bool loads = (opcode & 0x08U) != 0;
            effects.memory = loads ? MemoryAccess::read : MemoryAccess::write;
            const bool word = pair == 2;
            if (pair < 2) {  // STAX, LDAX
                effects.pointer = static_cast<uint8_t>(pair);
                effects.reads |= pair_of(pair);
            }
            effects.size = word ? 2 : 1;
            const ResourceSet moved = word ? kHl : kA;
            (loads ? effects.writes : effects.reads) |= moved;
            return;
        }
        default:
            break;
    }
    switch (opcode & 7U) {
        case 4:  // INR
        case 5:  // DCR
            use(effects, which, true, true);
            effects.writes |= kSign | kK;
            effects.pure = which != kMemory;
            return;
        case 6:  // MVI
            use(effects, which, false, true);
            effects.pure = which != kMemory;
            return;
        case 7:
            effects.pure = true;
            effects.writes |= flags_written(opcode);
            if (opcode != 0x37 && opcode != 0x3F) {  // not STC, CMC
                effects.reads |= kA;
                effects.writes |= kA;
            }
            if (opcode == 0x17 || opcode == 0x1F || opcode == 0x3F) effects.reads |= kCarry;
            if (opcode == 0x27) effects.reads |= kFlags;  // DAA
            return;
        default:
            break;
    }
    if (opcode == 0x20) effects.writes |= kA;  // RIM
    if (opcode == 0x30) effects.reads |= kA;   // SIM
}

void arithmetic(Effects& effects, unsigned operation, unsigned which, bool immediate) {
    const bool with_carry = operation == 1 || operation == 3;
    const bool itself = !immediate && which == 7;
    if (!immediate) use(effects, which, true, false);
    // SUB A and XRA A do not depend on A, and SBB A only on the carry; ANA A and ORA A leave it.
    effects.reads |= kA;
    if (itself && (operation == 2 || operation == 3 || operation == 5)) effects.reads = 0;
    if (with_carry) effects.reads |= kCarry;
    const bool keeps = operation == 7 || (itself && (operation == 4 || operation == 6));
    if (!keeps) effects.writes |= kA;
    effects.writes |= kFlags;
    effects.pure = effects.memory == MemoryAccess::none;
}

// C0H to FFH.
void top_quarter(Effects& effects, const CodeItem& item) {
    const uint8_t opcode = item.opcode;
    const isa::Instruction& instruction = isa::instruction(opcode);
    if (instruction.conditional()) effects.reads |= condition_of(opcode);
    if (instruction.flow == isa::Flow::call) {
        effects.reads |= of(item.reads);
        effects.writes |= of(item.writes);
        return;
    }
    const unsigned pair = opcode >> 4 & 3U;
    const ResourceSet pushed = pair == 3 ? kA | kFlags : pair_of(pair);
    if ((opcode & 0xCFU) == 0xC5) effects.reads |= pushed;
    if ((opcode & 0xCFU) == 0xC1) effects.writes |= pushed;
    if ((opcode & 7U) == 6) arithmetic(effects, opcode >> 3 & 7U, kMemory, true);
    switch (opcode) {
        case 0xC3:  // JMP: to a routine like a call that comes back somewhere else
            effects.reads |= of(item.reads);
            effects.writes |= of(item.writes);
            break;
        case 0xD3:  // OUT
            effects.reads |= kA;
            break;
        case 0xDB:  // IN
            effects.writes |= kA;
            break;
        case 0xE3:  // XTHL
            effects.writes |= kHl;
            [[fallthrough]];
        case 0xE9:  // PCHL
        case 0xF9:  // SPHL
            effects.reads |= kHl;
            break;
        case 0xEB:  // XCHG
            effects.reads |= kDe | kHl;
            effects.writes |= kDe | kHl;
            effects.pure = true;
            break;
        default:
            break;
    }
}

}  // namespace

Effects effects_of(const CodeItem& item) {
    Effects effects;
    if (item.kind != CodeItem::Kind::instruction) return effects;
    const uint8_t opcode = item.opcode;
    const unsigned to = opcode >> 3 & 7U;
    const unsigned from = opcode & 7U;
    if (undocumented(effects, opcode)) return effects;
    if (opcode < 0x40) {
        low_quarter(effects, opcode);
    } else if (opcode < 0x80) {
        if (opcode == 0x76) return effects;  // HLT
        use(effects, from, true, false);
        use(effects, to, false, true);
        effects.pure = effects.memory == MemoryAccess::none;
    } else if (opcode < 0xC0) {
        arithmetic(effects, to, from, false);
    } else {
        top_quarter(effects, item);
    }
    return effects;
}

}  // namespace toolchain::codegen
