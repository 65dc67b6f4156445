// round_trip_test.cpp - random programs: linked, disassembled, printed, assembled again; and the
// same encodings from GNU as for the Z80, where it is installed.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "support.hpp"
#include "toolchain/asm/listing.hpp"
#include "toolchain/asm/print.hpp"
#include "toolchain/isa/disassemble.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;
namespace isa = toolchain::isa;

/// Sections of random instructions that refer to each other.
Module random_module() {
    Module module;
    module.name = "random";
    const int count = *rc::gen::inRange(1, 6);
    for (int number = 0; number < count; ++number) {
        Section section;
        section.name = fmt::format("f{}", number);
        section.items.push_back(label(section.name));
        const auto opcodes =
            *rc::gen::container<std::vector<uint8_t>>(rc::gen::arbitrary<uint8_t>());
        for (const uint8_t opcode : opcodes) {
            const isa::Operand kind = isa::instruction(opcode).operand;
            Operand operand;
            if (kind == isa::Operand::data16 || kind == isa::Operand::address16) {
                if (*rc::gen::arbitrary<bool>()) {
                    operand = {fmt::format("f{}", *rc::gen::inRange(0, count)),
                               *rc::gen::inRange(0, 100)};
                } else {
                    operand.offset = *rc::gen::inRange(0, 0x10000);
                }
            } else if (kind != isa::Operand::none) {
                operand.offset = *rc::gen::inRange(0, 0x100);
                if (*rc::gen::arbitrary<bool>()) operand = {"f0", 7, Part::high};
            }
            section.items.push_back(instruction(opcode, operand));
        }
        module.sections.push_back(std::move(section));
    }
    return module;
}

RC_GTEST_PROP(RoundTrip, DisassembledProgramsAssembleToTheSameBytes, ()) {
    const Program program = link({random_module()}, rooted({"f0"}));
    std::string source;
    std::size_t at = 0;
    const std::size_t end = program.image.present.count();
    while (at < end) {
        const auto text = isa::disassemble(std::span(program.image.bytes).subspan(at, end - at));
        source += text.text + '\n';
        at += text.bytes;
    }
    const Program again = link({parse(source, {"again", uint16_t{0}})});
    RC_ASSERT(again.image.bytes == program.image.bytes);
}

RC_GTEST_PROP(RoundTrip, PrintedModulesAreTheSameModules, ()) {
    const Module module = random_module();
    Module again = parse(source_text(module), {"random"});
    again.files.clear();
    for (Section& section : again.sections) {
        section.location = {};
        for (Item& item : section.items) item.location = {};
    }
    RC_ASSERT(again == module);
}

RC_GTEST_PROP(RoundTrip, AListingHasEveryByte, ()) {
    const Program program = link({random_module()}, rooted({"f0"}));
    std::size_t bytes = 0;
    const std::string text = listing(program);
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
        if (text[at] == ';' || text[at] == ' ' || text[at] == '\n') continue;
        const std::size_t address = std::stoul(text.substr(at, 4), nullptr, 16);
        for (std::size_t byte = 0; byte < 3 && text[at + 6 + 3 * byte] != ' '; ++byte) {
            RC_ASSERT(std::stoul(text.substr(at + 6 + 3 * byte, 2), nullptr, 16) ==
                      program.image.bytes[address + byte]);
            ++bytes;
        }
    }
    RC_ASSERT(bytes == program.image.present.count());
}

/// Zilog names of instructions that both processors have, a few of each form.
TEST(RoundTrip, AnIndependentAssemblerGivesTheSameBytes) {
    if (std::system("z80-unknown-coff-as --version >/dev/null 2>&1") != 0) {
        FAIL() << "z80-unknown-coff-as is not installed (apt-get install binutils-z80)";
    }
    constexpr std::pair<const char*, const char*> kBoth[] = {{"MOV B,M", "ld b,(hl)"},
                                                             {"MOV M,E", "ld (hl),e"},
                                                             {"MVI M,12H", "ld (hl),0x12"},
                                                             {"LXI SP,1234H", "ld sp,0x1234"},
                                                             {"STAX D", "ld (de),a"},
                                                             {"LDAX B", "ld a,(bc)"},
                                                             {"STA 1234H", "ld (0x1234),a"},
                                                             {"LHLD 1234H", "ld hl,(0x1234)"},
                                                             {"XCHG", "ex de,hl"},
                                                             {"XTHL", "ex (sp),hl"},
                                                             {"SPHL", "ld sp,hl"},
                                                             {"PCHL", "jp (hl)"},
                                                             {"PUSH PSW", "push af"},
                                                             {"JNZ 1234H", "jp nz,0x1234"},
                                                             {"JPO 1234H", "jp po,0x1234"},
                                                             {"CM 1234H", "call m,0x1234"},
                                                             {"RPE", "ret pe"},
                                                             {"RST 5", "rst 0x28"},
                                                             {"INX H", "inc hl"},
                                                             {"DCX B", "dec bc"},
                                                             {"INR M", "inc (hl)"},
                                                             {"DAD SP", "add hl,sp"},
                                                             {"ADD C", "add a,c"},
                                                             {"ACI 12H", "adc a,0x12"},
                                                             {"SUI 12H", "sub 0x12"},
                                                             {"SBB M", "sbc a,(hl)"},
                                                             {"ANA H", "and h"},
                                                             {"XRI 12H", "xor 0x12"},
                                                             {"ORA L", "or l"},
                                                             {"CPI 12H", "cp 0x12"},
                                                             {"RLC", "rlca"},
                                                             {"RRC", "rrca"},
                                                             {"RAL", "rla"},
                                                             {"RAR", "rra"},
                                                             {"CMA", "cpl"},
                                                             {"CMC", "ccf"},
                                                             {"STC", "scf"},
                                                             {"DAA", "daa"},
                                                             {"IN 12H", "in a,(0x12)"},
                                                             {"OUT 12H", "out (0x12),a"},
                                                             {"EI", "ei"},
                                                             {"HLT", "halt"}};
    const auto folder = std::filesystem::path(testing::TempDir()) / "rover85_round_trip";
    std::filesystem::create_directories(folder);
    std::string ours;
    {
        std::ofstream theirs(folder / "a.s");
        for (const auto& [intel, zilog] : kBoth) {
            ours += std::string(intel) + '\n';
            theirs << '\t' << zilog << '\n';
        }
    }
    const std::string base = (folder / "a").string();
    const std::string command = "z80-unknown-coff-as -o '" + base + ".o' '" + base +
                                ".s' && z80-unknown-coff-objcopy -O binary '" + base + ".o' '" +
                                base + ".bin'";
    ASSERT_EQ(std::system(command.c_str()), 0);
    std::ifstream in(folder / "a.bin", std::ios::binary);
    const std::string content((std::istreambuf_iterator<char>(in)), {});
    const Program program = link({parse(ours, {"ours", uint16_t{0}})});
    EXPECT_EQ(bytes_at(program, 0, program.image.present.count()),
              Bytes(content.begin(), content.end()));
    std::filesystem::remove_all(folder);
}

}  // namespace
