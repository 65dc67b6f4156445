// board_target_test.cpp - images that do not do their part are refused or reported with time, place
// and reason. What a good image does: tests/system/board_targets_test.cpp.
#include "host_sim/bind/board_target.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/support/assemble.hpp"

namespace {

using host_sim::BoardError;
using host_sim::BoardTarget;
using host_sim::Image;
using host_sim::ImageError;
using host_sim::Symbol;
using host_sim::SymbolKind;
using host_sim::Symbols;

constexpr uint16_t kTickCount = 0x8000, kStepCount = 0x8002;

struct Program {
    Image image;
    Symbols symbols;
};

/// A program whose step begins at the label ACQ.
Program assembled(const std::string& source) {
    const auto code = test_support::assemble(source);
    Program program;
    for (std::size_t i = 0; i < code.bytes.size(); ++i) {
        program.image.put(static_cast<uint16_t>(code.origin + i), code.bytes[i]);
    }
    program.image.file = "tiny.hex";
    std::vector<Symbol> symbols(3);
    symbols[0] = {kTickCount, 2, SymbolKind::data, "rover_tick_count"};
    symbols[1] = {kStepCount, 2, SymbolKind::data, "rover_step_count"};
    symbols[2] = {code.symbols.at("ACQ"), 1, SymbolKind::function,
                  "ns::(anonymous)::rover_acquire()"};
    program.symbols = Symbols(std::move(symbols), "tiny.sym");
    return program;
}

std::string error_of(const std::string& source) {
    const Program program = assembled(source);
    BoardTarget target(program.image, program.symbols);
    try {
        target.begin({});
    } catch (const BoardError& error) {
        return error.what();
    }
    return "no error";
}

bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(BoardTarget, AnImageThatHangsIsResetByItsWatchdogAndReported) {
    const std::string error = error_of("LOOP: JMP LOOP\nACQ: NOP");
    EXPECT_TRUE(has(error, "tiny.hex: the watchdog has reset the board")) << error;
    EXPECT_TRUE(has(error, ", 0.50") || has(error, ", 0.51")) << error;  // seen within 16 ms
    EXPECT_TRUE(has(error, " s after power-up")) << error;
    EXPECT_TRUE(has(error, "; find what kept")) << error;
}

TEST(BoardTarget, AViolationIsReportedWithInstructionAndAddress) {
    const std::string out = error_of("NOP\nOUT 77H\nHLT\nACQ: NOP");
    EXPECT_TRUE(has(out, "OUT to a port that nobody answers (0077H, by the instruction at 0001H"))
        << out;
    const std::string write = error_of("MVI A,5\nSTA 1000H\nHLT\nACQ: NOP");
    EXPECT_TRUE(has(write, "a write that the EEPROM ignores (1000H, by the instruction at 0002H"))
        << write;
}

TEST(BoardTarget, AnImageThatHaltsForEverIsReported) {
    const std::string error = error_of("DI\nHLT\nACQ: NOP");
    EXPECT_TRUE(has(error, "halted with interrupts disabled")) << error;
}

TEST(BoardTarget, AnImageThatNeverBeginsItsStepIsReported) {
    // The tick is let through and SOD toggles, so the watchdog is content; but nobody steps.
    const std::string error =
        error_of("MVI A,8\nSIM\nEI\nLOOP: MVI A,0C0H\nSIM\nMVI A,40H\nSIM\nJMP LOOP\nACQ: NOP");
    EXPECT_TRUE(has(error, "does not begin its step")) << error;
}

TEST(BoardTarget, AnImageThatStepsAndDoesNotAnswerTheLinkIsReported) {
    const std::string error = error_of(
        "MVI A,8\nSIM\nEI\nLOOP: MVI A,0C0H\nSIM\nMVI A,40H\nSIM\nCALL ACQ\nJMP LOOP\nACQ: RET");
    EXPECT_TRUE(has(error, "no answer to the link frame of type 01H within 2.0 s")) << error;
}

TEST(BoardTarget, ImagesThatAreNoneOfThisBoardAreRefused) {
    Program program = assembled("ACQ: HLT");
    EXPECT_THROW(BoardTarget(program.image, Symbols()), ImageError);
    try {
        const BoardTarget target(program.image, Symbols());
    } catch (const ImageError& error) {
        EXPECT_TRUE(has(error.what(), "tiny.hex: its symbols have no rover_tick_count;"))
            << error.what();
    }
    program.image.put(0x9000, 1);
    EXPECT_THROW(BoardTarget(program.image, program.symbols), ImageError);
    EXPECT_THROW(BoardTarget(std::filesystem::path("nowhere.hex")), ImageError);
}

}  // namespace
