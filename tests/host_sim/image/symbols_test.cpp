// symbols_test.cpp - symbol files as docs/spec/symbols.md has them.
#include "host_sim/image/symbols.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <fstream>

namespace {

using host_sim::ImageError;
using host_sim::read_symbols;
using host_sim::Symbol;
using host_sim::SymbolKind;
using host_sim::Symbols;

std::string error_of(const std::string& text) {
    try {
        (void)read_symbols(text, "a.sym");
    } catch (const ImageError& error) {
        return error.what();
    }
    return "accepted";
}

/// The example of the page, taken from the page.
std::string page_example() {
    std::ifstream page(ROVER_SOURCE_DIR "/docs/spec/symbols.md");
    std::string line;
    std::string example;
    bool inside = false;
    while (std::getline(page, line)) {
        if (line.starts_with("# rover85")) inside = true;
        if (inside && line == "```") break;
        if (inside) example += line + "\n";
    }
    return example;
}

TEST(Symbols, TheExampleOfThePage) {
    const Symbols symbols = read_symbols(page_example(), "a.sym");
    ASSERT_EQ(symbols.all().size(), 5u);

    const std::string drive = "rover::drive(rover::State&, unsigned char)";
    const Symbol* function = symbols.find(drive);
    ASSERT_NE(function, nullptr);
    EXPECT_EQ(function->address, 0x0100);
    EXPECT_EQ(function->size, 0x40u);
    EXPECT_EQ(function->kind, SymbolKind::function);
    EXPECT_EQ(function->source, "firmware/drive.cpp");
    EXPECT_EQ(function->source_line, 30u);

    EXPECT_EQ(symbols.describe(0x0100), drive);
    EXPECT_EQ(symbols.describe(0x0105), drive + "+5");
    EXPECT_EQ(symbols.describe(0x013F), drive + "+63");
    EXPECT_EQ(symbols.describe(0x0140), "");
    EXPECT_EQ(symbols.source_at(0x0103)->source_line, 30u);
    EXPECT_EQ(symbols.source_at(0x0104)->source_line, 31u);
    EXPECT_EQ(symbols.source_at(0x010A)->source_line, 30u);

    EXPECT_EQ(symbols.function_at(0x0026)->name, "trap_entry");
    EXPECT_EQ(symbols.function_at(0x0026)->kind, SymbolKind::interrupt_entry);
    EXPECT_EQ(symbols.at(0x8000)->name, "rover::state");
    EXPECT_EQ(symbols.function_at(0x8000), nullptr);
    EXPECT_EQ(symbols.find("-"), nullptr);
    EXPECT_EQ(symbols.find("nobody"), nullptr);
}

TEST(Symbols, WithoutSizeASymbolReachesToTheNext) {
    const Symbols symbols = read_symbols(
        "0200 0000 F b\n0100 0000 F a\n0110 0000 L inner\nFFF0 0000 L last\n", "a.sym");
    EXPECT_EQ(symbols.describe(0x0110), "a+16");  // the function, not the label in it
    EXPECT_EQ(symbols.describe(0x01FF), "a+255");
    EXPECT_EQ(symbols.describe(0x0200), "b");
    EXPECT_EQ(symbols.describe(0x00FF), "");
    EXPECT_EQ(symbols.find("inner")->address, 0x0110);
}

TEST(Symbols, LabelsNameWhatNoFunctionCovers) {
    const Symbols symbols = read_symbols("0100 0010 F a\n0110 0004 L table\n", "a.sym");
    EXPECT_EQ(symbols.describe(0x0112), "table+2");
    EXPECT_EQ(symbols.function_at(0x0112), nullptr);
    EXPECT_EQ(symbols.describe(0x0114), "");
}

TEST(Symbols, CommentsSpacesAndCarriageReturnsAreFine) {
    const Symbols symbols =
        read_symbols("# head\r\n\r\n  0100  0001   F   f  @  my file.cpp:7  \r\n", "a.sym");
    ASSERT_EQ(symbols.all().size(), 1u);
    EXPECT_EQ(symbols.all()[0].name, "f");
    EXPECT_EQ(symbols.all()[0].source_line, 7u);
    EXPECT_EQ(read_symbols("", "a.sym").all().size(), 0u);
    EXPECT_EQ(read_symbols("FFFF 0001 D top", "a.sym").describe(0xFFFF), "top");
}

TEST(Symbols, MistakesAreRefusedWithLineAndForm) {
    const std::string form = "; write ADDR SIZE KIND NAME [@ SOURCE:LINE]";
    EXPECT_EQ(error_of("\n100 0001 F f"),
              "a.sym:2: address '100' is not four hexadecimal digits" + form);
    EXPECT_EQ(error_of("0100 +001 F f"),
              "a.sym:1: size '+001' is not four hexadecimal digits" + form);
    EXPECT_EQ(error_of("0100 -001 F f"),
              "a.sym:1: size '-001' is not four hexadecimal digits" + form);
    EXPECT_EQ(error_of("0100"), "a.sym:1: size '' is not four hexadecimal digits" + form);
    EXPECT_EQ(error_of("0100 0001 X f"), "a.sym:1: kind 'X' is not F, I, D or L" + form);
    EXPECT_EQ(error_of("0100 0001 F"), "a.sym:1: has no name" + form);
    EXPECT_EQ(error_of("0100 0001 F -"), "a.sym:1: only an L goes unnamed" + form);
    EXPECT_EQ(error_of("0100 0001 F f @ x.cpp"), "a.sym:1: 'x.cpp' is not SOURCE:LINE" + form);
    EXPECT_EQ(error_of("0100 0001 F f @ x.cpp:0"), "a.sym:1: 'x.cpp:0' is not SOURCE:LINE" + form);
    EXPECT_EQ(error_of("0100 0001 F f @ :5"), "a.sym:1: ':5' is not SOURCE:LINE" + form);
    EXPECT_EQ(error_of("0100\t0001 F f"), "a.sym:1: holds a control character" + form);
}

TEST(Symbols, ContradictionsAreRefusedNamingBothLines) {
    EXPECT_EQ(error_of("0100 0001 F f\n0200 0001 F f"),
              "a.sym:2: 'f' is named again, first at line 1; give each symbol its own name");
    EXPECT_EQ(error_of("0100 0010 F f\n010F 0001 D d"),
              "a.sym:2: 'd' and 'f' of line 1 share address 010FH; correct their addresses or "
              "sizes");
    EXPECT_EQ(error_of("FFFF 0002 D d"),
              "a.sym:1: 'd' goes beyond FFFFH; correct its address or size");
    EXPECT_EQ(error_of("0100 0010 F f\n0110 0001 D d"), "accepted");
}

RC_GTEST_PROP(Symbols, ArbitraryTextIsReadOrRefusedAndNothingElse, (const std::string& text)) {
    try {
        (void)read_symbols("0100 0001 F f\n" + text, "a");
    } catch (const ImageError&) {
        RC_SUCCEED("refused");
    }
}

}  // namespace
