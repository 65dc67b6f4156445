// link_test.cpp - what is kept, where it goes, what is refused. Addresses derived by hand.
#include "toolchain/asm/link.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>

#include "support.hpp"
#include "toolchain/asm/verify.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

std::string refused(std::string_view source, const LinkOptions& options) {
    return errors_of([&] { (void)linked(source, options); });
}

constexpr std::string_view kParts = R"(
        SECTION main,code
main:   CALL  used
        LXI   H,counter
        LDA   level
        RET
        SECTION used,code
used:   LDA   used.slot
        RET
        SECTION unused,code
unused: CALL  used
        SECTION level,initialised
level:  DB    5,6,7
        SECTION other,initialised
other:  DB    9
        SECTION counter,zero
counter: DS   3
        SECTION used.frame,frame,OFFSET 4
used.slot: DS 2
        SECTION log,persistent,AT 0FF00H
log:    DS    16
)";

LinkOptions small_options() {
    LinkOptions options = rooted({"main"});
    options.rom = {0x0100, 0x01FF};
    options.ram = {0x8000, 0x80FF};
    options.stack_size = 0x20;
    return options;
}

TEST(Link, PlacesWhatIsReached) {
    const Program program = linked(kParts, small_options());
    EXPECT_EQ(value_of(program, "main"), 0x0100);  // 3+3+3+1 bytes
    EXPECT_EQ(value_of(program, "used"), 0x010A);  // 3+1 bytes
    EXPECT_EQ(value_of(program, "unused"), -1);    // nobody refers to it
    EXPECT_EQ(value_of(program, "other"), -1);
    EXPECT_EQ(value_of(program, "used.slot"), 0x8004);
    EXPECT_EQ(value_of(program, "level"), 0x8006);  // frames take 4+2
    EXPECT_EQ(value_of(program, "counter"), 0x8009);
    EXPECT_EQ(value_of(program, "log"), 0xFF00);  // a fixed address is kept
    EXPECT_EQ(program.data, (Region{0x8006, 3}));
    EXPECT_EQ(program.data_image, (Region{0x010E, 3}));
    EXPECT_EQ(program.zero, (Region{0x8009, 3}));
    EXPECT_EQ(program.frames, (Region{0x8000, 6}));
    EXPECT_EQ(program.stack, (Region{0x80E0, 0x20}));
    EXPECT_EQ(bytes_at(program, 0x0100, 17),
              (Bytes{0xCD, 0x0A, 0x01, 0x21, 0x09, 0x80, 0x3A, 0x06, 0x80, 0xC9,  // main
                     0x3A, 0x04, 0x80, 0xC9,                                      // used
                     5, 6, 7}));
    EXPECT_EQ(program.image.present.count(), 17u);
    EXPECT_TRUE(verify(program).empty());
    EXPECT_EQ(program.find("main")->size, 10u);
    EXPECT_EQ(program.find("level")->size, 3u);
    EXPECT_EQ(program.find("main")->kind, LabelKind::function);
}

TEST(Link, FramesOverlayEachOther) {
    const Program program = linked(R"(
        SECTION f,code
f:      LHLD  f.a
        LHLD  g.a
        SECTION f.frame,frame,OFFSET 0
f.a:    DS    6
        SECTION g.frame,frame,OFFSET 2
g.a:    DS    2
)",
                                   rooted({"f"}));
    EXPECT_EQ(value_of(program, "f.a"), 0x8000);
    EXPECT_EQ(value_of(program, "g.a"), 0x8002);
    EXPECT_EQ(program.frames.size, 6u);
    EXPECT_TRUE(verify(program).empty());
}

TEST(Link, VectorsAndGapsBetweenThem) {
    LinkOptions options;
    options.vectors = {{0x0000, "boot"}, {0x0024, "trap"}};
    const Program program = linked(R"(
        SECTION boot,code
boot:   JMP   boot
        SECTION big,code
trap:   DS    40
        RET
)",
                                   options);
    EXPECT_EQ(bytes_at(program, 0, 3), (Bytes{0xC3, 0x03, 0x00}));
    EXPECT_EQ(bytes_at(program, 0x24, 3), (Bytes{0xC3, 0x27, 0x00}));
    EXPECT_EQ(value_of(program, "boot"), 0x03);
    EXPECT_EQ(value_of(program, "trap"), 0x27);
    EXPECT_EQ(program.start, 0x0003);
    EXPECT_EQ(program.find("__vector_0024")->kind, LabelKind::interrupt_entry);
}

TEST(Link, VectorsBehindALoaderAndTheLoadersOwn) {
    LinkOptions options;
    options.rom = {0x0C00, 0x7FBF};
    options.vector_base = 0x0C00;
    options.vectors = {{0x0000, "boot"}, {0x0024, "trap"}};
    const char* source = R"(
        SECTION boot,code
boot:   JMP   boot
        SECTION trap,code
trap:   RET
)";
    const Program program = linked(source, options);
    EXPECT_EQ(bytes_at(program, 0x0C00, 3), (Bytes{0xC3, 0x03, 0x0C}));
    EXPECT_EQ(bytes_at(program, 0x0C24, 3), (Bytes{0xC3, 0x06, 0x0C}));
    EXPECT_EQ(program.find("__vector_0C24")->kind, LabelKind::interrupt_entry);
    EXPECT_EQ(program.start, 0x0C03);
    options.vectors = {{0x0000, "boot"}};
    options.rom = {0x0000, 0x01FF};
    options.vector_base = 0;
    options.forward_to = 0x0C00;
    options.roots = {"boot"};
    const Program loader = linked(source, options);
    EXPECT_EQ(bytes_at(loader, 0x24, 3), (Bytes{0xC3, 0x24, 0x0C}));
    EXPECT_EQ(bytes_at(loader, 0x2C, 3), (Bytes{0xC3, 0x2C, 0x0C}));
    EXPECT_EQ(bytes_at(loader, 0x34, 3), (Bytes{0xC3, 0x34, 0x0C}));
    EXPECT_EQ(bytes_at(loader, 0x3C, 3), (Bytes{0xC3, 0x3C, 0x0C}));
    options.vector_base = 0xFFF0;
    options.vectors = {{0x0024, "trap"}};
    EXPECT_THROW((void)linked(source, options), toolchain::assembly::Error);
}

TEST(Link, NamesOfTheLinkerAndEquatesOfOtherModules) {
    LinkOptions options = small_options();
    options.roots = {"f"};
    const Program program =
        link({module_of("SECTION f,code\nf: LXI H,__stack_end\nMVI A,SIZE\nLXI D,near\n"),
              module_of("SIZE EQU 7\nSECTION g,code\ng: NOP\nnear EQU g+1\n")},
             options);
    EXPECT_EQ(bytes_at(program, 0x100, 8), (Bytes{0x21, 0x00, 0x81, 0x3E, 0x07, 0x11, 0x09, 0x01}));
    EXPECT_EQ(value_of(program, "near"), 0x0109);
}

TEST(Link, WhatIsMissingIsNamed) {
    EXPECT_EQ(refused("SECTION f,code\nf: NOP\nCALL gone\nCALL gone\nJMP lost\n", rooted({"f"})),
              "t.s85:3: 'gone' is not defined\nt.s85:5: 'lost' is not defined");
    EXPECT_EQ(refused("NOP", rooted({"main"})), "'main' is to be linked, but no module defines it");
}

TEST(Link, FullRangesAreExplained) {
    LinkOptions options = rooted({"f"});
    options.rom = {0x0000, 0x001F};
    EXPECT_EQ(refused("SECTION f,code\nf: LXI H,g\nSECTION g,constant\ng: DS 30\n", options),
              "ROM: 33 bytes needed, 32 there (0000H-001FH), 1 too many; largest: g 30, f 3");
    options.ram = {0x8000, 0x800F};
    options.stack_size = 6;
    EXPECT_EQ(refused("SECTION f,code\nf: LXI H,g\nLXI H,s\nSECTION g,zero\ng: DS 9\n"
                      "SECTION s,frame,OFFSET 1\ns: DS 1\n",
                      options),
              "RAM: 17 bytes needed, 16 there (8000H-800FH), 1 too many; largest: g 9, stack 6, "
              "frames 2");
    options.rom = {0x0000, 0x003F};
    EXPECT_EQ(
        refused("SECTION f,code\nf: LXI H,g\nSECTION g,constant\ng: DS 30\n"
                "SECTION x,constant,AT 16\nx: DS 20\n",
                options),
        "ROM: 53 bytes needed, 64 there (0000H-003FH), but no gap for 30 of them; the largest "
        "has 28; largest: g 30, x 20, f 3");
}

TEST(Link, FixedSectionsMustNotOverlap) {
    EXPECT_EQ(refused("SECTION f,code,AT 8\nDS 4\nSECTION g,constant,AT 11\nDS 2\n", {}),
              "section 'g' at 000BH-000CH overlaps 'f' at 0008H-000BH");
    EXPECT_EQ(refused("SECTION f,code,AT 8\nDS 4\nSECTION g,constant,AT 12\nDS 2\n", {}),
              "accepted");
    EXPECT_EQ(refused("SECTION f,zero,AT 8\nDS 4\n", {}),
              "section 'f' is of kind zero and cannot have a fixed address; persistent, code and "
              "constant can");
}

TEST(Link, ClearedMemoryHoldsSpaceOnly) {
    EXPECT_EQ(refused("SECTION f,zero\nf: DB 4\n", rooted({"f"})),
              "t.s85:2: section 'f' is of kind zero and holds space only");
}

TEST(Link, ValuesBeyondTheirPlace) {
    EXPECT_EQ(refused("SECTION f,code,AT 100H\nf: MVI A,f\nLXI H,f+0FF00H\n", {}),
              "t.s85:2: 'f' is 0100H, beyond 8 bits\nt.s85:3: 'f+65280' is beyond 16 bits");
}

TEST(Link, Alignment) {
    const Program program = linked(
        "SECTION f,code\nf: LXI H,t\nSECTION t,constant,ALIGN 16\nt: DS 4\n"
        "SECTION g,code\ng: NOP\n",
        rooted({"f", "g"}));
    EXPECT_EQ(value_of(program, "t"), 0x10);
    EXPECT_EQ(value_of(program, "g"), 0x03);  // fills the gap
}

// Variables fill the gaps that aligned ones leave, and the most aligned kind of memory comes first.
TEST(Link, AlignmentInRam) {
    LinkOptions options = rooted({"f"});
    options.ram = {0x8000, 0x87FF};
    options.stack_size = 0x20;
    const Program program = linked(
        "SECTION f,code\nf: LXI H,va\nLXI H,vb\nLXI H,vc\nLXI H,vd\nLDA vs\n"
        "SECTION f@frame,frame\nvs: DS 7\nSECTION va,zero\nva: DS 10\n"
        "SECTION vb,zero,ALIGN 256\nvb: DS 260\nSECTION vc,zero,ALIGN 256\nvc: DS 3\n"
        "SECTION vd,zero\nvd: DS 20\n",
        options);
    EXPECT_EQ(value_of(program, "vb"), 0x8000);
    EXPECT_EQ(value_of(program, "vc"), 0x8200);
    EXPECT_EQ(value_of(program, "va"), 0x8104);
    EXPECT_EQ(value_of(program, "vd"), 0x810E);
    EXPECT_EQ(value_of(program, "vs"), 0x8203);
}

TEST(Link, ThirtyThousandInstructionsTakeLittleTime) {
    std::vector<Module> modules(1);
    std::vector<std::string> roots;
    for (int number = 0; number < 300; ++number) {
        Section section;
        section.name = fmt::format("f{}", number);
        section.items.push_back(label(section.name));
        for (int i = 0; i < 50; ++i) {
            section.items.push_back(instruction(0x00));
            section.items.push_back(instruction(0xCD, {fmt::format("f{}", (number + i) % 300)}));
        }
        modules[0].sections.push_back(std::move(section));
    }
    LinkOptions options = rooted({"f0"});
    options.rom = {0x0000, 0xEFFF};
    options.ram = {0xF000, 0xFFFF};
    const auto begin = std::chrono::steady_clock::now();
    const Program program = link(std::move(modules), options);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
    EXPECT_EQ(program.image.present.count(), 300u * 50u * 4u);
}

}  // namespace
