// An interrupt at every instruction of a main program that uses the same functions and routines
// leaves the results of both right.
#include "toolchain/codegen/copies.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "tests/toolchain/codegen/compiled_program.hpp"
#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/asm/program.hpp"

namespace {

using codegen_test::CompiledProgram;
using host_sim::Interrupt;
using testing::HasSubstr;
using namespace toolchain::codegen;

/// All programs by the real generator and by the plain one.
class WithGenerator : public testing::TestWithParam<codegen_test::NamedGenerator> {
protected:
    static CompiledProgram program_of(const std::string& text) {
        return {GetParam().generator, ir_test::to_mir(text)};
    }
    static std::string refusal_of(const std::string& text) {
        try {
            (void)program_of(text);
        } catch (const Refused& refused) {
            return refused.what();
        }
        return "accepted";
    }
};

// `mix` has a frame, memory arguments and a memory result and uses cells of the runtime; `scale`
// has none of its own but calls `mix`; `twice` needs no memory in a clever generator.
constexpr const char* kShared = R"(
declare void @__i85_ei()
declare void @__i85_di()
@product = global i64 0
@quotient = global i32 0
@main_mix = global i64 0
@trap_mix = global i64 0
@tick_mix = global i64 0
@tick_own = global i64 0
@trap_quotient = global i32 0
@tick_quotient = global i32 0
@traps = global i16 0
@ticks = global i16 0
define i64 @mix(i64 %a, i64 %b, i16 %c) noinline {
  %p = mul i64 %a, %b
  %c64 = zext i16 %c to i64
  %s = add i64 %p, %c64
  %q = lshr i64 %s, 5
  %r = xor i64 %q, %a
  ret i64 %r
}
define i64 @scale(i64 %a) noinline {
  %r = call i64 @mix(i64 %a, i64 1000003, i16 77)
  ret i64 %r
}
define void @work(ptr %mixed, ptr %divided, i64 %seed) noinline {
  %1 = call i64 @scale(i64 %seed)
  %2 = call i64 @mix(i64 %1, i64 %seed, i16 513)
  store i64 %2, ptr %mixed
  %low = trunc i64 %2 to i32
  %3 = trunc i64 %seed to i32
  %4 = or i32 %3, 65537
  %5 = udiv i32 %low, %4
  %6 = mul i32 %5, %low
  store i32 %6, ptr %divided
  ret void
}
define void @on_trap() "interrupt"="36" {
  call void @work(ptr @trap_mix, ptr @trap_quotient, i64 999999999937)
  %n = load i16, ptr @traps
  %m = add i16 %n, 1
  store i16 %m, ptr @traps
  ret void
}
define void @on_tick() "interrupt"="60" {
  call void @work(ptr @tick_mix, ptr @tick_quotient, i64 123456789123)
  %1 = load i64, ptr @tick_mix
  %2 = mul i64 %1, 999999
  store i64 %2, ptr @tick_own
  %n = load i16, ptr @ticks
  %m = add i16 %n, 1
  store i16 %m, ptr @ticks
  ret void
}
define void @main() {
  call void @__i85_ei()
  call void @work(ptr @main_mix, ptr @quotient, i64 72057594037927935)
  %1 = load i64, ptr @main_mix
  %2 = mul i64 %1, 12345
  store i64 %2, ptr @product
  call void @__i85_di()
  ret void
}
)";

struct Results {
    uint64_t mixed;
    uint32_t divided;
};

uint64_t mix(uint64_t a, uint64_t b, uint16_t c) {
    return ((a * b + c) >> 5) ^ a;
}

Results work(uint64_t seed) {
    const uint64_t mixed = mix(mix(seed, 1000003, 77), seed, 513);
    const auto low = static_cast<uint32_t>(mixed);
    return {mixed, low / (static_cast<uint32_t>(seed) | 65537) * low};
}

class SharedWork : public WithGenerator {
protected:
    CompiledProgram program = program_of(kShared);

    /// The first instruction before which RST 7.5 is taken; the start-up, which uses SP for other
    /// things, is over then.
    uint64_t first_enabled() {
        uint64_t first = 0;
        for (; program.accepted() == 0; ++first) {
            program.run(
                [&](uint64_t now) { return now == first ? Interrupt::rst75 : Interrupt::none; });
        }
        return first - 1;
    }

    void expect_main() {
        const Results wanted = work(72057594037927935);
        ASSERT_EQ(program.variable("main_mix", 8), wanted.mixed);
        ASSERT_EQ(program.variable("quotient", 4), wanted.divided);
        ASSERT_EQ(program.variable("product", 8), wanted.mixed * 12345);
    }
    void expect_handler(const std::string& name, uint64_t seed, unsigned times) {
        ASSERT_EQ(program.variable(name + "s", 2), times);
        if (times == 0) return;
        ASSERT_EQ(program.variable(name + "_mix", 8), work(seed).mixed);
        ASSERT_EQ(program.variable(name + "_quotient", 4), work(seed).divided);
        if (name != "tick") return;
        ASSERT_EQ(program.variable("tick_own", 8), work(seed).mixed * 999999);
    }
};

INSTANTIATE_TEST_SUITE_P(Generators, SharedWork, testing::ValuesIn(codegen_test::generators()),
                         codegen_test::generator_name);

constexpr uint64_t kTrapSeed = 999999999937;
constexpr uint64_t kTickSeed = 123456789123;

TEST_P(SharedWork, WithoutInterrupts) {
    program.run();
    expect_main();
    EXPECT_LE(program.deepest_stack(), program.compiled().stack_bytes);
}

TEST_P(SharedWork, TrapAtEveryInstruction) {
    program.run();
    const uint64_t last = program.instructions();
    ASSERT_GT(last, 1000U);
    for (uint64_t at = first_enabled(); at < last - 1; ++at) {
        program.run([&](uint64_t now) { return now == at ? Interrupt::trap : Interrupt::none; });
        SCOPED_TRACE(at);
        expect_main();
        expect_handler("trap", kTrapSeed, program.accepted());
        if (HasFatalFailure()) return;
    }
}

TEST_P(SharedWork, Rst75AtEveryInstruction) {
    program.run();
    const uint64_t last = program.instructions();
    uint64_t taken = 0;
    for (uint64_t at = 0; at < last - 1; ++at) {
        program.run([&](uint64_t now) { return now == at ? Interrupt::rst75 : Interrupt::none; });
        SCOPED_TRACE(at);
        expect_main();
        expect_handler("tick", kTickSeed, program.accepted());
        if (HasFatalFailure()) return;
        taken += program.accepted();
    }
    EXPECT_GT(taken, last * 9 / 10);
}

TEST_P(SharedWork, BothAtOnceAndTrapWithinRst75) {
    program.run();
    const uint64_t last = program.instructions();
    uint32_t deepest = 0;
    for (uint64_t at = 50; at < last - 1; at += 7) {
        // RST 7.5 first; TRAP comes a while into its handler.
        program.run([&](uint64_t now) {
            if (now == at) return Interrupt::rst75;
            return now == at + 3 * (at % 400) + 1 ? Interrupt::trap : Interrupt::none;
        });
        SCOPED_TRACE(at);
        expect_main();
        expect_handler("tick", kTickSeed, static_cast<unsigned>(program.variable("ticks", 2)));
        expect_handler("trap", kTrapSeed, static_cast<unsigned>(program.variable("traps", 2)));
        ASSERT_EQ(program.variable("ticks", 2) + program.variable("traps", 2), program.accepted());
        if (HasFatalFailure()) return;
        deepest = std::max(deepest, program.deepest_stack());
    }
    EXPECT_LE(deepest, program.compiled().stack_bytes);
    // All three at their deepest at once is rare, two of them not.
    EXPECT_GT(deepest, program.compiled().stack_bytes / 2);
}

// TRAP comes while interrupts are off, too, and must leave them off.
TEST_P(SharedWork, TrapLeavesInterruptsAsTheyWere) {
    program.run();
    const uint64_t last = program.instructions();
    bool off = false;
    program.run([&](uint64_t now) {
        // Behind the DI of main there are RET and HLT.
        if (now == last - 2) {
            off = true;
            return Interrupt::trap;
        }
        return off ? Interrupt::rst75 : Interrupt::none;
    });
    expect_handler("trap", kTrapSeed, 1);
    expect_handler("tick", kTickSeed, 0);
    bool on = false;
    const uint64_t early = first_enabled() + 100;
    program.run([&](uint64_t now) {
        if (now == early) return Interrupt::trap;
        const bool first_after = !on && program.accepted() == 1 && now > early;
        if (!first_after) return Interrupt::none;
        on = program.enabled();
        return Interrupt::none;
    });
    EXPECT_TRUE(on);
}

TEST_P(SharedWork, CopiesHaveFramesAndCellsOfTheirOwn) {
    for (const std::string suffix : {"", "@trap", "@rst75"}) {
        for (const char* name : {"mix", "scale", "work", "__wide.a", "__mul64", "__udiv32.cells"}) {
            EXPECT_NE(program.program().find(name + suffix), nullptr) << name << suffix;
        }
    }
    // Without memory of its own one is enough.
    EXPECT_NE(program.program().find("__umul16w"), nullptr);
    EXPECT_EQ(program.program().find("__umul16w@trap"), nullptr);
    // What one context alone uses is not copied.
    EXPECT_EQ(program.program().find("main@trap"), nullptr);
    EXPECT_EQ(program.program().find("on_trap@rst75"), nullptr);
}

// Frames of different contexts never share a byte.
TEST_P(SharedWork, FramesOfContextsAreApart) {
    struct Range {
        uint32_t first = UINT32_MAX;
        uint32_t end = 0;
    };
    std::array<Range, 3> ranges;
    for (const FunctionReport& report : program.compiled().functions) {
        const bool trap = report.name.ends_with("@trap") || report.name == "on_trap";
        const bool tick = report.name.ends_with("@rst75") || report.name == "on_tick";
        Range& range = ranges.at(trap ? 1 : tick ? 2 : 0);
        range.first = std::min(range.first, report.frame_offset);
        range.end = std::max(range.end, report.frame_offset + report.frame_bytes);
    }
    EXPECT_EQ(ranges[0].first, 0U);
    EXPECT_EQ(ranges[1].first, ranges[0].end);
    EXPECT_EQ(ranges[2].first, ranges[1].end);
    EXPECT_EQ(program.program().frames.size, ranges[2].end);
}

// -- Pointers
// --------------------------------------------------------------------------------------

class CopiesOfPointers : public WithGenerator {};

INSTANTIATE_TEST_SUITE_P(Generators, CopiesOfPointers,
                         testing::ValuesIn(codegen_test::generators()),
                         codegen_test::generator_name);

/// A call-back that the main program calls through a pointer; %s is what the handler does.
std::string with_callback(const std::string& handler) {
    return fmt::format(R"(
@hook = global ptr @callback
@seen = global i16 0
@other = global ptr null
define i16 @callback(i16 %a) {{
  %kept = alloca i16
  store volatile i16 %a, ptr %kept
  %b = load volatile i16, ptr %kept
  %1 = mul i16 %a, %b
  store i16 %1, ptr @seen
  ret i16 %1
}}
define void @on_tick() "interrupt"="60" {{
  {}
  ret void
}}
define void @main() {{
  %f = load ptr, ptr @hook
  %1 = call i16 %f(i16 12)
  store i16 %1, ptr @seen
  ret void
}}
)",
                       handler);
}

TEST_P(CopiesOfPointers, AreRefusedWhereTwoContextsCallThem) {
    const std::string text =
        refusal_of(with_callback("%f = load ptr, ptr @hook\n %1 = call i16 %f(i16 3)"));
    EXPECT_THAT(text, HasSubstr("'callback' may be called through a pointer by the interrupt "
                                "function 'on_tick', and by the main program too"));
}

TEST_P(CopiesOfPointers, AreMadeWhereTheInterruptCallsByName) {
    auto program = program_of(with_callback("%1 = call i16 @callback(i16 3)"));
    EXPECT_NE(program.program().find("callback@rst75"), nullptr);
    program.run();
    EXPECT_EQ(program.variable("seen", 2), 144U);
}

// The same of a function that is a copy itself.
TEST_P(CopiesOfPointers, AnAddressInACopyIsTheOriginals) {
    auto program = program_of(R"(
@hook = global ptr @callback
@seen = global i16 0
define i16 @callback(i16 %a) noinline {
  %kept = alloca i16
  store volatile i16 %a, ptr %kept
  %b = load volatile i16, ptr %kept
  %1 = mul i16 %a, %b
  ret i16 %1
}
define void @install(i16 %n) noinline {
  store ptr @callback, ptr @hook
  %1 = call i16 @callback(i16 %n)
  store i16 %1, ptr @seen
  ret void
}
define void @on_tick() "interrupt"="60" {
  call void @install(i16 5)
  ret void
}
define void @main() {
  call void @install(i16 4)
  %f = load ptr, ptr @hook
  %1 = call i16 %f(i16 12)
  store i16 %1, ptr @seen
  ret void
}
)");
    program.run();
    EXPECT_EQ(program.variable("seen", 2), 144U);
    std::multiset<uint8_t> of_copy;
    std::multiset<uint8_t> of_original;
    for (const auto& placed : program.program().sections) {
        if (placed.section.name != "install@rst75") continue;
        for (const auto& item : placed.section.items) {
            const std::string_view name = toolchain::assembly::reference_of(item);
            if (name == "callback@rst75") of_copy.insert(item.opcode);
            if (name == "callback") of_original.insert(item.opcode);
        }
    }
    constexpr uint8_t kCall = 0xCD;
    EXPECT_EQ(of_copy, std::multiset<uint8_t>{kCall});
    EXPECT_FALSE(of_original.empty());
    EXPECT_EQ(of_original.count(kCall), 0U);
}

// The pointer that the handler hands out is called by the main program, so it must be the original.
TEST_P(CopiesOfPointers, AnAddressIsTheOriginals) {
    auto program = program_of(
        with_callback("store ptr @callback, ptr @other\n %1 = call i16 @callback(i16 3)"));
    const auto* original = program.program().find("callback");
    ASSERT_NE(original, nullptr);
    // Nothing has the copy's address but a CALL.
    unsigned calls = 0;
    for (const auto& placed : program.program().sections) {
        for (const auto& item : placed.section.items) {
            if (toolchain::assembly::reference_of(item) != "callback@rst75") continue;
            EXPECT_EQ(item.opcode, 0xCD);
            ++calls;
        }
    }
    EXPECT_EQ(calls, 1U);
}

}  // namespace
