// parse_test.cpp - source to items, by hand; the instructions themselves are in round_trip_test and
// tests/support/assemble_test.
#include "toolchain/asm/parse.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

std::string refused(std::string_view source) {
    return errors_of([&] { (void)module_of(source); });
}

TEST(Parse, SectionsLabelsAndOperands) {
    const Module module = module_of(R"(
        SECTION drive,code,TITLE 'rover::drive(int)'
drive:  LDA   drive.speed+1
.loop:  MVI   H,HIGH(table)
        JMP   .loop          ;@loop 12
        SECTION table,constant,ALIGN 256
table:  DB    1,'ab',LOW(drive)
        DW    drive+1,table.end-table
table.end:
        SECTION drive.frame,frame,OFFSET 6,FUNCTION drive
drive.speed: DS 2
)");
    ASSERT_EQ(module.sections.size(), 3u);
    const Section& code = module.sections[0];
    EXPECT_EQ(code.title, "rover::drive(int)");
    EXPECT_EQ(code.items,
              (std::vector<Item>{label("drive", LabelKind::automatic, 0, {0, 3}),
                                 instruction(0x3A, {"drive.speed", 1}, {0, 3}),
                                 label(".loop", LabelKind::automatic, 0, {0, 4}),
                                 instruction(0x26, {"table", 0, Part::high}, {0, 4}),
                                 note("loop 12", {0, 5}), instruction(0xC3, {".loop"}, {0, 5})}));
    const Section& table = module.sections[1];
    EXPECT_EQ(table.kind, SectionKind::constant);
    EXPECT_EQ(table.alignment, 256u);
    EXPECT_EQ(table.items[2], data_bytes({'a', 'b'}, {0, 7}));
    EXPECT_EQ(table.items[3], data_byte({"drive", 0, Part::low}, {0, 7}));
    EXPECT_EQ(table.items[5], data_word({"", 8}, {0, 8}));
    const Section& frame = module.sections[2];
    EXPECT_EQ(frame.kind, SectionKind::frame);
    EXPECT_EQ(frame.frame_offset, 6u);
    EXPECT_EQ(frame.function, "drive");
}

TEST(Parse, LocalNamesAreKnownInTheirSectionOnly) {
    EXPECT_EQ(refused("SECTION one,code\n.x: NOP\nSECTION two,code\n.x: JMP .x"), "accepted");
    EXPECT_EQ(refused("SECTION one,code\n.x: NOP\nSECTION two,code\nJMP .x"),
              "t.s85:4: '.x' is not defined");
}

TEST(Parse, ASectionCanBeContinued) {
    const Module module = module_of(
        "SECTION one,code\nx1: NOP\nSECTION two,zero\ny1: DS 4\n"
        "SECTION one,code\nx2: NOP\nDW x2-x1\n");
    ASSERT_EQ(module.sections.size(), 2u);
    EXPECT_EQ(module.sections[0].items.back().operand, (Operand{"", 1}));
}

TEST(Parse, TheCurrentAddressInARelocatableSection) {
    // A jump to itself, 1 behind the start; links at 0 behind nothing else.
    const Program program = linked("SECTION one,code\nx: NOP\nJMP $\nDW x-$\n", rooted({"x"}));
    EXPECT_EQ(bytes_at(program, 0, 6), (Bytes{0x00, 0xC3, 0x01, 0x00, 0xFC, 0xFF}));
}

TEST(Parse, CommentsThatDescribeARoutine) {
    const Module module = parse(R"(; in the file's comment nothing counts
SECTION mul,code
; __mul      HL = HL * DE
;   in       HL DE
;   t        123 to 474
__mul:  SHLD __mul.left
;   just a comment
        RET
;   t        5 to 6
__mul2: RET
)",
                                {"mul.s85", {}, true});
    ASSERT_EQ(module.sections.size(), 1u);
    const Section& code = module.sections[0];
    EXPECT_EQ(code.items[0], note("in HL DE", {0, 4}));
    EXPECT_EQ(code.items[1], note("t 123 to 474", {0, 5}));
    EXPECT_EQ(code.items[2].label_kind, LabelKind::function);
    EXPECT_EQ(code.items[5], note("t 5 to 6", {0, 9}));
    EXPECT_EQ(code.items[6].label_kind, LabelKind::function);
    EXPECT_EQ(code.items.size(), 8u);
}

TEST(Parse, EveryMistakeIsReportedWithItsLine) {
    EXPECT_EQ(refused("MOVE A,B\nMVI A,256\nNOP\nSECTION x,heap\nSECTION x,code,ALIGN 3\n"),
              "t.s85:1: 'MOVE' is neither instruction nor directive\n"
              "t.s85:4: 'heap' is no kind of section; code, constant, initialised, zero, "
              "persistent, frame are\n"
              "t.s85:5: 'ALIGN 3' is no option of SECTION\n"
              "t.s85:2: '256' is beyond 8 bits");
    EXPECT_EQ(refused("SECTION x,code\nSECTION x,zero"), "t.s85:2: section 'x' is of kind code");
    EXPECT_EQ(refused("SECTION x"), "t.s85:1: SECTION takes a name and a kind");
    EXPECT_EQ(refused("NOP\nORG 5"), "t.s85:2: ORG in a section without a fixed address");
    EXPECT_EQ(refused("x: NOP\nx: NOP"), "t.s85:2: 'x' is defined twice");
    EXPECT_EQ(refused("x: NOP\nDS x"), "t.s85:2: 'x' is an address and not a number");
}

}  // namespace
