// startup.cpp - see startup.hpp.
#include "toolchain/asm/startup.hpp"

#include <stdexcept>
#include <utility>

#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::assembly {
namespace {

// Opcodes by their Intel names.
constexpr uint8_t kLxiB = 0x01, kMviC = 0x0E, kDcrB = 0x05, kDcrC = 0x0D, kLxiD = 0x11,
                  kStaxD = 0x12, kInxD = 0x13, kLxiH = 0x21, kInxH = 0x23, kLxiSp = 0x31,
                  kHlt = 0x76, kMovAM = 0x7E, kJnz = 0xC2, kJmp = 0xC3, kCall = 0xCD, kPushH = 0xE5;

class Builder {
public:
    explicit Builder(const std::string& name) {
        section.name = name;
        section.function = name;
        section.items.push_back(label(name, LabelKind::function));
    }

    /// An instruction that is carried out `times` times.
    void add(uint8_t opcode, uint32_t times = 1, Operand operand = {}) {
        section.items.push_back(instruction(opcode, std::move(operand)));
        t_states += times * isa::instruction(opcode).t_not_taken;
    }

    void load(uint8_t opcode, uint32_t value) {
        add(opcode, 1, {"", static_cast<int32_t>(value & 0xFFFF)});
    }

    /// A loop of `count` rounds, 1 to 65536: C counts the first up to 256, B the 256s.
    template <typename Body>
    void loop(const std::string& name, uint32_t count, Body body) {
        const uint32_t outer = (count + 255) / 256;
        if (outer == 1) {
            load(kMviC, count & 0xFF);
        } else {
            load(kLxiB, (outer & 0xFF) << 8 | (count & 0xFF));
        }
        section.items.push_back(label(name, LabelKind::label));
        body(count);
        add(kDcrC, count);
        jump_back(name, count, outer);
        if (outer == 1) return;
        add(kDcrB, outer);
        jump_back(name, outer, 1);
    }

    Section section;
    uint32_t t_states = 0;

private:
    /// JNZ that is met `met` times and falls through `through` times.
    void jump_back(const std::string& name, uint32_t met, uint32_t through) {
        add(kJnz, through, {name});
        t_states += (met - through) * isa::instruction(kJnz).t_taken;
    }
};

}  // namespace

Startup make_startup(const StartupOptions& options, const StartupMemory& memory) {
    if (memory.zero.size % 2 != 0) throw std::invalid_argument("make_startup: odd zero region");
    Builder build(options.name);
    if (memory.zero.size != 0) {
        build.load(kLxiSp, memory.zero.end());
        build.load(kLxiH, 0);
        build.loop(".clear", memory.zero.size / 2,
                   [&](uint32_t count) { build.add(kPushH, count); });
    }
    build.load(kLxiSp, memory.stack_end);
    if (memory.data.size != 0) {
        build.load(kLxiH, memory.data_image.first);
        build.load(kLxiD, memory.data.first);
        build.loop(".copy", memory.data.size, [&](uint32_t count) {
            for (const uint8_t opcode : {kMovAM, kStaxD, kInxH, kInxD}) build.add(opcode, count);
        });
    }
    const uint32_t t_states = build.t_states;
    for (const std::string& constructor : options.constructors) build.add(kCall, 1, {constructor});
    build.add(kCall, 1, {options.main});
    build.section.items.push_back(label(".halt", LabelKind::label));
    build.add(kHlt);
    build.add(kJmp, 1, {".halt"});  // an interrupt ends HLT
    return {std::move(build.section), t_states};
}

}  // namespace toolchain::assembly
