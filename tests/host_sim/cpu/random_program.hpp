// random_program.hpp - memory and registers for the comparison of the interpreters: any bytes, or
// code that looks like code - routines with loops, calls, stack and tables - and now and then
// treads on itself.
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/flat_memory.hpp"

namespace cpu_test {

/// Everything about one program follows from its seed.
class RandomProgram {
public:
    explicit RandomProgram(uint32_t seed) : random_(seed) {}

    uint32_t below(uint32_t bound) { return static_cast<uint32_t>(random_()) % bound; }
    bool one_in(uint32_t n) { return below(n) == 0; }
    /// Evenly spread over the orders of magnitude from 1 to 100,000.
    uint64_t slice() {
        static constexpr std::array<uint32_t, 6> kPowers{1, 10, 100, 1000, 10000, 100000};
        const uint32_t power = below(5);
        return kPowers[power] + below(kPowers[power + 1] - kPowers[power]);
    }

    void make(host_sim::CpuState& cpu, host_sim::FlatMemory& memory) {
        memory_ = &memory;
        if (!one_in(4)) fill_with_noise();
        if (!one_in(4)) write_routines();
        set_registers(cpu);
    }

private:
    // A quarter of the programs is noise only.
    void fill_with_noise() {
        for (unsigned i = 0; i < memory_->bytes.size(); i += 4) {
            const auto bits = static_cast<uint32_t>(random_());
            for (unsigned n = 0; n < 4; ++n) {
                memory_->bytes[i + n] = static_cast<uint8_t>(bits >> 8 * n);
            }
        }
    }

    void set_registers(host_sim::CpuState& cpu) {
        static constexpr std::array<uint16_t, 6> kStacks{0x8000, 0x0000, 0x0001,
                                                         0xFFFF, 0x0180, 0x0600};
        const auto byte = [this] { return static_cast<uint8_t>(random_() >> 8); };
        cpu.a = byte(), cpu.b = byte(), cpu.c = byte(), cpu.d = byte();
        cpu.e = byte(), cpu.h = byte(), cpu.l = byte();
        cpu.f = static_cast<uint8_t>(byte() & ~host_sim::flag::kUnused);
        cpu.sp = one_in(4) ? static_cast<uint16_t>(random_()) : kStacks[below(kStacks.size())];
        cpu.pc = one_in(8) ? static_cast<uint16_t>(0xFFF0 + below(16)) : 0x0100;
        cpu.interrupt_enable = one_in(2);
        cpu.masks = static_cast<uint8_t>(below(8));
        cpu.t = below(3) * 1000;
    }

    // Routines of 256 bytes from 0100H, restarts at 0000H, a jump to 0100H at the end of memory.
    void write_routines() {
        for (unsigned n = 0; n < 0x40; n += 4) {
            at_ = static_cast<uint16_t>(n);
            emit_instruction();
            at_ = static_cast<uint16_t>(n + 3);
            emit(one_in(8) ? 0x00 : 0xC9);
        }
        for (unsigned page = 1; page <= kRoutines; ++page) {
            at_ = static_cast<uint16_t>(page << 8);
            while ((at_ & 0xFF) < 0xE0) {
                if (one_in(6)) {
                    emit_loop();
                } else {
                    emit_instruction();
                }
            }
            if (page == 1) {
                emit_word(0xC3, 0x0100);
            } else {
                emit(0xC9);
            }
        }
        at_ = 0xFFFD;
        emit_word(0xC3, 0x0100);
    }

    void emit(uint32_t byte) { memory_->bytes[at_++] = static_cast<uint8_t>(byte); }
    void emit_word(uint32_t opcode, uint32_t word) { emit(opcode), emit(word), emit(word >> 8); }
    /// Draws the word behind the opcode, so that the order of draws is no compiler's choice.
    template <class Draw>
    void emit_drawn_word(uint32_t opcode, Draw draw) {
        emit(opcode);
        const uint32_t word = draw();
        emit(word), emit(word >> 8);
    }

    /// Data mostly, sometimes code.
    uint32_t address() {
        if (one_in(10)) return below(kRoutines * 256);
        if (one_in(20)) return 0xFFFE + below(4);
        return 0x4000 + below(0x0400);
    }

    /// MVI C or E; body; DCR; JNZ to the body.
    void emit_loop() {
        const uint32_t reg = one_in(2) ? 1 : 3;
        emit(0x06 | reg << 3), emit(1 + below(20));
        const uint16_t body = at_;
        for (uint32_t n = 1 + below(6); n > 0; --n) emit_instruction();
        emit(0x05 | reg << 3);
        emit_word(0xC2, body);
    }

    void emit_instruction() {
        switch (below(16)) {
            case 0:
            case 1:
            case 2: {
                const uint32_t opcode = 0x40 | below(0x40);
                emit(opcode == 0x76 && !one_in(20) ? 0x7E : opcode);
                break;
            }
            case 3:
            case 4:
            case 5:
                emit(0x80 | below(0x40));
                break;
            case 6:
                emit(0xC6 | below(8) << 3), emit(below(256));  // immediate arithmetic
                break;
            case 7:
                emit(0x06 | below(8) << 3), emit(below(256));  // MVI
                break;
            case 8:
                emit_drawn_word(0x01 | below(one_in(8) ? 4 : 3) << 4, [this] { return address(); });
                break;  // LXI, rarely of SP
            case 9:
                emit_drawn_word(0x22 | below(4) << 3, [this] { return address(); });
                break;  // SHLD LHLD STA LDA
            case 10:
                if (one_in(2)) {
                    emit(0xC1 | below(4) << 4);  // POP
                } else {
                    emit(0xC5 | below(4) << 4);  // PUSH
                }
                break;
            case 11:
                emit_drawn_word(0xC4 | below(8) << 3,
                                [this] { return (1 + below(kRoutines)) << 8; });
                break;  // calls
            case 12:
                emit_drawn_word(one_in(3) ? 0xDD | below(2) << 5 : 0xC2 | below(8) << 3,
                                [this] { return at_ + 2U + below(9); });
                break;  // jumps ahead, JNK and JK among them
            case 13:
                emit_rare();
                break;
            default:
                emit(quarter_opcode());
                break;
        }
    }

    /// 00-3F without operand: INR, DCR, INX, DCX, DAD, LDAX, STAX, rotates, DSUB, ARHL, RDEL ...
    uint32_t quarter_opcode() {
        static constexpr std::array<uint8_t, 12> kColumns{3, 4, 5, 7, 9, 11, 12, 13, 15, 2, 10, 8};
        const uint32_t column = kColumns[below(kColumns.size())];
        const bool up_to_2_rows = column == 2 || column == 8 || column == 10;
        return below(up_to_2_rows ? 2 : 4) << 4 | column;
    }

    /// Input, output, interrupt control, serial line, restarts, returns and the like.
    void emit_rare() {
        static constexpr std::array<uint8_t, 20> kOpcodes{0xDB, 0xD3, 0xFB, 0xF3, 0x20, 0x30, 0xE3,
                                                          0xEB, 0xF9, 0xE9, 0xC7, 0xFF, 0xC0, 0xD8,
                                                          0xCB, 0xD9, 0xED, 0x28, 0x38, 0x27};
        emit(kOpcodes[below(kOpcodes.size())]), emit(below(256));
    }

    static constexpr uint32_t kRoutines = 6;

    std::mt19937 random_;
    host_sim::FlatMemory* memory_ = nullptr;
    uint16_t at_ = 0;
};

}  // namespace cpu_test
